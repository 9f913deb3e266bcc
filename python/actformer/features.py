"""Features files: what a recogniser sees in motions, as ``actformer features`` leaves them."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any, List, Optional

import numpy as np
from numpy.typing import NDArray

from .body import Floats
from .errors import Error
from .files import AnyPath, member, open_hdf5, texts


@dataclass(frozen=True)
class Features:
    """Of n sequences. What the file does not hold is None, or an empty text."""

    features: Floats  # (n, d)
    logits: Optional[Floats]  # (n, classes)
    labels: Optional[NDArray[np.int64]]  # (n), from 0
    names: Optional[List[str]]  # (n), of the clips
    recogniser: str  # checksum of its weights
    input: str  # fingerprint of the motions
    view: str  # what of the motions was seen, as in windows

    def accuracy(self) -> float:
        """The mean over classes of the share recognised as labelled (the ActFormer paper's accuracy).

        >>> 0 <= read_features("features.h5").accuracy() <= 1
        True
        """
        if self.logits is None or self.labels is None:
            raise Error("accuracy needs both logits and labels")
        right = np.argmax(self.logits, axis=1) == self.labels
        return float(np.mean([right[self.labels == label].mean() for label in np.unique(self.labels)]))


def read_features(path: AnyPath) -> Features:
    """
    >>> seen = read_features("features.h5")
    >>> len(seen.features) == len(seen.logits) == len(seen.names)
    True
    """
    where = Path(path)
    with open_hdf5(where, "the features that actformer features made") as file:

        def array(name: str) -> Any:
            try:
                return member(file, name)[()]
            except KeyError:
                return None

        def note(name: str) -> str:
            return texts(file.attrs[name])[0] if name in file.attrs else ""

        features, logits, labels, names = (array(n) for n in ("features", "logits", "labels", "names"))
        if features is None or features.ndim != 2:
            raise Error(f"{where}: holds no 'features' (n, d); make it with actformer features")
        for what, rows in (("logits", logits), ("labels", labels), ("names", names)):
            if rows is not None and len(rows) != len(features):
                raise Error(f"{where}: {len(rows)} {what} do not go with {len(features)} rows of features: damaged")
        return Features(
            features.astype(np.float32),
            None if logits is None else logits.astype(np.float32),
            None if labels is None else labels.astype(np.int64),
            None if names is None else texts(names),
            note("recogniser"),
            note("input"),
            note("view"),
        )
