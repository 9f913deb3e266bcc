#!/usr/bin/python3
"""ACTOR's training step and generation in eager PyTorch: the peer of `actformer bench train --method actor`.

usage: actor_speed.py FOLDER [--persons 1] [--classes 94] [--frames 60] [--batch 20] [--rounds 3]
FOLDER holds the reference program actor.py. Prints the seconds of a step by the clock and of processors, and both of 100 motions (the
least of the rounds, each by itself). No dropout on either side.
"""
import argparse
import os
import runpy
import sys

import torch

import peer


def main():
    o = peer.options(20)
    actor = runpy.run_path(os.path.join(o.folder, 'actor.py'))
    c = argparse.Namespace(joints=25, feats=3 * o.persons, frames=o.frames, classes=o.classes, latent=256, ff=1024, layers=8, heads=4,
                           arch='transformer', ablation='', seed=0, init='paper')
    weights = {k: v.requires_grad_() for k, v in actor['draw'](c).items()}
    net = actor['Net'](weights, c)
    optimiser = torch.optim.AdamW(weights.values(), lr=1e-4)
    x = torch.randn(o.batch, 25, c.feats, o.frames)
    y = torch.randint(0, o.classes, (o.batch,))
    length = torch.full((o.batch,), o.frames)

    def step():
        optimiser.zero_grad()
        actor['losses'](net, x, y, length, torch.randn(o.batch, 256), 'none', None, 1e-5)[-1]['mixed'].backward()
        optimiser.step()

    def generate():
        with torch.no_grad():
            net.decode(torch.randn(100, 256), torch.randint(0, o.classes, (100,)), torch.ones(100, o.frames, dtype=torch.bool),
                       torch.full((100,), o.frames))

    peer.tell(o.rounds, step, generate)


if __name__ == '__main__':
    sys.exit(main())
