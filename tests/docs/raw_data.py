#!/usr/bin/python3
"""Makes, in the current folder, raw data under the names that the pages give to a reader's own: raw_data.py NAME...

What has a licence is made by `actformer synth`, or made up.
"""
import json
import pathlib
import pickle
import shutil
import subprocess
import sys
import tarfile
import tempfile
import zipfile

import numpy as np

# SMPL's joints at rest, in metres, roughly: parent, x, y, z.
SMPL = [(-1, 0, 0.95, 0), (0, 0.07, 0.86, 0), (0, -0.07, 0.86, 0), (0, 0, 1.05, 0), (1, 0.1, 0.5, 0), (2, -0.1, 0.5, 0), (3, 0, 1.18, 0),
        (4, 0.09, 0.09, -0.03), (5, -0.09, 0.09, -0.03), (6, 0, 1.24, 0), (7, 0.11, 0.03, 0.1), (8, -0.11, 0.03, 0.1), (9, 0, 1.45, 0),
        (9, 0.08, 1.36, 0), (9, -0.08, 1.36, 0), (12, 0, 1.54, 0.03), (13, 0.17, 1.38, 0), (14, -0.17, 1.38, 0), (16, 0.43, 1.37, 0),
        (17, -0.43, 1.37, 0), (18, 0.68, 1.38, 0), (19, -0.68, 1.38, 0), (20, 0.76, 1.37, 0), (21, -0.76, 1.37, 0)]


def synth(name, folder, clips=30):
    """What `actformer synth` makes, in a folder without what says that it made it."""
    subprocess.run(["actformer", "synth", name, "-o", folder, "--clips", str(clips)], check=True, stdout=subprocess.DEVNULL)
    for said in ("ORIGIN", "synth.json"):
        (pathlib.Path(folder) / said).unlink()
    return pathlib.Path(folder)


def tar(name, folder, *members):
    with tarfile.open(name, f"w:{name.rpartition('.')[2]}") as archive:
        for member in members:
            archive.add(folder / member, member)


def zip_of(name, files):
    with zipfile.ZipFile(name, "w") as archive:
        for file in files:
            archive.write(file, file.name)


def ntu(raw):
    clips = sorted(synth("ntu", raw / "ntu").glob("*.skeleton"))
    old = [clip for clip in clips if clip.name < "S018"]
    zip_of("nturgbd_skeletons_s001_to_s017.zip", old)
    zip_of("nturgbd_skeletons_s018_to_s032.zip", [clip for clip in clips if clip not in old])
    pathlib.Path("NTU_RGBD120_samples_with_missing_skeletons.txt").write_text(f"the clips that lack skeletons\n{old[0].stem}\n")


def babel(raw):
    made = synth("babel", raw / "babel", 100)
    for folder in ("amass", "babel_v1.0_release"):
        shutil.copytree(made / folder, folder, dirs_exist_ok=True)
    for subset in ("CMU", "KIT"):
        tar(f"{subset}.tar.bz2", made / "amass", subset)
    zip_of("babel_v1.0_release.zip", sorted((made / "babel_v1.0_release").iterdir()))


def gta(raw):
    for file in synth("gta", raw / "gta").glob("*.h5"):
        shutil.copy(file, file.name)
    rows = [[frame, person, joint, 0, 0, person + 0.02 * frame, -0.07 * joint, 5 + 0.01 * joint, 0, 0]
            for frame in range(70) for person in (1, 2) for joint in range(22)]
    folder = pathlib.Path("annotations/train")
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "seq_0.json").write_text(json.dumps(rows))


def nturecon(raw):
    shutil.copytree(synth("nturecon", raw / "nturecon") / "motions", "motions", dirs_exist_ok=True)


def ntu13(raw):
    shutil.copytree(synth("ntu13", raw / "ntu13"), "downloads/ntu13", dirs_exist_ok=True)


def walk(joints):
    """Joints that go one way together: (frames, joints, 3) in metres."""
    return (np.linspace(0, 1, 70)[:, None, None] * [0, 0, 1] + joints).astype(np.float32)


def humanact12(raw):
    tar("HumanAct12Poses.tar.gz", synth("humanact12", raw / "humanact12"), "HumanAct12Poses")
    joints = np.array(SMPL)[:, 1:] * [1, -1, 1]  # the camera's y points down
    for action in ("A0101", "A0201"):
        np.save(raw / f"P01G01R01F0001T0064{action}.npy", walk(joints))
    zip_of("HumanAct12.zip", sorted(raw.glob("*.npy")))


def uestc(raw):
    tar("uestc.tar.bz2", synth("uestc", raw / "uestc"), "vibe_cache_refined.pkl", "info")


def body(_raw):
    """SMPL's model file: an octahedron about each joint is its skin."""
    joints, parents = np.array(SMPL)[:, 1:], np.array(SMPL)[:, 0]
    corners = 0.05 * np.concatenate([np.eye(3), -np.eye(3)])
    faces = [(a, b, c) for a in (0, 3) for b in (1, 4) for c in (2, 5)]
    vertices = (joints[:, None] + corners).reshape(-1, 3)
    of_joint = np.repeat(np.eye(24), 6, axis=0)
    model = {"v_template": vertices, "weights": of_joint, "J_regressor": of_joint.T / 6,
             "f": np.concatenate([np.array(faces) + 6 * k for k in range(24)]).astype(np.uint32),
             "shapedirs": np.zeros((144, 3, 10)), "posedirs": np.zeros((144, 3, 207)),
             "kintree_table": np.stack([parents % 2**32, np.arange(24)]).astype(np.int64)}
    pathlib.Path("SMPL_NEUTRAL.pkl").write_bytes(pickle.dumps(model))


def bvh_of_cmu(raw):
    with tarfile.open("examples/cmu/cmu.tar.xz") as archive:
        archive.extractall(raw / "cmu")
    return sorted((raw / "cmu").rglob("*.bvh"))


def captures(raw):
    """Recordings by action, and joints of a Kinect."""
    for k, file in enumerate(bvh_of_cmu(raw)[:6]):
        folder = pathlib.Path("captures") / file.parent.name
        folder.mkdir(parents=True, exist_ok=True)
        shutil.copy(file, folder / f"{k}.bvh")
    random = np.random.default_rng(1)
    for action in ("waving", "sitting"):
        folder = pathlib.Path("joints") / action
        folder.mkdir(parents=True, exist_ok=True)
        np.save(folder / "1.npy", walk(random.normal(0, 0.5, (25, 3)) + [0, 1, 0]))


def bnr(raw):
    """Recordings named as BNR's are: action, style, index."""
    styles = ("active", "exhausted", "masculine", "normal", "elderly", "feminine", "youthful")
    by_action = {}
    for file in bvh_of_cmu(raw):
        by_action.setdefault(file.parent.name.replace(" ", "-"), []).append(file)
    for action, files in list(by_action.items())[:10]:  # it has ten
        for style, file in zip(styles, files):
            shutil.copy(file, raw / f"dataset-2_{action}_{style}_001.bvh")
    tar("dataset-2.tar.xz", raw, *(file.name for file in raw.glob("dataset-2_*.bvh")))


def comparison(raw):
    """What the sweep `comparison` takes."""
    for folder in ("bnr", "cmu_amass"):
        pathlib.Path(folder).mkdir(exist_ok=True)
    bnr(raw)
    shutil.move("dataset-2.tar.xz", "bnr/dataset-2.tar.xz")
    made = synth("babel", raw / "babel", 100)
    tar("cmu_amass/CMU.tar.xz", made / "amass", "CMU")
    shutil.copytree(made / "babel_v1.0_release", "cmu_amass/babel_like", dirs_exist_ok=True)


MAKERS = {maker.__name__: maker for maker in (ntu, babel, gta, nturecon, ntu13, humanact12, uestc, body, captures, bnr, comparison)}

if __name__ == "__main__":
    for name in sys.argv[1:]:
        with tempfile.TemporaryDirectory(prefix="actformer-raw-") as folder:
            MAKERS[name](pathlib.Path(folder))
