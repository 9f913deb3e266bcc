"""From the numbers of a motion to the positions of its joints."""

from dataclasses import dataclass
from typing import Dict, List, Optional, Tuple

import numpy as np
from numpy.typing import NDArray

from .errors import Error, suggestion

Floats = NDArray[np.float32]

#: Numbers of a node in every representation.
NUMBERS: Dict[str, int] = {"limb": 3, "rot6d": 6, "xyz": 3}


@dataclass(frozen=True)
class Body:
    """What makes joint positions of a motion's numbers.

    ``limb``: node 0 is the root's position in metres, every other node the unit vector from its parent; ``bone_length``
    (persons, joints) makes a body of them. ``rot6d``: a node a joint with the first two rows of its rotation below its parent,
    and one more node with the translation; ``rest`` (joints, 3) is the skeleton that they turn. ``xyz``: positions.

    >>> stick = Body("limb", ("hip", "head"), (-1, 0), bone_length=np.array([[0, 0.7]], np.float32))
    >>> stick.nodes, stick.numbers
    (2, 3)
    """

    representation: str
    names: Tuple[str, ...]
    parents: Tuple[int, ...]  # -1 for the root, which is joint 0
    bone_length: Optional[Floats] = None
    rest: Optional[Floats] = None

    def __post_init__(self) -> None:
        if self.representation not in NUMBERS:
            hint = suggestion(self.representation, NUMBERS)
            raise Error(f"representation '{self.representation}' is none of {', '.join(NUMBERS)}{hint}")
        if len(self.names) != len(self.parents):
            raise Error(f"{len(self.names)} names of joints do not go with {len(self.parents)} parents")
        self.order()
        shapes = (("bone_length", self.bone_length, (None, self.joints)), ("rest", self.rest, (self.joints, 3)))
        for what, value, shape in shapes:
            if value is None:
                continue
            if value.ndim != 2 or value.shape[1] != shape[1] or shape[0] not in (None, value.shape[0]):
                raise Error(f"{what} of shape {value.shape} does not go with {self.joints} joints")

    @property
    def joints(self) -> int:
        return len(self.parents)

    @property
    def numbers(self) -> int:
        """Numbers of a node."""
        return NUMBERS[self.representation]

    @property
    def nodes(self) -> int:
        """Nodes of a person: the joints, and for ``rot6d`` the translation."""
        return self.joints + (self.representation == "rot6d")

    def order(self) -> List[int]:
        """The joints, each after its parent. Raises Error unless they are one tree rooted at joint 0."""
        if not self.parents or self.parents[0] != -1:
            raise Error("joint 0 is the root: its parent is -1")
        children: List[List[int]] = [[] for _ in self.parents]
        for joint, parent in enumerate(self.parents):
            if joint > 0 and not 0 <= parent < len(self.parents):
                raise Error(f"joint {joint} has the parent {parent}; joints are counted from 0 to {len(self.parents) - 1}")
            if joint > 0:
                children[parent].append(joint)
        order = [0]
        for joint in order:
            order.extend(children[joint])
        if len(order) != len(self.parents):
            raise Error("the joints are no tree: some of them do not hang on the root")
        return order


def joint_positions(motion: Floats, body: Body) -> Floats:
    """(frames, persons, joints, 3) positions in metres of ``motion`` (frames, persons, nodes, numbers).

    Limbs: the parent's position + bone length * the limb's direction; persons beyond those whose lengths are known are as long as
    the first.
    Rotations: forward kinematics of the rest skeleton, as in SMPL (Loper et al. 2015, equations 2 and 3). Computed in float64.

    >>> stick = Body("limb", ("hip", "head"), (-1, 0), bone_length=np.array([[0, 0.7]], np.float32))
    >>> joint_positions(np.array([[[[0, 1, 0], [0, 1, 0]]]], np.float32), stick)[0, 0, 1].tolist()
    [0.0, 1.7000000476837158, 0.0]
    """
    if motion.ndim != 4 or motion.shape[2:] != (body.nodes, body.numbers):
        raise Error(
            f"a motion of shape {motion.shape} is not (frames, persons, {body.nodes}, {body.numbers}), "
            f"as {body.representation} of {body.joints} joints is"
        )
    if body.representation == "xyz":
        return motion.astype(np.float32)
    if body.representation == "rot6d":
        return _of_rotations(motion.astype(np.float64), body).astype(np.float32)
    return _of_limbs(motion.astype(np.float64), body).astype(np.float32)


def _of_limbs(motion: NDArray[np.float64], body: Body) -> NDArray[np.float64]:
    if body.bone_length is None:
        raise Error("limbs need the bone lengths of a body: give a Body with bone_length")
    persons = motion.shape[1]
    known = body.bone_length.astype(np.float64)
    length = known[[p if p < len(known) else 0 for p in range(persons)]]
    out = motion.copy()
    norm = np.linalg.norm(motion, axis=-1, keepdims=True)
    directions = np.divide(motion, norm, out=np.zeros_like(motion), where=norm > 0)
    for joint in body.order()[1:]:
        out[:, :, joint] = out[:, :, body.parents[joint]] + length[:, joint, None] * directions[:, :, joint]
    return out


def _of_rotations(motion: NDArray[np.float64], body: Body) -> NDArray[np.float64]:
    if body.rest is None:
        raise Error("rotations need the rest skeleton of a body: give a Body with rest")
    own = rotations(motion[:, :, : body.joints])
    rest = body.rest.astype(np.float64)
    turned = own.copy()  # of every joint in the world
    out = np.empty((*motion.shape[:2], body.joints, 3))
    out[:, :, 0] = motion[:, :, body.joints, :3] + rest[0]
    for joint in body.order()[1:]:
        parent = body.parents[joint]
        turned[:, :, joint] = turned[:, :, parent] @ own[:, :, joint]
        out[:, :, joint] = out[:, :, parent] + turned[:, :, parent] @ rest[joint]
    return out


def rotations(six: NDArray[np.float64]) -> NDArray[np.float64]:
    """(..., 3, 3) rotations of (..., 6) numbers, their first two rows, by Gram and Schmidt.

    >>> rotations(np.array([2.0, 0, 0, 1, 1, 0])).tolist()
    [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
    """

    def unit(v: NDArray[np.float64]) -> NDArray[np.float64]:
        length: NDArray[np.float64] = np.maximum(np.linalg.norm(v, axis=-1, keepdims=True), 1e-12)
        return v / length

    first = unit(six[..., :3])
    second = six[..., 3:]
    second = unit(second - np.sum(first * second, axis=-1, keepdims=True) * first)
    return np.stack([first, second, np.cross(first, second)], axis=-2)
