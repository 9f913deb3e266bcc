#!/usr/bin/python3
"""Datasets that `actformer ingest babel` made, beside what NumPy and SciPy make of the same files.

usage: babel_oracle.py AMASS_FOLDER BABEL_FOLDER ROT6D_DATASET XYZ_DATASET PUBLISHED_DATASET
Prints a line a dataset: its name, clips, and the largest difference of a number; exits 1, saying why, where clips, labels, splits or
lengths differ.
"""
import glob, json, os, sys

import h5py
import numpy as np
from scipy.ndimage import zoom
from scipy.spatial.transform import Rotation, Slerp

PARENTS = [-1, 0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 9, 9, 12, 13, 14, 16, 17, 18, 19, 20, 21]
LEFT = {1: (0.0916, -0.1, 0.02), 4: (0, -0.404, 0), 7: (0, -0.428, 0), 10: (0, -0.03, 0.117), 13: (0.06, 0.04, 0),
        16: (0.124, 0.02, -0.008), 18: (0.296, 0, 0), 20: (0.185, 0, 0), 22: (0.08, 0, 0)}
MIDDLE = {3: (0, 0.078, -0.004), 6: (0, 0.078, -0.004), 9: (0, 0.078, -0.004), 12: (0, 0.093, -0.012), 15: (0, 0.093, -0.012)}
OFFSETS = np.zeros((24, 3))
for joint, offset in {**LEFT, **MIDDLE}.items():
    OFFSETS[joint] = offset
for joint in LEFT:
    OFFSETS[joint + 1] = OFFSETS[joint] * (-1, 1, 1)
UPRIGHT = np.array([[1, 0, 0], [0, 0, 1], [0, -1, 0]])


def by_slerp(poses, trans, fps):
    times = np.arange(len(poses)) / fps
    wanted = np.arange(int((len(poses) - 1) / fps * 30 + 1e-6) + 1) / 30
    wanted = np.minimum(wanted, times[-1])
    matrices = np.tile(np.eye(3), (len(wanted), 24, 1, 1))
    for joint in range(22):
        matrices[:, joint] = Slerp(times, Rotation.from_rotvec(poses[:, 3 * joint : 3 * joint + 3]))(wanted).as_matrix()
    matrices[:, 0] = UPRIGHT @ matrices[:, 0]
    return matrices, np.stack([np.interp(wanted, times, trans[:, d]) for d in range(3)], 1) @ UPRIGHT.T


def by_zoom(poses, trans, fps):
    # The mode counts where rounding puts the last place behind the last frame: the default, `constant`, makes that frame 0.
    poses, trans = (zoom(values, (30 / fps, 1), mode="mirror") for values in (poses[:, :66], trans))
    poses = np.concatenate([poses, np.zeros((len(poses), 6))], 1)
    return Rotation.from_rotvec(poses.reshape(-1, 3)).as_matrix().reshape(-1, 24, 3, 3), trans


def rot6d(matrices, trans):
    out = np.zeros((len(trans), 25, 6))
    out[:, :24] = matrices[:, :, :2].reshape(-1, 24, 6)
    out[:, 24, :3] = trans - trans.mean(0)
    return out


def xyz(matrices, trans):
    world, at = [], []
    for joint, parent in enumerate(PARENTS):
        world.append(matrices[:, joint] if parent < 0 else world[parent] @ matrices[:, joint])
        at.append(trans - trans.mean(0) if parent < 0 else at[parent] + world[parent] @ OFFSETS[joint])
    return np.stack(at, 1)


def wanted(made, folder, classes, represent):
    """Name -> (split, label, motion)."""
    out = {}
    for split in ("train", "val"):
        with open(os.path.join(folder, split + ".json"), encoding="utf-8") as file:
            sequences = json.load(file)
        for sequence in sequences.values():
            path = sequence["feat_p"].split("/", 1)[1]
            if path not in made:
                continue
            matrices, trans = made[path]
            annotation = sequence["seq_ann"] if sequence["frame_ann"] is None else sequence["frame_ann"]
            for index, label in enumerate(annotation["labels"]):
                first = max(0, int(label.get("start_t", 0) * 30))
                last = min(len(trans), int(label["end_t"] * 30)) if "end_t" in label else len(trans)
                for category in label["act_cat"] or []:
                    if category in classes and first < last:
                        a = classes.index(category)
                        motion = represent(matrices[first:last], trans[first:last])
                        out[f"{label['seg_id']}_l{index:02}_A{a + 1:03}"] = (split, a, motion)
    return out


def compare(dataset, made, folder, represent):
    with open(os.path.join(dataset, "dataset.json"), encoding="utf-8") as file:
        header = json.load(file)
    expected = wanted(made, folder, header["classes"], represent)
    seen, worst = set(), 0.0
    for path in sorted(glob.glob(os.path.join(dataset, "shard-*.h5"))):
        with h5py.File(path) as shard:
            clips = {key: shard["clip"][key][()] for key in ("name", "split", "label", "offset", "length")}
            for name, split, label, offset, length in zip(*clips.values()):
                name = name.decode()
                split_wanted, label_wanted, motion = expected[name]
                if (split.decode(), label, length) != (split_wanted, label_wanted, len(motion)):
                    sys.exit(f"{name}: {split} {label} {length}, not {split_wanted} {label_wanted} {len(motion)}")
                worst = np.maximum(worst, np.abs(shard["motion"][offset : offset + length, 0] - motion).max())
                seen.add(name)
    if seen != set(expected):
        sys.exit(f"{dataset}: {len(set(expected) - seen)} clips are missing, {len(seen - set(expected))} are too many")
    print(os.path.basename(dataset), len(seen), worst)


def main(folder, labels, rotations, places, published):
    recordings = {}
    for path in glob.glob(os.path.join(folder, "*/*/*.npz")):
        with np.load(path) as file:
            recordings[os.path.relpath(path, folder)] = (file["poses"], file["trans"], float(file["mocap_framerate"]))
    made = {path: by_slerp(*recording) for path, recording in recordings.items()}
    compare(rotations, made, labels, rot6d)
    compare(places, made, labels, xyz)
    compare(published, {path: by_zoom(*recording) for path, recording in recordings.items()}, labels, rot6d)


main(*sys.argv[1:])
