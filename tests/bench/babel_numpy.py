#!/usr/bin/python3
"""AMASS's recordings cut into clips by BABEL's labels with NumPy and SciPy: what `actformer bench ingest --format babel` runs beside itself.

usage: babel_numpy.py AMASS_FOLDER ANNOTATIONS.json OUT.h5 CATEGORIES.txt [THREADS]
Prints clips, seconds, and seconds of processors, Python's start not counted.
"""
import json, os, sys, time
from concurrent.futures import ProcessPoolExecutor

import h5py
import numpy as np
from scipy.spatial.transform import Rotation, Slerp

FPS, JOINTS, READ = 30, 24, 22


def resampled(path):
    """Rotations (T, 24, 6) below the parent, the first two rows of their matrices, and translation (T, 3), y up."""
    with np.load(path) as file:
        poses, trans, fps = file["poses"], file["trans"], float(file["mocap_framerate"])
    times = np.arange(len(poses)) / fps
    wanted = np.arange(int((len(poses) - 1) * FPS / fps + 1e-6) + 1) / FPS
    wanted = np.minimum(wanted, times[-1])
    matrices = np.tile(np.eye(3), (len(wanted), JOINTS, 1, 1))
    for joint in range(READ):
        rotations = Rotation.from_rotvec(poses[:, 3 * joint : 3 * joint + 3])
        if len(poses) > 1:
            rotations = Slerp(times, rotations)(wanted)
        matrices[:, joint] = rotations.as_matrix()
    place = np.stack([np.interp(wanted, times, trans[:, d]) for d in range(3)], axis=1)
    upright = np.array([[1, 0, 0], [0, 0, 1], [0, -1, 0]])
    matrices[:, 0] = upright @ matrices[:, 0]
    return matrices[:, :, :2].reshape(len(wanted), JOINTS, 6), place @ upright.T


def clips_of(task):
    path, sequence, classes = task
    rotations, place = resampled(path)
    out = []
    annotation = sequence["frame_ann"] or sequence["seq_ann"]
    for index, label in enumerate(annotation["labels"]):
        first = max(0, int(label.get("start_t", 0) * FPS))
        last = min(len(place), int(label["end_t"] * FPS)) if "end_t" in label else len(place)
        for category in label["act_cat"] or []:
            if category not in classes or first >= last:
                continue
            motion = np.zeros((last - first, JOINTS + 1, 6), np.float32)
            motion[:, :JOINTS] = rotations[first:last]
            motion[:, JOINTS, :3] = place[first:last] - place[first:last].mean(0)
            out.append((f"{label['seg_id']}_l{index:02}_A{classes[category] + 1:03}", motion.transpose(1, 2, 0)))
    return out


def main(folder, annotations, out, categories, threads=1):
    start, busy = time.perf_counter(), sum(os.times()[:4])
    with open(categories, encoding="utf-8") as file:
        classes = {name.strip(): i for i, name in enumerate(file) if name.strip()}
    with open(annotations, encoding="utf-8") as file:
        sequences = json.load(file).values()
    tasks = [(os.path.join(folder, *s["feat_p"].split("/")[1:]), s, classes) for s in sequences]
    count = 0
    with h5py.File(out, "w") as file, ProcessPoolExecutor(threads) as pool:
        for clips in pool.map(clips_of, tasks, chunksize=8):
            for name, motion in clips:
                file[name] = motion
                count += 1
    print(count, time.perf_counter() - start, sum(os.times()[:4]) - busy)


if __name__ == "__main__":
    main(*sys.argv[1:5], *map(int, sys.argv[5:6]))
