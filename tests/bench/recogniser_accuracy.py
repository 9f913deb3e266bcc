#!/usr/bin/env python3
"""What eager PyTorch's training of the recogniser reaches, to set beside `actformer train recogniser`: the same network and
starting distribution (PyTorch's own), the same rules for what a batch holds, epochs, schedule and optimiser, on a dataset that
`actformer ingest` wrote. Prints the mean over classes of the share of windows recognised after the last epoch.

usage: recogniser_accuracy.py DATASET TRAIN_SPLIT TEST_SPLIT [--width 0.25] [--frames 60] [--batch 64] [--epochs 14]
                              [--rate 0.1] [--rate-drops 9 12] [--seed 0] [--threads 1] [--json]

A batch draws clips with replacement, each as likely, and a random window of each (shorter clips run back and forth); an epoch
is as many batches as the clips fill. Scoring takes every consecutive window. Persons are permuted while training.
"""
import argparse, json, os, sys, time
import h5py
import numpy as np
import torch
from torch.nn import functional as F
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from recogniser_epoch import Net


def partition(parents, center):
    """(3, K, K): the joint itself, neighbours not nearer to the centre, nearer ones; columns divided by degree. Distances are
    known one hop far, as in the public ST-GCN."""
    k = len(parents)
    linked = np.eye(k, dtype=bool)
    for child, parent in enumerate(parents):
        if parent >= 0:
            linked[child, parent] = linked[parent, child] = True
    hops = np.where(linked[center], 1, 2)
    hops[center] = 0
    own, nearer = np.eye(k, dtype=bool), hops[:, None] < hops[None, :]
    share = linked / linked.sum(0)
    return np.stack([share * own, share * (~own & ~nearer), share * (~own & nearer)]).astype(np.float32)


def field(shard, name, clip):
    value = shard['clip/' + name][clip]
    return value.decode() if isinstance(value, bytes) else value


def read_split(folder, split):
    """[(frames, P, K, 3)], [label] of the clips that the split's predicate in dataset.json holds for."""
    header = json.load(open(os.path.join(folder, 'dataset.json')))
    clips, labels = [], []
    for entry in header['shards']:
        with h5py.File(os.path.join(folder, entry['file'])) as shard:
            start, length, label = (shard['clip/' + n][()] for n in ('offset', 'length', 'label'))
            motion = shard['motion'][()]
            for c in range(len(start)):
                if all(field(shard, rule['field'], c) in rule['in'] for rule in header['splits'][split]):
                    clips.append(motion[start[c]:start[c] + length[c]])
                    labels.append(int(label[c]))
    return header, clips, labels


def window(clip, first, frames, order):
    """(P*C, T, K)"""
    n = len(clip)
    t = first + np.arange(frames)
    if n - first < frames:
        t = t % max(1, 2 * (n - 1))
        t = np.minimum(t, np.abs(2 * (n - 1) - t))
    shown = clip[t][:, order]
    return shown.transpose(1, 3, 0, 2).reshape(-1, frames, clip.shape[2])


def batches(clips, labels, o, random):
    persons = clips[0].shape[1]
    for _ in range(-(-len(clips) // o.batch)):
        drawn = random.integers(len(clips), size=o.batch)
        x = [window(clips[c], random.integers(max(1, len(clips[c]) - o.frames + 1)), o.frames, random.permutation(persons))
             for c in drawn]
        yield torch.from_numpy(np.stack(x)), torch.tensor([labels[c] for c in drawn])


def score(net, clips, labels, classes, o):
    """(classes, classes) counts, rows the truth."""
    order = np.arange(clips[0].shape[1])
    cuts = [(c, i * o.frames) for c in range(len(clips)) for i in range(max(1, len(clips[c]) // o.frames))]
    confusion = np.zeros((classes, classes), int)
    net.eval()
    with torch.no_grad():
        for s in range(0, len(cuts), o.batch):
            part = cuts[s:s + o.batch]
            x = torch.from_numpy(np.stack([window(clips[c], first, o.frames, order) for c, first in part]))
            for (c, _), guess in zip(part, net(x).argmax(1).tolist()):
                confusion[labels[c], guess] += 1
    net.train()
    return confusion


def main():
    p = argparse.ArgumentParser()
    p.add_argument('dataset'), p.add_argument('train_split'), p.add_argument('test_split')
    for name, preset in (('frames', 60), ('batch', 64), ('epochs', 14), ('seed', 0), ('threads', 1)):
        p.add_argument('--' + name, type=int, default=preset)
    p.add_argument('--width', type=float, default=0.25)
    p.add_argument('--rate', type=float, default=0.1)
    p.add_argument('--rate-drops', type=int, nargs='*', default=[9, 12])
    p.add_argument('--json', action='store_true')
    o = p.parse_args()
    torch.set_num_threads(o.threads)
    torch.manual_seed(o.seed)
    random = np.random.default_rng(o.seed)
    header, clips, labels = read_split(o.dataset, o.train_split)
    parents = header['topology']['parents']
    o.joints, o.channels, o.classes = len(parents), 3 * header['persons'], len(header['classes'])
    net = Net(o)
    net.a.requires_grad_(False).copy_(torch.from_numpy(partition(parents, parents.index(-1))))
    sgd = torch.optim.SGD([w for w in net.parameters() if w.requires_grad], o.rate, 0.9, weight_decay=1e-4, nesterov=True)
    start = time.time()
    for epoch in range(o.epochs):
        for group in sgd.param_groups:
            group['lr'] = o.rate * 0.1 ** sum(epoch >= drop for drop in o.rate_drops)
        losses = []
        for x, y in batches(clips, labels, o, random):
            sgd.zero_grad(set_to_none=True)
            loss = F.cross_entropy(net(x), y)
            loss.backward()
            sgd.step()
            losses.append(loss.item())
        print(f'epoch {epoch + 1} of {o.epochs}  loss {np.mean(losses):.4f}  {time.time() - start:.0f} s', file=sys.stderr)
    _, clips, labels = read_split(o.dataset, o.test_split)
    confusion = score(net, clips, labels, o.classes, o)
    accuracy = np.mean([row[i] / row.sum() for i, row in enumerate(confusion) if row.sum()])
    if o.json:
        print(json.dumps({'seed': o.seed, 'class_accuracy': accuracy, 'confusion': confusion.tolist()}))
    else:
        print(f'class accuracy {100 * accuracy:.1f} %')


if __name__ == '__main__':
    main()
