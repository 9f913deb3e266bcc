"""HDF5 and JSON files, opened with errors of one line."""

import contextlib
import errno
import json
import os
import secrets
import stat
from pathlib import Path
from typing import Any, Iterator, List, Sequence, Union

import h5py
import numpy as np

from .errors import Error

AnyPath = Union[str, "os.PathLike[str]"]

#: Soft links followed on the way to a member of an HDF5 file.
MOST_LINKS = 16


def open_hdf5(path: Path, what: str) -> h5py.File:
    """The file, open for reading. Raises Error where it is missing, no HDF5 file, or damaged; ``what`` says which file was
    expected."""
    if path.is_dir():
        raise Error(_is_a_folder(path, what))
    if not path.is_file():
        raise Error(f"{path}: no such file; give {what}")
    try:
        return h5py.File(path, "r")
    except OSError as why:
        raise Error(f"{path}: no HDF5 file, or damaged ({_first_line(why)}); make it anew") from None


def member(file: h5py.File, name: str) -> Any:
    """The array or group at ``name``, a path in the file. Raises KeyError where there is none, and Error where it lies in another
    file, which is not opened: an external link, external storage or a virtual array."""
    place, parts, links = file["/"], _parts(name), 0
    while parts:
        if not isinstance(place, h5py.Group):
            raise KeyError(f"holds no '{name}'")
        part, all_links = parts.pop(0).encode("utf-8", "surrogateescape"), place.id.links
        kind = all_links.get_info(part).type if all_links.exists(part) else None
        if kind == h5py.h5l.TYPE_SOFT and links < MOST_LINKS:
            to = all_links.get_val(part).decode("utf-8", "surrogateescape")
            place, parts, links = file["/"] if to.startswith("/") else place, _parts(to) + parts, links + 1
        elif kind == h5py.h5l.TYPE_EXTERNAL:
            raise Error(f"{file.filename}: '{name}' leads to another file; copy what it leads to into this one")
        elif kind == h5py.h5l.TYPE_HARD:
            place = place[part]
        else:
            raise KeyError(f"holds no '{name}'")
    _refuse_numbers_elsewhere(place, f"{file.filename}: '{name}'")
    return place


@contextlib.contextmanager
def new_file(target: Path) -> Iterator[Path]:
    """An empty file beside ``target``, which takes its place, on the disk, at the end of the block, and is gone where that raises. A
    symbolic link at ``target`` stays, and the file it leads to is replaced. Raises Error where something else than a file is there."""
    place = Path(os.path.realpath(target)) if target.is_symlink() else target
    if place.exists() and not place.is_file():
        kind = "a folder" if place.is_dir() else "a FIFO" if stat.S_ISFIFO(place.stat().st_mode) else "a device or socket"
        raise Error(f"{target}: {kind}, where a file is to be written; give another path")
    partial = place.with_name(f".{place.name[:40]}.{secrets.token_hex(8)}.partial")  # a name that nobody foresees
    handle = os.open(partial, os.O_RDWR | os.O_CREAT | os.O_EXCL | os.O_NOFOLLOW, 0o666)
    try:
        yield partial
        _sync(handle)
        os.replace(partial, place)
    finally:
        os.close(handle)
        partial.unlink(missing_ok=True)
    try:
        folder = os.open(place.parent, os.O_RDONLY)
    except PermissionError:  # a folder that may be written and not read
        return
    try:
        _sync(folder)
    finally:
        os.close(folder)


def read_json(path: Path, what: str) -> Any:
    """What the JSON file holds. Raises Error naming the line at fault; ``what`` says which file was expected."""
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise Error(f"{path}: no such file; give {what}") from None
    except IsADirectoryError:
        raise Error(_is_a_folder(path, what)) from None
    except UnicodeDecodeError:
        kind = "an HDF5 file" if h5py.is_hdf5(path) else "no text in UTF-8"
        raise Error(f"{path}: {kind}, and JSON is expected; give {what}") from None
    except OSError as why:
        raise Error(f"{path}: cannot be read: {_first_line(why)}") from None
    except json.JSONDecodeError as why:
        raise Error(f"{path}:{why.lineno}: no JSON ({why.msg}); give {what}") from None


def texts(values: Any) -> List[str]:
    """Texts of an HDF5 array or attribute, of fixed or variable length, one or many."""
    return [v.decode("utf-8", "replace") if isinstance(v, bytes) else str(v) for v in np.atleast_1d(values)]


def fixed_texts(words: Sequence[str]) -> Any:
    """Texts as the program reads them in attributes: UTF-8 of fixed length."""
    encoded = [word.encode("utf-8") for word in words]
    return np.array(encoded, h5py.string_dtype("utf-8", max([1, *map(len, encoded)])))


def _refuse_numbers_elsewhere(array: Any, where: str) -> None:
    if isinstance(array, h5py.Dataset) and array.is_virtual:
        raise Error(f"{where} is a virtual array, whose numbers lie elsewhere; copy them into an array of this file")
    if isinstance(array, h5py.Dataset) and array.external:
        raise Error(f"{where} keeps its numbers in another file; copy them into an array of this one")


def _parts(name: str) -> List[str]:
    return [part for part in name.split("/") if part not in ("", ".")]


def _sync(handle: int) -> None:
    """Brings a file or a folder's names to the disk, where its file system knows how."""
    try:
        os.fsync(handle)
    except OSError as why:
        if why.errno not in (errno.EINVAL, errno.ENOSYS, errno.ENOTSUP):
            raise


def _is_a_folder(path: Path, what: str) -> str:
    kind = f"a dataset, which Dataset('{path}') opens" if (path / "dataset.json").is_file() else "a folder"
    return f"{path}: {kind}; give {what}"


def _first_line(why: Exception) -> str:
    return str(why).splitlines()[0] if str(why) else type(why).__name__
