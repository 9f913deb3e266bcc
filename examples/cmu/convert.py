#!/usr/bin/env python3
"""Makes cmu.tar.xz: segments of CMU motion in AMASS's layout as BVH files, PART/ACTION/SUBJECT_TRIAL.bvh.

    convert.py FOLDER labels.csv -o cmu.tar.xz

FOLDER has SUBJECT/TRIAL_poses.npz with `poses` (frames, 156) as axis-angles on SMPL's tree, `trans` (frames, 3) in metres with z up, and
`mocap_framerate`; labels.csv the columns file, subject, trial, action, start_s, end_s, split. Needs NumPy and SciPy.
"""
import argparse
import collections
import csv
import io
import pathlib
import tarfile

import numpy as np
from scipy.spatial.transform import Rotation, Slerp

FPS = 30
LONGEST = 4  # seconds a file: longer segments are cut, so that an action has about as many clips as it lasts
# What the files call an action, and what it is called here; others are left out, for they have too few clips.
ACTIONS = {
    "walk": "walking", "run": "running", "jump": "jumping", "dance": "dancing", "climb": "climbing", "squat": "squatting",
    "twist": "twisting", "basketball_dribble": "dribbling a ball", "soccer_kick": "kicking a ball", "reach_up": "reaching up",
    "knee_raise": "raising the knees", "arm_circle": "circling the arms", "jumping_jacks": "jumping jacks", "swordplay": "sword play",
}
TEST_TRIALS = {("climb", "14")}  # labels.csv has no test part for climbing

# SMPL's tree, and the mean T-pose of eight CMU subjects on it: metres from the parent, left side; the right side is its mirror image.
PARENTS = [-1, 0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 9, 9, 12, 13, 14, 16, 17, 18, 19, 20, 21]
NAMES = """pelvis left_hip right_hip spine1 left_knee right_knee spine2 left_ankle right_ankle spine3 left_foot right_foot neck
left_collar right_collar head left_shoulder right_shoulder left_elbow right_elbow left_wrist right_wrist left_hand right_hand""".split()
OFFSETS = {
    "hip": (0.0916, -0.1, 0.02), "knee": (0, -0.404, 0), "ankle": (0, -0.428, 0), "foot": (0, -0.03, 0.117), "spine1": (0, 0.078, -0.004),
    "spine2": (0, 0.078, -0.004), "spine3": (0, 0.078, -0.004), "neck": (0, 0.093, -0.012), "head": (0, 0.093, -0.012),
    "collar": (0.06, 0.04, 0), "shoulder": (0.124, 0.02, -0.008), "elbow": (0.296, 0, 0), "wrist": (0.185, 0, 0), "hand": (0.08, 0, 0),
}
TIPS = {"head": (0, 0.2, 0), "foot": (0, 0, 0.07), "hand": (0.09, 0, 0)}
FEET = [NAMES.index("left_foot"), NAMES.index("right_foot")]


def offset(table, name):
    """Offset of a joint, mirrored for the right side."""
    side, _, part = name.rpartition("_")
    x, y, z = table[part]
    return (-x if side == "right" else x, y, z)


def resampled(path, begin, end):
    """Rotations (frames, 24, 3) as axis-angles with y up, and root positions (frames, 3) in metres, FPS a second."""
    with np.load(path) as file:
        poses, trans, rate = file["poses"][:, :72].reshape(-1, 24, 3), file["trans"], float(file["mocap_framerate"])
    seconds = np.arange(len(poses)) / rate
    begin = max(begin, 1 / FPS)  # the first frame of some files is an added T-pose
    at = np.minimum(np.arange(begin, min(end, seconds[-1]), 1 / FPS), seconds[-1])
    turned = np.stack([Slerp(seconds, Rotation.from_rotvec(poses[:, k]))(at).as_rotvec() for k in range(24)], axis=1)
    up = Rotation.from_euler("x", -90, degrees=True)
    turned[:, 0] = (up * Rotation.from_rotvec(turned[:, 0])).as_rotvec()
    root = np.stack([np.interp(at, seconds, trans[:, c]) for c in range(3)], axis=1)
    return turned, up.apply(root)


def heights(turned, root):
    """Height of each foot's tip over the frames, metres."""
    where, rotation = [root], [Rotation.from_rotvec(turned[:, 0])]
    for k in range(1, 24):
        parent = PARENTS[k]
        where.append(where[parent] + rotation[parent].apply(offset(OFFSETS, NAMES[k])))
        rotation.append(rotation[parent] * Rotation.from_rotvec(turned[:, k]))
    return np.stack([where[k][:, 1] for k in FEET])


def hierarchy():
    """The HIERARCHY of the files, and the joints in its order."""
    lines, order = ["HIERARCHY"], []

    def joint(k, depth):
        pad = "\t" * depth
        order.append(k)
        at = [0, 0, 0] if k == 0 else [100 * length for length in offset(OFFSETS, NAMES[k])]
        channels = "6 Xposition Yposition Zposition" if k == 0 else "3"
        lines.extend([f"{pad}{'ROOT' if k == 0 else 'JOINT'} {NAMES[k]}", pad + "{", f"{pad}\tOFFSET {at[0]:g} {at[1]:g} {at[2]:g}",
                      f"{pad}\tCHANNELS {channels} Zrotation Xrotation Yrotation"])
        children = [child for child in range(24) if PARENTS[child] == k]
        for child in children:
            joint(child, depth + 1)
        if not children:
            tip = [100 * length for length in offset(TIPS, NAMES[k])]
            lines.extend([f"{pad}\tEnd Site", f"{pad}\t{{", f"{pad}\t\tOFFSET {tip[0]:g} {tip[1]:g} {tip[2]:g}", f"{pad}\t}}"])
        lines.append(pad + "}")

    joint(0, 0)
    return lines, order


def bvh(turned, root):
    """The text of a BVH file: centimetres and degrees, feet on the floor, the walk beginning above the origin."""
    lines, order = hierarchy()
    root = 100 * (root - [root[0, 0], np.percentile(heights(turned, root).min(axis=0), 5), root[0, 2]])
    angles = np.stack([Rotation.from_rotvec(turned[:, k]).as_euler("ZXY", degrees=True) for k in order], axis=1).reshape(len(root), -1)
    lines += ["MOTION", f"Frames: {len(root)}", f"Frame Time: {1 / FPS:.6f}"]
    for place, angle in zip(root, angles):
        lines.append(" ".join(f"{number:.2f}" for number in [*place, *angle]))
    return "\n".join(lines) + "\n"


def files(folder, labels):
    """Names and contents of the files."""
    pieces = collections.Counter()
    for row in csv.DictReader(labels.open()):
        if row["action"] not in ACTIONS:
            continue
        test = row["split"] == "test" or (row["action"], row["trial"]) in TEST_TRIALS
        stem = f"{'test' if test else 'train'}/{ACTIONS[row['action']]}/{pathlib.PurePath(row['file']).stem.removesuffix('_poses')}"
        turned, root = resampled(folder / row["file"], float(row["start_s"]), float(row["end_s"]))
        count = -(-len(root) // (LONGEST * FPS))
        for piece in zip(np.array_split(turned, count), np.array_split(root, count)):
            pieces[stem] += 1
            yield f"{stem}_{pieces[stem]}.bvh", bvh(*piece).encode()


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("labels", type=pathlib.Path)
    parser.add_argument("-o", "--out", default="cmu.tar.xz")
    options = parser.parse_args()
    with tarfile.open(options.out, "w:xz", preset=9) as archive:
        for name, text in sorted(files(options.folder, options.labels)):
            entry = tarfile.TarInfo(name)
            entry.size, entry.mode = len(text), 0o644
            archive.addfile(entry, io.BytesIO(text))


if __name__ == "__main__":
    main()
