#!/usr/bin/python3
"""CSGN's training step and generation in eager PyTorch: the peer of `actformer bench train --method csgn`.

usage: csgn_speed.py FOLDER [--persons 1] [--classes 94] [--frames 60] [--batch 64] [--rounds 3]
FOLDER holds the reference program csgn.py. Prints the seconds of a step by the clock and of processors, and both of 100 motions (the
least of the rounds, each by itself). A step is four of the discriminator and one of the generator.
"""
import argparse
import importlib.util
import os
import sys

import numpy
import torch

import peer


def load(folder):
    spec = importlib.util.spec_from_file_location('csgn', os.path.join(folder, 'csgn.py'))
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def root(c):
    """The prior's symmetric roots (channels, frames, frames), made once."""
    r = numpy.abs(numpy.subtract.outer(numpy.arange(c.latent_frames), numpy.arange(c.latent_frames)))
    roots = []
    for channel in range(c.latent):
        e, v = numpy.linalg.eigh(numpy.exp(-(r / (5 * (channel + 1) / c.latent)) ** 2))
        roots.append(v * numpy.sqrt(numpy.maximum(e, 0)) @ v.T)
    return torch.tensor(numpy.stack(roots), dtype=torch.float32)


def main():
    o = peer.options(64)
    csgn = load(o.folder)
    c = argparse.Namespace(skeleton='ntu', channels=3, persons=o.persons, frames=o.frames, classes=o.classes, base=32, latent=512,
                           latent_frames=-(-o.frames // 16))
    a = {name: torch.tensor(v, dtype=torch.float32) for name, v in csgn.pyramid(csgn.SKELETON['ntu'], True)[0].items()}
    w = {name: (0.05 * torch.randn(shape)).requires_grad_() for name, shape in csgn.spec(c, {k: v.numpy() for k, v in a.items()}).items()}
    bn = {f'cbn{i}.{m}': torch.ones(n * 32) for i, n in enumerate((8, 4, 2, 1)) for m in ('mean', 'var')}
    u = {name: torch.nn.functional.normalize(torch.randn(v.shape[0]), dim=0) for name, v in w.items() if name[0] == 'd' and name.endswith('weight')}
    net = csgn.Net(w, a, bn, c)
    roots = root(c)
    d, g = (torch.optim.Adam([v for name, v in w.items() if name[0] == part], lr=2e-4, betas=(0, 0.999)) for part in 'dg')
    real = torch.randn(o.batch, 3 * o.persons, 25, o.frames)
    labels = lambda n: torch.randint(0, o.classes, (n,))
    latent = lambda n: torch.einsum('cij,bcj->bci', roots, torch.randn(n, 512, c.latent_frames))

    def step():
        for _ in range(4):
            y = labels(o.batch)
            with torch.no_grad():
                fake = net.G(latent(o.batch), y)
            d.zero_grad()
            csgn.d_loss(net.D(real, y, u), net.D(fake, y, u), 'hinge').backward()
            d.step()
        for name, v in w.items():
            v.requires_grad_(name[0] == 'g')
        y = labels(o.batch)
        g.zero_grad()
        (-net.D(net.G(latent(o.batch), y), y, u).mean()).backward()
        g.step()
        for v in w.values():
            v.requires_grad_()

    def generate():
        with torch.no_grad():
            net.G(latent(100), labels(100), train=False)

    peer.tell(o.rounds, step, generate)


if __name__ == '__main__':
    sys.exit(main())
