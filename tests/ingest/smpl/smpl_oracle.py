"""SMPL's formulas (Loper et al. 2015, equations 2 to 10) in NumPy, and the reading of its file by NumPy.

usage: smpl_oracle.py MODEL.npz|MODEL.pkl POSED.npz
POSED.npz: rotation_vectors (frames, 24, 3), betas, translation (frames, 3), joints (frames, 24, 3), vertices (frames, V, 3).
Prints how far joints and vertices are from the formulas' at most, in metres.
"""
import pickle
import sys

import numpy as np


def rotation(v):
    angle = np.linalg.norm(v)
    if angle == 0:
        return np.eye(3)
    x, y, z = v / angle
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def posed(model, betas, vectors, translation):
    parents = model["kintree_table"][0].astype(np.int64)
    shaped = model["v_template"] + model["shapedirs"][..., : len(betas)] @ betas
    joints = model["J_regressor"] @ shaped
    turns = np.array([rotation(v) for v in vectors])
    body = shaped + model["posedirs"] @ (turns[1:] - np.eye(3)).ravel()
    world = np.zeros((24, 4, 4))
    for k in range(24):
        own = np.eye(4)
        own[:3, :3] = turns[k]
        own[:3, 3] = joints[k] - (joints[parents[k]] if k else 0)
        world[k] = world[parents[k]] @ own if k else own
    places = world[:, :3, 3].copy()
    world[:, :3, 3] -= np.einsum("kij,kj->ki", world[:, :3, :3], joints)
    blend = np.einsum("vk,kij->vij", model["weights"], world)
    skin = np.einsum("vij,vj->vi", blend[:, :3, :3], body) + blend[:, :3, 3]
    return places + translation, skin + translation


class Attributes:
    """Stands for chumpy's and scipy's classes."""

    def __setstate__(self, state):
        self.__dict__.update(state)

    def array(self):
        if hasattr(self, "x"):
            return self.x
        out = np.zeros(self._shape)
        for column in range(out.shape[1]):
            for i in range(self.indptr[column], self.indptr[column + 1]):
                out[self.indices[i], column] += self.data[i]
        return out


class Reader(pickle.Unpickler):
    def find_class(self, module, name):
        return Attributes if module.startswith(("chumpy", "scipy")) else super().find_class(module, name)


def arrays(path):
    if path.endswith(".npz"):
        file = np.load(path)
        return {key: file[key] for key in file}
    with open(path, "rb") as file:
        found = Reader(file, encoding="latin1").load()
    return {key: value.array() if isinstance(value, Attributes) else value for key, value in found.items()}


model, made = arrays(sys.argv[1]), arrays(sys.argv[2])
worst = [0.0, 0.0]
for t in range(len(made["translation"])):
    wanted = posed(model, made["betas"], made["rotation_vectors"][t], made["translation"][t])
    for i, key in enumerate(("joints", "vertices")):
        worst[i] = np.maximum(worst[i], np.abs(made[key][t] - wanted[i]).max())
print(*worst)
