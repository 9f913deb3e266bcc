"""Datasets: a folder with dataset.json and shards, as ``actformer ingest`` makes it."""

import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Dict, Iterator, List, Optional, Tuple

import h5py
import numpy as np

from .body import Body, Floats, joint_positions
from .errors import Error, suggestion
from .files import AnyPath, member, open_hdf5, read_json, texts

#: Versions of dataset.json that this package reads.
FORMATS = (1, 2, 3)


@dataclass(frozen=True)
class Condition:
    """A clip's ``field`` is (or, where ``negated``, is not) one of ``values``."""

    field: str
    values: Tuple[str, ...]
    negated: bool = False

    def holds(self, fields: Dict[str, str]) -> bool:
        """
        >>> Condition("camera", ("2", "3")).holds({"camera": "2"})
        True
        """
        return (fields[self.field] in self.values) != self.negated


@dataclass(frozen=True)
class Clip:
    """Where a clip is and what is known of it."""

    index: int  # in the dataset
    name: str
    label: int  # from 0
    class_name: str
    frames: int
    fields: Dict[str, str]  # metadata that splits ask for, as in {"performer": "1"}
    shard: int
    offset: int  # first frame within the shard
    row: int  # within the shard


class Dataset:
    """A dataset, open for reading. It may be copied to other processes, as a DataLoader's workers.

    >>> data = Dataset("ntu/ntu-1p")
    >>> data.representation, data.fps, data.body.joints
    ('limb', 30.0, 25)
    >>> clip = data.clips("xsub/test")[0]
    >>> clip.class_name == data.classes[clip.label]
    True
    >>> sorted(data.splits)[:2]
    ['xset/test', 'xset/train']
    """

    def __init__(self, folder: AnyPath) -> None:
        self.folder = Path(folder)
        self.header: Dict[str, Any] = _header(self.folder)
        header, where = self.header, self.folder / "dataset.json"
        try:
            self.name: str = header["name"]
            self.fps = float(header["fps"])
            self.persons = int(header["persons"])
            self.classes: List[str] = list(header["classes"])
            self.splits: Dict[str, Tuple[Condition, ...]] = {
                name: tuple(_condition(c) for c in conditions) for name, conditions in header["splits"].items()
            }
            topology, rest = header["topology"], header.get("rest")
            self.body = Body(
                header["representation"],
                tuple(topology["names"]),
                tuple(topology["parents"]),
                rest=None if rest is None else np.array(rest, np.float32),
            )
            self._fields: List[str] = list(header["fields"])
            for name, conditions in self.splits.items():
                for condition in conditions:
                    if condition.field not in self._fields:
                        raise Error(f"damaged: split '{name}' asks for '{condition.field}', which is none of the "
                                    "clips' fields; ingest the raw data again")
            self._shards: List[str] = [_file_name(shard["file"]) for shard in header["shards"]]
        except (KeyError, TypeError, ValueError, AttributeError) as why:
            raise Error(f"{where}: damaged: {type(why).__name__} {why}; ingest the raw data again") from None
        except Error as why:
            raise Error(f"{where}: {why}") from None
        self._open: Optional[Tuple[int, int, h5py.File]] = None  # process, shard, file
        self._clips: List[Clip] = []
        for shard in range(len(self._shards)):
            self._clips.extend(self._read_clips(shard))
        self._by_name = {clip.name: clip for clip in self._clips}

    @property
    def representation(self) -> str:
        return self.body.representation

    def __len__(self) -> int:
        return len(self._clips)

    def __iter__(self) -> Iterator[Clip]:
        return iter(self._clips)

    def __getitem__(self, name: str) -> Clip:
        """The clip called ``name``."""
        if name not in self._by_name:
            raise Error(f"{self.folder}: no clip is called '{name}'{suggestion(name, self._by_name)}")
        return self._by_name[name]

    def clips(self, split: str = "all") -> List[Clip]:
        """Those of a split, as in ``"xsub/train"``; ``"all"`` is every clip."""
        if split == "all":
            return list(self._clips)
        if split not in self.splits:
            known = ["all", *self.splits]
            hint = suggestion(split, known) or f"; there are {', '.join(known)}"
            raise Error(f"{self.folder}: there is no split '{split}'{hint}")
        return [clip for clip in self._clips if all(c.holds(clip.fields) for c in self.splits[split])]

    def motion(self, clip: Clip) -> Floats:
        """(frames, persons, nodes, numbers) float32, as the representation has them."""
        motion: Floats = member(self._file(clip.shard), "motion")[clip.offset : clip.offset + clip.frames]
        return motion

    def bone_length(self, clip: Clip) -> Floats:
        """(persons, joints) metres; 0 for the root."""
        lengths: Floats = member(self._file(clip.shard), "clip/bone_length")[clip.row]
        return lengths

    def body_of(self, clip: Clip) -> Body:
        """What makes joints of this clip's motion."""
        body = self.body
        return Body(body.representation, body.names, body.parents, self.bone_length(clip), body.rest)

    def joints(self, clip: Clip) -> Floats:
        """(frames, persons, joints, 3) positions in metres."""
        return joint_positions(self.motion(clip), self.body_of(clip))

    def close(self) -> None:
        """Closes the shard that was read last; reading opens it again."""
        if self._open and self._open[0] == os.getpid():
            self._open[2].close()
        self._open = None

    def __enter__(self) -> "Dataset":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __getstate__(self) -> Dict[str, Any]:
        return {**self.__dict__, "_open": None}

    def _file(self, shard: int) -> h5py.File:
        """Open: a process of its own has a file of its own, as HDF5 does not share them."""
        if self._open is None or self._open[:2] != (os.getpid(), shard):
            self.close()
            file = open_hdf5(self.folder / self._shards[shard], "the whole dataset, or ingest the raw data again")
            self._open = (os.getpid(), shard, file)
        return self._open[2]

    def _read_clips(self, shard: int) -> Iterator[Clip]:
        path, file, fields = self.folder / self._shards[shard], self._file(shard), self._fields
        try:
            motion = member(file, "motion")
            frames = len(motion)
            if motion.shape[1:] != (self.persons, self.body.nodes, self.body.numbers):
                raise Error(f"{path}: 'motion' of shape {motion.shape} is not as dataset.json says; ingest again")
            names, offsets, lengths, labels = (member(file, f"clip/{c}")[()] for c in ("name", "offset", "length", "label"))
            names, columns = texts(names), [texts(member(file, f"clip/{field}")[()]) for field in fields]
        except KeyError as why:
            raise Error(f"{path}: damaged: {why.args[0]}; ingest the raw data again") from None
        if any(len(column) != len(names) for column in [offsets, lengths, labels, *columns]):
            raise Error(f"{path}: the columns of 'clip' differ in length: damaged; ingest the raw data again")
        for row, name in enumerate(names):
            label, offset, length = int(labels[row]), int(offsets[row]), int(lengths[row])
            if label >= len(self.classes):
                raise Error(f"{path}: clip {name} has label {label} of {len(self.classes)} classes: damaged")
            if length == 0 or offset + length > frames:
                raise Error(f"{path}: clip {name} lies outside the motion: damaged; ingest the raw data again")
            own = {field: column[row] for field, column in zip(fields, columns)}
            index = len(self._clips) + row
            yield Clip(index, name, label, self.classes[label], length, own, shard, offset, row)


def _header(folder: Path) -> Dict[str, Any]:
    if not (folder / "dataset.json").is_file():
        inside = sorted(path.parent for path in folder.glob("*/dataset.json"))
        if inside:
            raise Error(f"{folder}: holds {len(inside)} datasets; open one at a time, as in {inside[0]}")
        if folder.is_file():
            raise Error(f"{folder}: a file; give a folder that actformer ingest made")
        raise Error(f"{folder}: no dataset (no dataset.json in it); make one with actformer ingest")
    path = folder / "dataset.json"
    header = read_json(path, "a folder that actformer ingest made")
    version = header.get("format") if isinstance(header, dict) else None
    if version not in FORMATS:
        raise Error(f"{path}: format {version}, but this package reads formats 1 to 3; take the package of the "
                    "program's version")
    return dict(header)


def _file_name(said: str) -> str:
    """A shard's, which lies beside dataset.json."""
    if said in ("", ".", "..") or "/" in said:
        raise Error(f"shard '{said}' is no file's name; ingest the raw data again")
    return said


def _condition(said: Dict[str, Any]) -> Condition:
    negated = "not_in" in said
    return Condition(said["field"], tuple(said["not_in" if negated else "in"]), negated)
