#!/usr/bin/env python3
"""ActFormer's training step and generation in PyTorch on CUDA, eager or compiled: the peer of trainings with actformer-ntu-2p.yaml.

usage: eager.py FOLDER [--persons 1] [--classes 94] [--frames 60] [--batch 64] [--rounds 3] [--bf16] [--compile] [--cpu]
FOLDER holds the reference program actformer_speed.py. Prints what the peers in tests/bench print: the seconds of a step (four of the discriminator, one
of the generator) by the clock and of processors, and both of 100 motions.
"""
import os
import runpy
import sys

import torch
from torch.nn import functional as F

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', 'bench'))
import peer  # noqa: E402


def main():
    o = peer.options(64, '--bf16', '--compile', '--cpu')
    device = torch.device('cpu' if o.cpu else 'cuda')
    repeats = 1 if o.cpu else 10  # of what is timed, for one wait for the GPU
    torch.backends.cuda.matmul.allow_tf32 = torch.backends.cudnn.allow_tf32 = False  # float32 is float32, as in a training
    networks = runpy.run_path(os.path.join(o.folder, 'actformer_speed.py'))
    generator = networks['Generator'](o.persons, o.classes, o.frames).to(device)
    discriminator = networks['Discriminator'](3 * o.persons, o.classes).to(device)
    adams = [torch.optim.Adam(net.parameters(), 2e-4, (0., .999)) for net in (generator, discriminator)]
    made, judged = (torch.compile(net) if o.compile else net for net in (generator, discriminator))
    real = torch.randn(o.batch, 3 * o.persons, 25, o.frames, device=device)

    def draw(count):
        return torch.randn(count, 120, o.frames, device=device), torch.randint(0, o.classes, (count,), device=device)

    def step_discriminator():
        z, y = draw(o.batch)
        adams[1].zero_grad()
        with torch.autocast(device.type, torch.bfloat16, o.bf16):
            with torch.no_grad():
                fake = made(z, y).float()
            scores = judged(torch.cat((real, fake)), torch.cat((y, y))).float()
        (F.relu(1 - scores[:o.batch]).mean() + F.relu(1 + scores[o.batch:]).mean()).backward()
        adams[1].step()

    def step_generator():
        z, y = draw(o.batch)
        adams[0].zero_grad()
        discriminator.requires_grad_(False)
        with torch.autocast(device.type, torch.bfloat16, o.bf16):
            scores = judged(made(z, y), y).float()
        (-scores.mean()).backward()
        adams[0].step()
        discriminator.requires_grad_(True)

    def repeated(*works):
        for _ in range(repeats):
            for work in works:
                work()
        if device.type == 'cuda':
            torch.cuda.synchronize()

    def train():
        repeated(*[step_discriminator] * 4, step_generator)

    def generate():
        with torch.no_grad():
            repeated(lambda: made(*draw(100)))

    print(*('%.6f' % (seconds / repeats) for work in (train, generate) for seconds in peer.best(work, o.rounds)))


if __name__ == '__main__':
    main()
