#!/usr/bin/python3
"""Motions files hold the same motions but for roundings: compare_motions.py FILE FILE..."""
import sys

import h5py
import numpy


def motions(path):
    with h5py.File(path) as file:
        return numpy.stack([file[name][()] for name in sorted(file)])


first = motions(sys.argv[1])
for path in sys.argv[2:]:
    apart = numpy.abs(motions(path) - first).max()
    print(f"{path}: at most {apart:.1e} from {sys.argv[1]}")
    # Sums in another order: some hundred roundings of 6e-8 on numbers of at most a few.
    assert apart <= 1e-4
