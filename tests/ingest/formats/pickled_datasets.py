#!/usr/bin/python3
"""Computes with NumPy and SciPy what ingest makes of NTU-13, NTURecon, HumanAct12 and UESTC, and compares a dataset with it.

usage: pickled_datasets.py nturecon|ntu13|ntu13-joints|humanact12|humanact12-joints|uestc RAW_FOLDER DATASET

Prints "N clips agree", or what differs, and then exits with 1.
"""
import glob, json, os, pickle, re, sys, zlib

import h5py
import numpy as np
from scipy.spatial.transform import Rotation

TOLERANCE = 1e-6
UPRIGHT = np.diag([1.0, -1.0, -1.0])  # cameras look along z with y down


class JoblibUnpickler(pickle._Unpickler):
    """Arrays whose numbers follow their description in the file, as joblib 0.10 and later writes them."""

    class Wrapper:
        pass

    def find_class(self, module, name):
        return self.Wrapper if name == "NumpyArrayWrapper" else super().find_class(module, name)

    def load_build(self):
        pickle._Unpickler.load_build(self)
        w = self.stack[-1]
        if not isinstance(w, self.Wrapper):
            return
        if getattr(w, "numpy_array_alignment_bytes", None) is not None:
            self.file.read(self.file.read(1)[0])
        count = int(np.prod(w.shape, dtype=np.int64))
        numbers = np.frombuffer(self.file.read(count * w.dtype.itemsize), w.dtype)
        self.stack[-1] = numbers.reshape(w.shape, order=w.order)

    dispatch = {**pickle._Unpickler.dispatch, pickle.BUILD[0]: load_build}


def load_joblib(path):
    import io
    data = open(path, "rb").read()
    file = io.BytesIO(zlib.decompress(data) if data[:1] == b"x" else data)
    unpickler = JoblibUnpickler(file)
    unpickler.file = file
    # Frames would read ahead of the numbers.
    unpickler._file_read, unpickler._file_readline = file.read, file.readline
    unpickler.dispatch = {**unpickler.dispatch, pickle.FRAME[0]: lambda self: self.file.read(8)}
    return unpickler.load()


def rot6d(poses, translation, world):
    """(T, 25, 6) of rotation vectors (T, 72) and a translation (T, 3), both turned by the matrix `world`."""
    frames = len(poses)
    matrices = Rotation.from_rotvec(np.asarray(poses, float).reshape(-1, 3)).as_matrix().reshape(frames, 24, 3, 3)
    matrices[:, 0] = world @ matrices[:, 0]
    out = np.zeros((frames, 25, 6))
    out[:, :24] = matrices[:, :, :2].reshape(frames, 24, 6)
    way = np.asarray(translation, float) @ world.T
    out[:, 24, :3] = way - way.mean(0)
    return out


def limbs(joints, parents):
    """(T, K, 3) unit limbs of upright joints, the root about its mean."""
    joints = np.asarray(joints, float) @ UPRIGHT.T
    out = joints - joints[:, np.maximum(parents, 0)]
    out /= np.linalg.norm(out, axis=-1, keepdims=True) + 1e-4
    out[:, 0] = joints[:, 0] - joints[:, 0].mean(0)
    return out


SMPL = np.array([-1, 0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 9, 9, 12, 13, 14, 16, 17, 18, 19, 20, 21])
VIBE_18 = [8, 1, 2, 3, 4, 5, 6, 7, 0, 9, 10, 11, 12, 13, 14, 21, 24, 38]
TREE_18 = np.full(18, -1)
for chain in ([0, 12, 13, 14, 15], [0, 9, 10, 11, 16], [0, 1, 8, 17], [1, 5, 6, 7], [1, 2, 3, 4]):
    TREE_18[chain[1:]] = chain[:-1]
NTU_13 = [6, 7, 8, 9, 22, 23, 24, 38, 80, 93, 99, 100, 102]
ONE_PERSON = [a for a in range(1, 121) if not (50 <= a <= 60 or 106 <= a)]


def nturecon(raw):
    for path in glob.glob(raw + "/**/*_body0.pkl", recursive=True):
        name = os.path.basename(path)[: -len("_body0.pkl")]
        d = pickle.load(open(path, "rb"))
        action = int(name[-3:])
        if action in ONE_PERSON:
            motion = rot6d(d["smpl_poses"], d["smpl_trans"] / d["smpl_scaling"], UPRIGHT)
            yield name, ONE_PERSON.index(action), motion


def ntu13(raw, joints=False):
    for line in open(raw + "/ntu_vibe_list.txt"):
        path = os.path.join(raw, line.strip())
        if not os.path.exists(path):
            continue
        person = load_joblib(path).get(1)
        if person is None:
            continue
        name = os.path.basename(path)[:-4]
        if joints:
            motion = limbs(person["joints3d"][:, VIBE_18], TREE_18)
        else:
            motion = rot6d(person["pose"], person["joints3d"][:, 8], UPRIGHT)
        yield name, NTU_13.index(int(name[-3:])), motion


def humanact12(raw, joints=False):
    if joints:
        for path in glob.glob(raw + "/**/*.npy", recursive=True):
            name = os.path.basename(path)[:-4]
            yield name, int(name[-4:-2]) - 1, limbs(np.load(path), SMPL)
        return
    for path in glob.glob(raw + "/**/humanact12poses.pkl", recursive=True):
        d = pickle.load(open(path, "rb"))
        for i, (pose, joint, y) in enumerate(zip(d["poses"], d["joints3D"], d["y"])):
            yield f"A{y + 1:03}_{i:04}", y, rot6d(pose, joint[:, 0], UPRIGHT)


def uestc(raw):
    d = pickle.load(open(raw + "/vibe_cache_refined.pkl", "rb"))
    names = open(raw + "/info/names.txt").read().split()
    counts = [int(n) for n in open(raw + "/info/num_frames_min.txt").read().split()]
    for i, name in enumerate(names):
        action, view, subject, side = map(int, re.match(r"a(\d+)_d(\d+)_p(\d+)_c(\d+)_color.avi", name).groups())
        if side != 1 and view == 8:
            continue
        n = min(counts[i], len(d["pose"][i]))
        joints, camera = np.asarray(d["joints3d"][i][:n], float), np.asarray(d["orig_cam"][i][:n], float)
        flat = joints[:, :, :2]
        seen = (camera[:, None, :1] * (flat + camera[:, None, 2:4]) + 1) * 270
        size = lambda points: np.linalg.norm(points.max(1) - points.min(1), axis=-1)
        way = np.concatenate([camera[:, 2:4], (500 * size(flat) / size(seen))[:, None]], 1)
        turned = Rotation.from_euler("y", 0 if side == 1 else -45 * view, degrees=True).as_matrix()
        yield name[:-10], action, rot6d(d["pose"][i][:n], joints[:, 8] + way, UPRIGHT @ turned)


def dataset(folder):
    """name -> (label, motion (T, K, D))"""
    out = {}
    for shard in json.load(open(folder + "/dataset.json"))["shards"]:
        with h5py.File(os.path.join(folder, shard["file"])) as file:
            motion, clip = file["motion"], file["clip"]
            for i, name in enumerate(clip["name"]):
                first = clip["offset"][i]
                out[name.decode()] = clip["label"][i], motion[first : first + clip["length"][i], 0]
    return out


def main():
    format, raw, folder = sys.argv[1:]
    makers = {"nturecon": nturecon, "ntu13": ntu13, "ntu13-joints": lambda r: ntu13(r, True), "humanact12": humanact12,
              "humanact12-joints": lambda r: humanact12(r, True), "uestc": uestc}
    wanted = {name: (label, motion) for name, label, motion in makers[format](raw)}
    got = dataset(folder)
    if not wanted or sorted(wanted) != sorted(got):
        sys.exit(f"clips {sorted(got)}, not {sorted(wanted)}")
    worst = 0.0
    for name, (label, motion) in wanted.items():
        if got[name][0] != label or got[name][1].shape != motion.shape:
            sys.exit(f"{name}: label {got[name][0]}, shape {got[name][1].shape}; not {label}, {motion.shape}")
        # Translations reach many metres, of which float32 keeps seven digits.
        error = (np.abs(got[name][1] - motion) / np.maximum(1, np.abs(motion))).max()
        if not error < TOLERANCE:
            sys.exit(f"{name}: {error:.1e} off")
        worst = max(worst, error)
    print(f"{len(wanted)} clips agree, {worst:.1e} off at most")


main()
