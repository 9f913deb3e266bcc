#!/usr/bin/python3
"""Motions files hold the same motions but for roundings: compare_motions.py FILE FILE..."""
import sys

import h5py
import numpy

TOLERANCE = 1e-4  # sums in another order: some hundred roundings of 6e-8 on numbers of at most a few


def motions(path):
    """All of a file, one behind the other."""
    with h5py.File(path) as file:
        return numpy.stack([file[name][()] for name in sorted(file)])


def main(first, *others):
    for path in others:
        apart = numpy.abs(motions(path) - motions(first)).max()
        print(f"{path}: at most {apart:.1e} from {first}")
        assert apart <= TOLERANCE


if __name__ == "__main__":
    main(*sys.argv[1:])
