# What the peers of `actformer bench train` have in common: their options, and how their work is timed.
import argparse
import os
import time

import torch


def options(batch, *flags):
    """FOLDER of the reference programs, sizes of the motions, and the flags of one peer; torch takes OMP_NUM_THREADS threads."""
    parser = argparse.ArgumentParser()
    parser.add_argument('folder')
    for name, value in (('persons', 1), ('classes', 94), ('frames', 60), ('batch', batch), ('rounds', 3)):
        parser.add_argument('--' + name, type=int, default=value)
    for flag in flags:
        parser.add_argument(flag, action='store_true')
    torch.set_num_threads(int(os.environ.get('OMP_NUM_THREADS', '2')))
    return parser.parse_args()


def best(work, rounds):
    """The least seconds of a round by the clock, and of processors; one more round goes before."""
    work()
    wall, busy = [], []
    for _ in range(rounds):
        t, p = time.time(), time.process_time()
        work()
        wall.append(time.time() - t)
        busy.append(time.process_time() - p)
    return min(wall), min(busy)


def tell(rounds, *works):
    print(*('%.4f' % seconds for work in works for seconds in best(work, rounds)))
