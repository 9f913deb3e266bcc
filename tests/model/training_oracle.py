#!/usr/bin/env python3
"""Trains the recogniser in eager PyTorch, in float64, on batches that it is given: what our own training must follow.

usage: training_oracle.py WEIGHTS.h5 BATCHES.h5
BATCHES holds x (steps, N, C, T, K), labels (steps, N) and rates (steps); WEIGHTS where to begin. Nothing is dropped out. Prints
{"losses": one a step, "logits": of the first batch at the end, by the running statistics}.
"""
import json, os, sys
import h5py
import numpy as np
import torch
from torch.nn import functional as F
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', 'bench'))
from recogniser_accuracy import partition
from recogniser_epoch import Net


class Shape:
    pass


def public_name(name):
    return name.replace('importance.', 'edge_importance.').replace('layers.', 'st_gcn_networks.').replace('.conv.', '.gcn.conv.')


def start(path):
    with h5py.File(path) as file:
        shape = Shape()
        parents = [int(p) for p in file.attrs['parents']]
        shape.joints, shape.channels, shape.classes = len(parents), int(file.attrs['channels']), int(file.attrs['classes'])
        shape.width = file['st_gcn_networks.0.gcn.conv.weight'].shape[0] / 3 / 64
        net = Net(shape).double()
        with torch.no_grad():
            net.a.requires_grad_(False).copy_(torch.from_numpy(partition(parents, int(file.attrs['center']))))
            for name, value in net.state_dict().items():
                if name != 'a' and not name.endswith('num_batches_tracked'):
                    value.copy_(torch.from_numpy(file[public_name(name)][()].astype(np.float64)))
    for module in net.modules():
        if isinstance(module, torch.nn.Dropout):
            module.p = 0
    return net


def main():
    net = start(sys.argv[1])
    with h5py.File(sys.argv[2]) as file:
        batches = torch.from_numpy(file['x'][()].astype(np.float64))
        labels, rates = torch.from_numpy(file['labels'][()].astype(np.int64)), file['rates'][()]
    sgd = torch.optim.SGD([w for w in net.parameters() if w.requires_grad], 1, 0.9, weight_decay=1e-4, nesterov=True)
    losses = []
    for x, y, rate in zip(batches, labels, rates):
        for group in sgd.param_groups:
            group['lr'] = float(rate)
        sgd.zero_grad(set_to_none=True)
        loss = F.cross_entropy(net(x), y)
        loss.backward()
        sgd.step()
        losses.append(loss.item())
    net.eval()
    with torch.no_grad():
        print(json.dumps({'losses': losses, 'logits': net(batches[0]).flatten().tolist()}))


main()
