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
import time

import torch


def best(work, rounds):
    work()
    wall, busy = [], []
    for _ in range(rounds):
        t, p = time.time(), time.process_time()
        work()
        wall.append(time.time() - t)
        busy.append(time.process_time() - p)
    return min(wall), min(busy)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument('folder')
    for name, value in (('persons', 1), ('classes', 94), ('frames', 60), ('batch', 20), ('rounds', 3)):
        parser.add_argument('--' + name, type=int, default=value)
    o = parser.parse_args()
    torch.set_num_threads(int(os.environ.get('OMP_NUM_THREADS', '2')))
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

    print(*('%.4f' % seconds for work in (step, generate) for seconds in best(work, o.rounds)))


if __name__ == '__main__':
    sys.exit(main())
