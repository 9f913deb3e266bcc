#!/usr/bin/python3
"""`actformer ingest uestc` beside NumPy and SciPy on a pickle of VIBE's videos: wall time and memory of both.

usage: pickles.py ACTFORMER [VIDEOS] [FRAMES]

Makes UESTC's layout with that many videos (default 2000 of 90 frames, 170 MB), reads it with `pickle`, turns the rotation vectors into 6
numbers a joint as the dataset has them, rebuilds the way, and writes one HDF5 file; then lets the program do the same from the same files
into shards with checksums. Each is measured in a process of its own, the files being in memory from the start.
"""
import os, resource, subprocess, sys, tempfile, time

import numpy as np


def make(folder, videos, frames):
    import pickle
    rng = np.random.default_rng(0)
    shapes = {"pred_cam": (3,), "orig_cam": (4,), "pose": (72,), "betas": (10,), "joints3d": (49, 3), "bboxes": (4,)}
    data = {key: [rng.uniform(0.1, 1, (frames, *shape)).astype("f4") for _ in range(videos)] for key, shape in shapes.items()}
    data["frame_ids"] = [np.arange(frames) for _ in range(videos)]
    os.makedirs(folder + "/info")
    with open(folder + "/vibe_cache_refined.pkl", "wb") as file:
        pickle.dump(data, file, 4)
    lines = {
        "names": [f"a{i % 40}_d{i // 40 % 8}_p{i // 320 % 118 + 1:03}_c{i // 37760 + 1}_color.avi" for i in range(videos)],
        "num_frames_min": [str(frames)] * videos,
        "action_classes": [f"action {i}" for i in range(40)],
    }
    for name, text in lines.items():
        with open(f"{folder}/info/{name}.txt", "w") as file:
            file.write("\n".join(text))


def peer(folder, out):
    """As one would write it: whole arrays, one video after another."""
    import pickle
    import h5py
    from scipy.spatial.transform import Rotation
    upright = np.diag([1.0, -1.0, -1.0])
    size = lambda points: np.linalg.norm(points.max(1) - points.min(1), axis=-1)
    with open(folder + "/vibe_cache_refined.pkl", "rb") as file:
        data = pickle.load(file)
    names = open(folder + "/info/names.txt").read().split()
    with h5py.File(out, "w") as file:
        for i, name in enumerate(names):
            pose, joints, camera = (data[key][i].astype("f8") for key in ("pose", "joints3d", "orig_cam"))
            frames = len(pose)
            view = int(name.split("_")[1][1:]) if name.split("_")[3] != "c1" else 0
            world = upright @ Rotation.from_euler("y", -45 * view, degrees=True).as_matrix()
            matrices = Rotation.from_rotvec(pose.reshape(-1, 3)).as_matrix().reshape(frames, 24, 3, 3)
            matrices[:, 0] = world @ matrices[:, 0]
            flat = joints[:, :, :2]
            seen = (camera[:, None, :1] * (flat + camera[:, None, 2:4]) + 1) * 270
            way = np.concatenate([camera[:, 2:4], (500 * size(flat) / size(seen))[:, None]], 1)
            way = (joints[:, 8] + way) @ world.T
            motion = np.zeros((frames, 25, 6), "f4")
            motion[:, :24] = matrices[:, :, :2].reshape(frames, 24, 6)
            motion[:, 24, :3] = way - way.mean(0)
            file[name] = motion


def measured(command):
    start = time.time()
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return time.time() - start


def main():
    if sys.argv[1] == "--peer":
        return peer(*sys.argv[2:])
    program = sys.argv[1]
    videos, frames = (int(n) for n in (sys.argv[2:] + ["2000", "90"][len(sys.argv) - 2:])[:2])
    with tempfile.TemporaryDirectory() as temp:
        make(temp + "/uestc", videos, frames)
        bytes = os.path.getsize(temp + "/uestc/vibe_cache_refined.pkl")
        commands = {"NumPy and SciPy": [sys.executable, __file__, "--peer", temp + "/uestc", temp + "/peer.h5"],
                    "actformer": [program, "ingest", "uestc", temp + "/uestc", "-o", temp + "/out"]}
        seconds = {}
        for name, command in commands.items():
            before = resource.getrusage(resource.RUSAGE_CHILDREN)
            seconds[name] = measured(command)
            after = resource.getrusage(resource.RUSAGE_CHILDREN)
            cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
            print(f"{name}: {seconds[name]:.2f} s, {cpu:.2f} s of processors, {bytes / 1e6 / seconds[name]:.0f} MB/s")
        print(f"{bytes / 1e6:.0f} MB, {videos} videos of {frames} frames: {seconds['NumPy and SciPy'] / seconds['actformer']:.1f} times as fast")


main()
