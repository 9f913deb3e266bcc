"""Motions files: HDF5 in the layout of ActFormer's published tools, one (P*C, K, T) array a motion, with attributes that say whose
motions they are."""

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Dict, Iterable, Iterator, List, Optional, Sequence

import h5py
import numpy as np

from .body import NUMBERS, Body, Floats, joint_positions
from .errors import Error, suggestion
from .files import AnyPath, fixed_texts, member, new_file, open_hdf5, texts


@dataclass(frozen=True)
class Motion:
    """One motion. ``values`` (frames, persons, nodes, numbers) float32; ``label`` from 0."""

    name: str
    values: Floats
    label: Optional[int] = None
    bone_length: Optional[Floats] = None  # (persons, joints) metres, where they are this motion's own


class Motions:
    """A motions file, open for reading, one motion at a time.

    >>> file = Motions("motions.h5")
    >>> for motion in file:
    ...     joints = file.joints(motion)                # (frames, persons, joints, 3) metres
    >>> file.representation, len(file) > 0
    ('limb', True)

    ``representation`` is what a file that does not tell its own is taken for, as those of other tools.
    """

    def __init__(self, path: AnyPath, representation: str = "limb") -> None:
        self.path = Path(path)
        self._file = open_hdf5(self.path, "a motions file, as actformer generate and export make them")
        try:
            self._read_head(representation)
        except BaseException:
            self.close()
            raise

    def _read_head(self, otherwise: str) -> None:
        attributes = self._file.attrs
        self.names: List[str] = sorted(name for name in self._file if self._is_array(name))
        if not self.names:
            raise Error(f"{self.path}: holds no motions; one (P*C, K, T) array a motion is expected")
        told = "representation" in attributes
        self.representation: str = texts(attributes["representation"])[0] if told else otherwise
        if self.representation not in NUMBERS:
            raise Error(f"{self.path}: representation '{self.representation}' is none of {', '.join(NUMBERS)}")
        self.body: Optional[Body] = self._read_body()
        self.classes: List[str] = texts(attributes["classes"]) if "classes" in attributes else []
        self.fps = float(np.ravel(attributes["fps"])[0]) if "fps" in attributes else 30.0
        if not told and self.representation == "limb" and not _has_unit_limbs(self.read(self.names[0]).values):
            raise Error(f"{self.path}: '{self.names[0]}' holds no limb vectors, as their lengths are not 1; "
                        "where they are joint positions, give representation='xyz'")

    def _read_body(self) -> Optional[Body]:
        """None where the file does not tell its skeleton."""
        attributes = self._file.attrs
        if "parents" not in attributes:
            return None
        parents = tuple(int(p) for p in np.atleast_1d(attributes["parents"]))
        names = tuple(texts(attributes["names"])) if "names" in attributes else tuple(
            f"joint {j}" for j in range(len(parents)))
        try:
            lengths, rest = (
                np.asarray(attributes[what], np.float32).reshape(-1, width) if what in attributes else None
                for what, width in (("bone_length", len(parents)), ("rest", 3))
            )
            return Body(self.representation, names, parents, lengths, rest)
        except (ValueError, Error) as why:
            raise Error(f"{self.path}: its attributes names, parents, bone_length and rest contradict one another: {why}"
                        ) from None

    def __len__(self) -> int:
        return len(self.names)

    def __iter__(self) -> Iterator[Motion]:
        return (self.read(name) for name in self.names)

    def __getitem__(self, name: str) -> Motion:
        return self.read(name)

    def read(self, name: str) -> Motion:
        """The motion called ``name``."""
        if name not in self.names:
            raise Error(f"{self.path}: no motion is called '{name}'{suggestion(name, self.names)}")
        array, numbers = member(self._file, name), NUMBERS[self.representation]
        if array.ndim != 3 or array.shape[0] == 0 or array.shape[0] % numbers:
            raise Error(f"{self.path}: '{name}' of shape {array.shape} is no (P*{numbers}, K, T) array, as "
                        f"{self.representation} has them")
        stored: Floats = array[()].astype(np.float32)
        persons, (_, nodes, frames) = array.shape[0] // numbers, array.shape
        values = np.ascontiguousarray(stored.reshape(persons, numbers, nodes, frames).transpose(3, 0, 2, 1))
        label = int(np.ravel(array.attrs["label"])[0]) if "label" in array.attrs else _label_in(name)
        return Motion(name, values, label, self._own_lengths(array))

    def joints(self, motion: Motion, body: Optional[Body] = None) -> Floats:
        """(frames, persons, joints, 3) positions in metres, of the file's body or of ``body``."""
        body = body or self.body
        if body is None:
            raise Error(f"{self.path} does not say how its nodes hang together; give a body, as that of a dataset with the "
                        "same skeleton: body=Dataset(...).body_of(clip)")
        lengths = body.bone_length if motion.bone_length is None else motion.bone_length
        try:
            return joint_positions(motion.values, Body(body.representation, body.names, body.parents, lengths, body.rest))
        except Error as why:
            raise Error(f"{self.path}: '{motion.name}': {why}") from None

    def close(self) -> None:
        self._file.close()

    def _is_array(self, name: str) -> bool:
        try:
            return isinstance(member(self._file, name), h5py.Dataset)
        except KeyError:
            return False

    def __enter__(self) -> "Motions":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _own_lengths(self, array: h5py.Dataset) -> Optional[Floats]:
        if "bone_length" not in array.attrs or self.body is None:
            return None
        lengths = np.ravel(array.attrs["bone_length"]).astype(np.float32)
        if lengths.size == 0 or lengths.size % self.body.joints:
            raise Error(f"{self.path}: '{array.name[1:]}': {lengths.size} bone lengths for {self.body.joints} joints")
        return lengths.reshape(-1, self.body.joints)


def write_motions(
    path: AnyPath,
    motions: Iterable[Motion],
    body: Body,
    classes: Sequence[str] = (),
    fps: float = 30.0,
    source: str = "",
) -> None:
    """Writes a file that ``actformer render``, ``score``, ``features``, ``export`` and ``ingest motions`` read. It appears at ``path``
    whole or not at all, and is on the disk then; ``source`` says in a line where the motions come from.

    >>> wave = np.zeros((60, 1, 2, 3), np.float32)
    >>> wave[..., 1] = 1                                # one metre above the ground; a head above the hip
    >>> stick = Body("limb", ("hip", "head"), (-1, 0), bone_length=np.array([[0, 0.7]], np.float32))
    >>> write_motions("mine.h5", [Motion("A001_0", wave, label=0)], stick, classes=["stand"])
    >>> Motions("mine.h5")["A001_0"].values.shape
    (60, 1, 2, 3)
    """
    target = Path(path)
    try:
        with new_file(target) as partial, h5py.File(partial, "w") as file:
            persons = 0
            for motion in motions:
                if motion.name in file:
                    raise Error(f"{target}: two motions are called '{motion.name}'; give each a name of its own")
                _check(motion, body, classes, target)
                _write_one(file, motion)
                persons = max(persons, motion.values.shape[1])
            if persons == 0:
                raise Error(f"{target}: no motions are given")
            _describe(file, body, classes, fps, persons, source)
    except OSError as why:
        raise Error(f"{target}: cannot be written: {str(why).splitlines()[0]}") from None


def _check(motion: Motion, body: Body, classes: Sequence[str], target: Path) -> None:
    where, shape = f"{target}: '{motion.name}'", motion.values.shape
    if not motion.name or "/" in motion.name:
        raise Error(f"{where}: a motion's name has letters and no '/'")
    if len(shape) != 4 or shape[2:] != (body.nodes, body.numbers) or not shape[0] or not shape[1]:
        raise Error(f"{where} of shape {shape} is not (frames, persons, {body.nodes}, {body.numbers}), as "
                    f"{body.representation} of {body.joints} joints is")
    if not np.isfinite(motion.values).all():
        frame = int(np.argwhere(~np.isfinite(motion.values))[0][0])
        raise Error(f"{where}: frame {frame} holds a number that is not finite; leave the motion out, or make it anew")
    if body.representation == "limb" and not _has_unit_limbs(motion.values):
        raise Error(f"{where} holds no limb vectors, as their lengths are not 1; where they are joint positions, give a "
                    "Body of representation 'xyz'")
    if motion.label is not None and (motion.label < 0 or (classes and motion.label >= len(classes))):
        raise Error(f"{where}: label {motion.label} is none of {len(classes)} classes, counted from 0")
    if motion.bone_length is not None and motion.bone_length.shape != (shape[1], body.joints):
        raise Error(f"{where}: bone_length of shape {motion.bone_length.shape} is not ({shape[1]}, {body.joints})")


def _write_one(file: h5py.File, motion: Motion) -> None:
    frames, persons, nodes, numbers = motion.values.shape
    stored = motion.values.transpose(1, 3, 2, 0).reshape(persons * numbers, nodes, frames)
    array = file.create_dataset(motion.name, data=np.ascontiguousarray(stored, np.float32))
    if motion.label is not None:
        array.attrs["label"] = np.int64(motion.label)
    if motion.bone_length is not None:
        array.attrs["bone_length"] = np.ravel(motion.bone_length).astype(np.float32)


def _describe(
    file: h5py.File, body: Body, classes: Sequence[str], fps: float, persons: int, source: str
) -> None:
    attributes: Dict[str, object] = {
        "representation": fixed_texts([body.representation])[0],
        "parents": np.array(body.parents, np.int64),
        "names": fixed_texts(body.names),
        "persons": np.int64(persons),
        "fps": np.array([fps], np.float32),
        "program": fixed_texts(["actformer, the Python package"])[0],
    }
    if body.bone_length is not None:
        known = body.bone_length
        lengths = known[[p if p < len(known) else 0 for p in range(persons)]]
        attributes["bone_length"] = np.ravel(lengths).astype(np.float32)
    if body.representation == "rot6d" and body.rest is not None:
        attributes["rest"] = np.ravel(body.rest).astype(np.float32)
    if classes:
        attributes["classes"] = fixed_texts(classes)
    if source:
        attributes["source"] = fixed_texts([source])[0]
    for name, value in attributes.items():
        file.attrs.create(name, value, dtype=getattr(value, "dtype", None))


def _has_unit_limbs(values: Floats) -> bool:
    """Whether half of the nodes behind the first are as long as a unit vector, within a twentieth."""
    if values.shape[2] < 2:
        return True
    length = np.linalg.norm(values[:, :, 1:], axis=-1)
    return bool(np.mean(np.abs(length - 1) <= 0.05) >= 0.5)


def _label_in(name: str) -> Optional[int]:
    """The label, from 0, in a name like S001C001P001R001A001, A001_7 or A001_front; none in others.

    >>> _label_in("A003_7"), _label_in("walk_1")
    (2, None)
    """
    found = re.findall(r"A(\d{3,})(?![0-9A-Za-z])", name)
    return int(found[-1]) - 1 if found and int(found[-1]) > 0 else None
