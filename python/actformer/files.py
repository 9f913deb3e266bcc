"""HDF5 and JSON files, opened with errors of one line."""

import json
import os
from pathlib import Path
from typing import Any, List, Sequence, Union

import h5py
import numpy as np

from .errors import Error

AnyPath = Union[str, "os.PathLike[str]"]


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


def _is_a_folder(path: Path, what: str) -> str:
    kind = f"a dataset, which Dataset('{path}') opens" if (path / "dataset.json").is_file() else "a folder"
    return f"{path}: {kind}; give {what}"


def _first_line(why: Exception) -> str:
    return str(why).splitlines()[0] if str(why) else type(why).__name__
