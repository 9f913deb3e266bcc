#!/usr/bin/env python3
"""Trains the recogniser in eager PyTorch on batches that it is given: what our own training must follow.

usage: training_oracle.py WEIGHTS.h5 LESSONS.h5 fused|plain float64|float32
LESSONS holds x (steps, N, C, T, K), labels (steps, N), rates and seeds of dropout (steps), and shown (M, C, T, K); WEIGHTS where to
begin. What is dropped out is what the program's own layers drop (fused) or what libtorch does after the same seed (plain). Prints
{"losses": one a step, "logits": of what is shown at the end, by the running statistics}.
"""
import json, os, sys
import h5py
import numpy as np
import torch
from torch.nn import functional as F
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', '..', 'bench'))
from recogniser_accuracy import partition
from recogniser_epoch import Net


class Shape:
    pass


def public_name(name):
    return name.replace('importance.', 'edge_importance.').replace('layers.', 'st_gcn_networks.').replace('.conv.', '.gcn.conv.')


def kept(count, seed):
    """Which of the numbers are kept at a half's chance: a hash of place and seed, 32 bits wide."""
    low, high = np.uint32(seed % 2**32), np.uint32(seed // 2**32)
    h = np.arange(count, dtype=np.uint32) * np.uint32(0x9E3779B1) ^ low
    h = (h ^ h >> 16) * np.uint32(0x85EBCA6B) + high
    h = (h ^ h >> 13) * np.uint32(0xC2B2AE35)
    return h ^ h >> 16 >= 2**31


class HashedDropout(torch.nn.Module):
    """Drops what the fused layers do: they hash places in (N, T, K, C), with a seed of each layer's own."""

    def __init__(self, layer):
        super().__init__()
        self.layer, self.seed = layer, 0

    def forward(self, x):
        if not self.training:
            return x
        n, c, t, k = x.shape
        mask = kept(x.numel(), (self.seed + self.layer * 0x9E3779B97F4A7C15) % 2**64).reshape(n, t, k, c)
        return 2 * x * torch.from_numpy(mask).permute(0, 3, 1, 2)


def start(path, kind):
    with h5py.File(path) as file:
        shape = Shape()
        parents = [int(p) for p in file.attrs['parents']]
        shape.joints, shape.channels, shape.classes = len(parents), int(file.attrs['channels']), int(file.attrs['classes'])
        shape.width = file['st_gcn_networks.0.gcn.conv.weight'].shape[0] / 3 / 64
        net = Net(shape).to(kind)
        with torch.no_grad():
            net.a.requires_grad_(False).copy_(torch.from_numpy(partition(parents, int(file.attrs['center']))))
            for name, value in net.state_dict().items():
                if name != 'a' and not name.endswith('num_batches_tracked'):
                    value.copy_(torch.from_numpy(file[public_name(name)][()]))
    return net


def drop_as_fused_layers(net):
    """What sets the seed."""
    drops = [HashedDropout(i) for i in range(len(net.layers))]
    for layer, drop in zip(net.layers, drops):
        layer.tcn[4] = drop

    def seed_with(seed):
        for drop in drops:
            drop.seed = seed
    return seed_with


def main():
    kind = getattr(torch, sys.argv[4])
    net = start(sys.argv[1], kind)
    seed_with = drop_as_fused_layers(net) if sys.argv[3] == 'fused' else torch.manual_seed
    sgd = torch.optim.SGD([w for w in net.parameters() if w.requires_grad], 1, 0.9, weight_decay=1e-4, nesterov=True)
    losses, logits = [], []
    with h5py.File(sys.argv[2]) as file:
        labels = torch.from_numpy(file['labels'][()].astype(np.int64))
        for x, y, rate, seed in zip(file['x'], labels, file['rates'], file['seeds']):
            seed_with(int(seed))
            for group in sgd.param_groups:
                group['lr'] = float(rate)
            sgd.zero_grad(set_to_none=True)
            loss = F.cross_entropy(net(torch.from_numpy(x).to(kind)), y)
            loss.backward()
            sgd.step()
            losses.append(loss.item())
        net.eval()
        with torch.no_grad():
            for x in torch.from_numpy(file['shown'][()]).split(64):
                logits += net(x.to(kind)).flatten().tolist()
    print(json.dumps({'losses': losses, 'logits': logits}))


main()
