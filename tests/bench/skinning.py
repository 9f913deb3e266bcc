#!/usr/bin/python3
"""SMPL's body in NumPy, as its users have it, beside the program's kernels.

usage: skinning.py make FOLDER FRAMES        a random model of SMPL's sizes and random poses: FOLDER/model.npz, FOLDER/poses.npz
       skinning.py time FOLDER float64|float32    prints frames a second, the best of five runs
       skinning.py check FOLDER              prints how far FOLDER/posed.npz is from the formulas at most, in metres

Batches of frames go through matrix products of BLAS: what depends on shape alone is made once.
"""
import sys
import time

import numpy as np

VERTICES, JOINTS, SHAPES = 6890, 24, 10
PARENTS = [-1, 0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 9, 9, 12, 13, 14, 16, 17, 18, 19, 20, 21]
BATCH = 64


def make(folder, frames):
    random = np.random.default_rng(1)
    places = random.normal(0, 0.3, (JOINTS, 3))
    owner = random.integers(0, JOINTS, VERTICES)
    weights = np.zeros((VERTICES, JOINTS))
    for _ in range(4):  # at most four joints a vertex, as SMPL has
        weights[np.arange(VERTICES), random.integers(0, JOINTS, VERTICES)] += random.random(VERTICES) + 0.05
    regressor = np.zeros((JOINTS, VERTICES))
    for k in range(JOINTS):
        regressor[k, random.choice(VERTICES, 10, replace=False)] = 0.1
    np.savez(
        folder + "/model.npz",
        v_template=places[owner] + random.normal(0, 0.1, (VERTICES, 3)),
        shapedirs=random.normal(0, 0.01, (VERTICES, 3, SHAPES)),
        posedirs=random.normal(0, 0.003, (VERTICES, 3, 9 * (JOINTS - 1))),
        J_regressor=regressor,
        weights=weights / weights.sum(1, keepdims=True),
        kintree_table=np.array([PARENTS, range(JOINTS)]),
        f=random.integers(0, VERTICES, (13776, 3)),
    )
    np.savez(
        folder + "/poses.npz",
        rotations=rotations(random.normal(0, 0.3, (frames, JOINTS, 3))),
        translation=random.normal(0, 1, (frames, 3)),
        betas=random.normal(0, 1, SHAPES),
    )


def rotations(vectors):
    angle = np.linalg.norm(vectors, axis=-1)[..., None, None]
    x, y, z = np.moveaxis(vectors / angle[..., 0], -1, 0)
    none = np.zeros_like(x)
    cross = np.stack([none, -z, y, z, none, -x, -y, x, none], -1).reshape(*x.shape, 3, 3)
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


class Body:
    def __init__(self, model, betas, kind):
        shaped = model["v_template"] + model["shapedirs"] @ betas
        self.joints = (model["J_regressor"] @ shaped).astype(kind)
        self.shaped = shaped.ravel().astype(kind)
        self.directions = np.ascontiguousarray(model["posedirs"].reshape(-1, 9 * (JOINTS - 1)).T.astype(kind))
        self.weights = model["weights"].astype(kind)
        self.kind = kind

    def posed(self, turns, translation):
        frames = len(turns)
        body = (turns[:, 1:] - np.eye(3, dtype=self.kind)).reshape(frames, -1) @ self.directions + self.shaped
        world = np.zeros((frames, JOINTS, 4, 4), self.kind)
        world[:, :, :3, :3] = turns
        world[:, :, 3, 3] = 1
        for k in range(JOINTS):
            world[:, k, :3, 3] = self.joints[k] - (self.joints[PARENTS[k]] if k else 0)
            if k:
                world[:, k] = world[:, PARENTS[k]] @ world[:, k]
        joints = world[:, :, :3, 3] + translation[:, None]
        world[:, :, :3, 3] -= (world[:, :, :3, :3] @ self.joints[:, :, None])[..., 0]
        blend = self.weights @ world[:, :, :3].reshape(frames, JOINTS, 12)
        blend = blend.reshape(frames, VERTICES, 3, 4)
        body = body.reshape(frames, VERTICES, 3, 1)
        skin = (blend[..., :3] @ body)[..., 0] + blend[..., 3]
        return joints, skin + translation[:, None]


def read(folder, kind):
    model, poses = np.load(folder + "/model.npz"), np.load(folder + "/poses.npz")
    body = Body({key: model[key] for key in model}, poses["betas"], kind)
    return body, poses["rotations"].astype(kind), poses["translation"].astype(kind)


def measure(folder, kind):
    body, turns, translation = read(folder, np.dtype(kind))
    best = np.inf
    for _ in range(5):
        start = time.perf_counter()
        for at in range(0, len(turns), BATCH):
            body.posed(turns[at : at + BATCH], translation[at : at + BATCH])
        best = min(best, time.perf_counter() - start)
    print(len(turns) / best)


def check(folder):
    body, turns, translation = read(folder, np.dtype("float64"))
    made = np.load(folder + "/posed.npz")
    worst = 0
    for at in range(0, len(turns), BATCH):
        for key, wanted in zip(("joints", "vertices"), body.posed(turns[at : at + BATCH], translation[at : at + BATCH])):
            worst = np.maximum(worst, np.abs(made[key][at : at + BATCH] - wanted).max())
    print(worst)


if sys.argv[1] == "make":
    make(sys.argv[2], int(sys.argv[3]))
elif sys.argv[1] == "time":
    measure(sys.argv[2], sys.argv[3])
else:
    check(sys.argv[2])
