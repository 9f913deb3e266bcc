#!/usr/bin/env python3
"""FIDm and FIDw the customary way, by SciPy's matrix square root, for `actformer bench score`.

usage: frechet_sqrtm.py REAL.h5 GENERATED.h5      each holds features (n, d) and labels (n)
Prints one JSON object: the seconds that each took, the distance of every class and that of all samples.
"""
import json
import sys
import time

import h5py
import numpy as np
from scipy import linalg


def distance(x, y):
    """|mean x - mean y|^2 + tr(Cx + Cy - 2 (Cx Cy)^(1/2)); what is imaginary in the root is rounding."""
    cx, cy = np.cov(x, rowvar=False), np.cov(y, rowvar=False)
    root = linalg.sqrtm(cx @ cy)
    return ((x.mean(0) - y.mean(0)) ** 2).sum() + np.trace(cx + cy - 2 * root.real)


def main():
    real, made = ({k: h5py.File(path)[k][()] for k in ('features', 'labels')} for path in sys.argv[1:3])
    x, y = (side['features'].astype('f8') for side in (real, made))
    distance(x[:300], y[:300])  # the libraries' first call
    start = time.perf_counter()
    each = [distance(x[real['labels'] == c], y[made['labels'] == c]) for c in np.unique(real['labels'])]
    middle = time.perf_counter()
    whole = distance(x, y)
    end = time.perf_counter()
    print(json.dumps({'mean_seconds': middle - start, 'whole_seconds': end - middle, 'distances': each, 'whole': whole}))


if __name__ == '__main__':
    main()
