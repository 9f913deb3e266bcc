#!/usr/bin/env python3
"""ActFormer's networks in NumPy, written from the paper alone (Xu, Song et al., ICCV 2023): loops over samples, persons, heads and taps.

usage: oracle.py FILE.h5 OUT.h5
FILE.h5 holds the attribute `case` (JSON), the weights under their names, `latent`, `labels`, `motion`; OUT.h5 gets `motion`
from the generator and `scores` from the discriminator.
"""
import json
import sys

import h5py
import numpy as np
from math import erf

verf = np.vectorize(erf)


def load(path):
    with h5py.File(path, 'r') as f:
        return json.loads(f.attrs['case']), {k: np.asarray(v, np.float64) for k, v in f.items()}


class Net:
    def __init__(self, arrays, prefix):
        self.w = {k[len(prefix):]: v for k, v in arrays.items() if k.startswith(prefix)}

    def spectral(self, name, rows=None):
        w, u, v = self.w[name], self.w[name + '_u'], self.w[name + '_v']
        return w / (u @ w.reshape(len(u), -1) @ v)

    def linear(self, x, name):
        return x @ self.spectral(name + '.weight').T + self.w[name + '.bias']

    def norm(self, x, weight, bias):
        centred = x - x.mean(-1, keepdims=True)
        return centred / np.sqrt((centred ** 2).mean(-1, keepdims=True) + 1e-6) * weight + bias


def softmax(x):
    e = np.exp(x - x.max(-1, keepdims=True))
    return e / e.sum(-1, keepdims=True)


def attention(net, x, qkv, proj, heads):
    """x (tokens, width)"""
    q, k, v = np.split(net.linear(x, qkv), 3, -1)
    size = x.shape[-1] // heads
    seen = np.zeros_like(x)
    for h in range(heads):
        s = slice(h * size, (h + 1) * size)
        seen[:, s] = softmax(q[:, s] @ k[:, s].T / np.sqrt(size)) @ v[:, s]
    return net.linear(seen, proj)


def block(net, x, i, heads):
    p = 'blocks.%d.' % i
    x = x + attention(net, net.norm(x, net.w[p + 'norm1.weight'], net.w[p + 'norm1.bias']), p + 'qkv', p + 'proj', heads)
    up = net.linear(net.norm(x, net.w[p + 'norm2.weight'], net.w[p + 'norm2.bias']), p + 'up')
    return x + net.linear(up * .5 * (1 + verf(up / np.sqrt(2))), p + 'down')


def positions(net, t, p, width):
    out = np.zeros((t + 1, p, width))
    if 'frame_positions' in net.w:
        for i in range(t + 1):
            for j in range(p):
                out[i, j] = np.concatenate((net.w['frame_positions'][i], net.w['person_positions'][j]))
        return out
    return net.w['positions'][:t + 1]


def hops(parents, kept=None):
    """Path lengths (kept, nodes) of a tree, by walking from every node."""
    n = len(parents)
    near = [[j for j in range(n) if parents[j] == i or parents[i] == j] for i in range(n)]
    d = np.full((n, n), -1)
    for i in range(n):
        d[i, i], queue = 0, [i]
        for a in queue:
            for b in near[a]:
                if d[i, b] < 0:
                    d[i, b] = d[i, a] + 1
                    queue.append(b)
    return d


def matrices(d, kept):
    out = []
    for hop in (0, 1):
        mask = (d[kept] == hop).astype(float)
        out.append(mask / np.sqrt(np.maximum(np.outer(mask.sum(1), mask.sum(0)), 1)))
    return out


def levels(case):
    fine = hops(case['parents'])
    kept = case['middle']
    joined = fine[np.ix_(kept, kept)]
    edges = (joined > 0) & (joined <= 3)
    middle = distances(edges)
    again = case['coarse']
    joined = middle[np.ix_(again, again)]
    coarse = distances((joined > 0) & (joined <= 3))
    return fine, middle, coarse


def distances(edges):
    n = len(edges)
    d = np.where(np.eye(n, dtype=bool), 0, np.where(edges, 1, 10 ** 6))
    for k in range(n):
        d = np.minimum(d, d[:, k:k + 1] + d[k:k + 1])
    return d


def graph_layer(net, x, name, sums):
    """x (nodes, in)"""
    y = net.linear(x, name)
    half = y.shape[1] // 2
    y = sums[0] @ y[:, :half] + sums[1] @ y[:, half:]
    y = np.where(y > 0, y, .2 * y)
    return (y - y.mean(1, keepdims=True)) / np.sqrt(y.var(1, keepdims=True) + 1e-6)


def pose(case, raw):
    """raw (nodes, numbers)"""
    how = case['representation']
    if how == 'xyz':
        return raw
    out = np.zeros_like(raw)
    for k in range(len(raw)):
        if k == (0 if how == 'limb' else len(raw) - 1):
            out[k, :3] = raw[k, :3]
        elif how == 'limb':
            bent = np.tanh(raw[k])
            out[k] = bent / (np.linalg.norm(bent) + 1e-4)
        else:
            a, b = np.tanh(raw[k][:3]), np.tanh(raw[k][3:])
            a = a / np.linalg.norm(a)
            b = b - (a @ b) * a
            out[k] = np.concatenate((a, b / np.linalg.norm(b)))
    return out


def generate(case, net, latent, label):
    """latent (streams, T, channels) -> (P*D, T, K)"""
    persons, joints, numbers, width = case['persons'], len(case['parents']), case['numbers'], case['width']
    t = latent.shape[1]
    if case['interaction'] == 'concat':
        latent = np.concatenate(list(latent), -1)[None]
    streams = 1 if case['interaction'] == 'concat' else persons
    pe = positions(net, t, streams, width)
    x = np.zeros((streams, t + 1, width))
    for s in range(streams):
        x[s, 0] = net.w['classes.weight'][label] + pe[0, s]
        x[s, 1:] = net.linear(latent[s if len(latent) > 1 else 0], 'input') + pe[1:, s]
    i = 0
    for _ in range(case['depth']):
        if streams > 1:
            for frame in range(t + 1):
                x[:, frame] = block(net, x[:, frame], i, case['heads'])
            i += 1
        for s in range(streams):
            x[s] = block(net, x[s], i, case['heads'])
        i += 1
    x = x[:, 1:]
    if case['smooth']:
        far = 4 * case['smooth']
        kernel = [[np.exp(-((a - b) / case['smooth']) ** 2 / 2) if abs(a - b) <= far else 0 for b in range(t)] for a in range(t)]
        x = np.stack([[sum(k * v for k, v in zip(row, each)) / sum(row) for row in kernel] for each in x])
    x = net.norm(x, net.spectral('norm.weight'), net.w['norm.bias'])
    fine, middle, _ = levels(case)
    out = np.zeros((persons * numbers, t, joints))
    for frame in range(t):
        for p in range(persons):
            token = x[p if streams > 1 else 0, frame]
            part = 0 if streams > 1 else p
            if case['body'] == 'transformer':
                each = joints * numbers
                raw = net.linear(token, 'head')[part * each:(part + 1) * each].reshape(joints, numbers)
            else:
                nodes = len(case['coarse'])
                y = net.linear(token, 'to_graph').reshape(-1, nodes, 128)[part]
                y = graph_layer(net, y, 'up1', [m.T for m in matrices(middle, case['coarse'])])
                y = graph_layer(net, y, 'up2', [m.T for m in matrices(fine, case['middle'])])
                y = graph_layer(net, y, 'graph', matrices(fine, range(joints)))
                head = net.spectral('head.weight').reshape(joints, numbers, -1)
                raw = np.einsum('kf,kdf->kd', y, head) + net.w['head.bias'].reshape(joints, numbers)
            out[p * numbers:(p + 1) * numbers, frame] = pose(case, raw).T
    if case['smooth_root']:
        root = joints - 1 if case['representation'] == 'rot6d' else 0
        carried = range(joints) if case['representation'] == 'xyz' else [root]
        for p in range(persons):
            for c in range(p * numbers, p * numbers + 3):
                moved = smooth_path(out[c, :, root], case['smooth_root']) - out[c, :, root]
                for node in carried:
                    out[c, :, node] += moved
    return out


def smooth_path(path, deviation):
    """Frames beyond an end mirror those before it through the end's point."""
    last = len(path) - 1
    reach = min(last, int(np.ceil(4 * deviation)))

    def at(i):
        return 2 * path[0] - path[-i] if i < 0 else 2 * path[last] - path[2 * last - i] if i > last else path[i]
    smooth = []
    for i in range(last + 1):
        near = [j for j in range(-reach, last + reach + 1) if abs(j - i) <= 4 * deviation]
        weights = [np.exp(-((j - i) / deviation) ** 2 / 2) for j in near]
        smooth.append(sum(w * at(j) for w, j in zip(weights, near)) / sum(weights))
    return np.array(smooth)


def convolve(x, w, stride, pad):
    """x (T, in), w (out, taps, in)"""
    x = np.pad(x, ((pad, pad), (0, 0)))
    taps = w.shape[1]
    return np.stack([np.einsum('ti,oti->o', x[a:a + taps], w) for a in range(0, len(x) - taps + 1, stride)])


def joint_positions(case, pose):
    """pose (numbers, K) of one person -> (joints, 3)"""
    how, parents = case['representation'], case['parents']
    if how == 'xyz':
        return pose.T
    if how == 'limb':
        out = np.zeros((len(parents), 3))
        for j, parent in enumerate(parents):
            out[j] = pose[:, j] if parent < 0 else out[parent] + case['bone_length'][j] * pose[:, j]
        return out
    rest, turns, out = np.reshape(case['rest'], (-1, 3)), [], []
    for j, parent in enumerate(parents[:-1]):
        a = pose[:3, j] / np.linalg.norm(pose[:3, j])
        b = pose[3:, j] - (a @ pose[3:, j]) * a
        b /= np.linalg.norm(b)
        own = np.stack((a, b, np.cross(a, b)))
        turns.append(own if parent < 0 else turns[parent] @ own)
        out.append(pose[:3, -1] if parent < 0 else out[parent] + turns[parent] @ rest[j])
    return np.stack(out)


def joint_velocities(case, motion):
    """motion (P*D, T, K) -> (P*3, T, K)"""
    numbers, (channels, frames, nodes) = case['numbers'], motion.shape
    out = np.zeros((channels // numbers * 3, frames, nodes))
    for p in range(channels // numbers):
        at = [joint_positions(case, motion[p * numbers:(p + 1) * numbers, t]) for t in range(frames)]
        for t in range(1, frames):
            out[3 * p:3 * p + 3, t, :len(at[t])] = (at[t] - at[t - 1]).T
    return out


def features(case, net, motion):
    """motion (C, T, K) -> (features)"""
    moved, sped_up = np.zeros_like(motion), np.zeros_like(motion)
    moved[:, 1:] = motion[:, 1:] - motion[:, :-1]
    sped_up[:, 2:] = motion[:, 2:] - 2 * motion[:, 1:-1] + motion[:, :-2]
    x = np.concatenate((case['pose_gain'] * motion, case['gain'] * moved, case['gain'] ** 2 * sped_up)[:1 + case['differences']])
    if case['joint_gain']:
        x = np.concatenate((x, case['joint_gain'] * joint_velocities(case, motion)))
    x = x.transpose(2, 1, 0)          # (K, T, C)
    fine, middle, coarse = levels(case)
    sums = [matrices(fine, range(len(fine))), matrices(fine, case['middle']), matrices(middle, case['coarse']),
            matrices(coarse, range(len(coarse)))]
    for i, (a, stride, pad) in enumerate(zip(sums, (1, 2, 2, 2), (2, 1, 1, 1))):
        w = net.spectral('convs.%d.weight' % i)
        y = 0
        for node in range(len(x)):
            for hop in (0, 1):
                out = convolve(x[node], w[node, hop], stride, pad)
                if i == 0:
                    out = out + net.w['convs.0.bias'].reshape(len(x), 2, -1)[node, hop]
                y = y + a[hop][:, node][:, None, None] * out
        x = np.where(y > 0, y, .2 * y)
    w = net.spectral('last.weight')
    y = sum(convolve(x[node], w[:, node], 2, 1) for node in range(len(x))) + net.w['last.bias']
    return np.where(y > 0, y, .2 * y).sum(0)


def score(case, net, motion, label):
    persons, numbers = case['persons'], case['numbers']
    if case['d_persons'] == 'concat':
        found = features(case, net, motion)
    else:
        each = np.stack([features(case, net, motion[p * numbers:(p + 1) * numbers]) for p in range(persons)])
        if case['d_persons'] == 'avgpool':
            found = each.mean(0)
        elif case['d_persons'] == 'maxpool':
            found = each.max(0)
        else:
            found = (each + attention(net, each, 'persons.qkv', 'persons.proj', 8)).mean(0)
    return net.linear(found, 'score')[0] + net.spectral('classes.weight')[label] @ found


def main():
    case, arrays = load(sys.argv[1])
    labels = arrays['labels'].astype(int)
    g, d = Net(arrays, 'generator.'), Net(arrays, 'discriminator.')
    with h5py.File(sys.argv[2], 'w') as f:
        f['motion'] = np.stack([generate(case, g, z, y) for z, y in zip(arrays['latent'], labels)]).astype(np.float32)
        f['scores'] = np.array([score(case, d, m, y) for m, y in zip(arrays['motion'], labels)], np.float32)


if __name__ == '__main__':
    main()
