#!/usr/bin/python3
"""Action2Motion's training step and generation in eager PyTorch: the peer of `actformer bench train --method action2motion`.

usage: action2motion_speed.py FOLDER [--persons 1] [--classes 94] [--frames 60] [--batch 128] [--rounds 3] [--truth]
FOLDER holds the reference program action2motion.py. Prints the seconds of a step by the clock and of processors, and both of 100 motions
(the least of the rounds, each by itself). Steps are fed their own outputs (tf_ratio=1), or with --truth the truth (tf_ratio=0).
"""
import argparse
import os
import runpy
import sys

import torch

import peer


def main():
    o = peer.options(128, '--truth')
    reference = runpy.run_path(os.path.join(o.folder, 'action2motion.py'))
    c = argparse.Namespace(dim=75 * o.persons, classes=o.classes, latent=30, hidden=128, time=1, lie=False)
    weights = {k: v.requires_grad_() for k, v in reference['draw'](reference['spec'](c), 0).items()}
    optimiser = torch.optim.Adam(weights.values(), lr=2e-4, weight_decay=1e-5)
    x = torch.randn(o.batch, o.frames, c.dim)
    y = torch.randint(0, o.classes, (o.batch,))

    def step():
        optimiser.zero_grad()
        noise = torch.randn(o.frames, o.batch, 30)
        reference['train_forward'](weights, c, x, y, noise, not o.truth, 'raw', 1e-3)['loss/total'].backward()
        optimiser.step()

    def generate():
        with torch.no_grad():
            labels = torch.randint(0, o.classes, (100,))
            reference['generate'](weights, c, labels, o.frames, torch.randn(o.frames, 100, 30), 'raw', None)

    peer.tell(o.rounds, step, generate)


if __name__ == '__main__':
    sys.exit(main())
