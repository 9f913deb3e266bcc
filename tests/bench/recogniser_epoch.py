#!/usr/bin/env python3
"""Peer of `actformer train recogniser`: the same network, batch, schedule and threads in eager PyTorch, as the public
tools train it. Prints training windows a second over whole steps (forward, backward, SGD), the best of the repeats.

usage: recogniser_epoch.py [--width 1] [--channels 3] [--classes 94] [--joints 25] [--frames 60] [--batch 64]
                           [--threads 2] [--steps 4] [--repeats 3] [--against ACTFORMER DATASET SPLIT]

--against measures the program too, turn about with the peer in the same run: the first epochs of a training on the dataset's
split with the same width, frames, batch and threads (joints and classes are the dataset's; --joints and --classes should
say the same). OpenBLAS 0.3.21 runs on kernels of 2004 on processors newer than it: set OPENBLAS_CORETYPE to be fair to the
peer, which multiplies matrices with it.
"""
import argparse, json, os, subprocess, tempfile, time
import torch
from torch import nn
from torch.nn import functional as F

LAYERS = [(64, 1), (64, 1), (64, 1), (64, 1), (128, 2), (128, 1), (128, 1), (256, 2), (256, 1), (256, 1)]


class Layer(nn.Module):
    def __init__(self, cin, cout, stride, first):
        super().__init__()
        self.conv = nn.Conv2d(cin, 3 * cout, 1)
        self.tcn = nn.Sequential(nn.BatchNorm2d(cout), nn.ReLU(inplace=True), nn.Conv2d(cout, cout, (9, 1), (stride, 1), (4, 0)),
                                 nn.BatchNorm2d(cout), nn.Dropout(0.5, inplace=True))
        self.first, self.residual = first, None
        if not first and (cin != cout or stride != 1):
            self.residual = nn.Sequential(nn.Conv2d(cin, cout, 1, (stride, 1)), nn.BatchNorm2d(cout))

    def forward(self, x, a):
        res = 0 if self.first else self.residual(x) if self.residual else x
        y = self.conv(x)
        n, kc, t, v = y.shape
        y = torch.einsum('nkctv,kvw->nctw', y.view(n, 3, kc // 3, t, v), a).contiguous()
        return F.relu(self.tcn(y) + res, inplace=True)


class Net(nn.Module):
    def __init__(self, o):
        super().__init__()
        self.data_bn = nn.BatchNorm1d(o.channels * o.joints)
        self.a = nn.Parameter(torch.rand(3, o.joints, o.joints))
        self.layers, cin = nn.ModuleList(), o.channels
        self.importance = nn.ParameterList()
        for i, (c, stride) in enumerate(LAYERS):
            c = 16 * max(1, round(c * o.width / 16))
            self.layers.append(Layer(cin, c, stride, i == 0))
            self.importance.append(nn.Parameter(torch.ones(3, o.joints, o.joints)))
            cin = c
        self.fcn = nn.Conv2d(cin, o.classes, 1)

    def forward(self, x):
        n, c, t, k = x.shape
        x = self.data_bn(x.permute(0, 3, 1, 2).reshape(n, k * c, t)).view(n, k, c, t).permute(0, 2, 3, 1).contiguous()
        for layer, importance in zip(self.layers, self.importance):
            x = layer(x, self.a * importance)
        return self.fcn(F.avg_pool2d(x, x.shape[2:])).flatten(1)


def program_rate(o):
    """Windows a second of the best epoch, as the program's own log says."""
    program, dataset, split = o.against
    with tempfile.TemporaryDirectory() as folder:
        config = os.path.join(folder, 'config.yaml')
        with open(config, 'w') as f:
            f.write(f'model: recogniser\nwidth: {o.width}\nframes: {o.frames}\nbatch: {o.batch}\nthreads: {o.threads}\n'
                    f'epochs: 1\ntrain_split: {split}\n')
        run = os.path.join(folder, 'run')
        subprocess.run([program, 'train', 'recogniser', '-c', config, '--data', dataset, '-o', run], check=True,
                       capture_output=True)
        return max(json.loads(line)['windows_a_second'] for line in open(os.path.join(run, 'log.jsonl')))


def main():
    p = argparse.ArgumentParser()
    for name, preset in (('channels', 3), ('classes', 94), ('joints', 25), ('frames', 60), ('batch', 64), ('threads', 2),
                         ('steps', 4), ('repeats', 3)):
        p.add_argument('--' + name, type=int, default=preset)
    p.add_argument('--width', type=float, default=1)
    p.add_argument('--against', nargs=3, metavar=('ACTFORMER', 'DATASET', 'SPLIT'))
    o = p.parse_args()
    torch.set_num_threads(o.threads)
    torch.manual_seed(0)
    net = Net(o)
    net.a.requires_grad_(False)
    sgd = torch.optim.SGD([w for w in net.parameters() if w.requires_grad], 0.1, 0.9, weight_decay=1e-4, nesterov=True)
    x, y = torch.randn(o.batch, o.channels, o.frames, o.joints), torch.randint(o.classes, (o.batch,))

    def step():
        sgd.zero_grad(set_to_none=True)
        F.cross_entropy(net(x), y).backward()
        sgd.step()

    step()
    best, ours = 0, 0
    for _ in range(o.repeats):
        start = time.time()
        for _ in range(o.steps):
            step()
        best = max(best, o.batch * o.steps / (time.time() - start))
        if o.against:
            ours = max(ours, program_rate(o))
    print(f'peer {best:.2f} windows/s')
    if o.against:
        print(f'actformer {ours:.2f} windows/s, {ours / best:.2f} times the peer')


if __name__ == '__main__':
    main()
