"""Scores: the JSON that ``actformer score -o`` writes."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any, Dict, List, Optional

from .errors import Error, suggestion
from .files import AnyPath, read_json


HEADINGS = {  # as tables print them: names in files
    "FIDm": "fid_mean",
    "FIDw": "fid_whole",
    "FIDa_m": "fida_mean",
    "FIDa_w": "fida_whole",
    "FIDm at infinity": "fid_mean_infinity",
    "FIDw at infinity": "fid_whole_infinity",
    "KIDm": "kid_mean",
    "KIDw": "kid_whole",
    "limb acceleration": "limb_acceleration",
    "root acceleration": "root_acceleration",
    "root speed": "root_speed",
    "foot sliding": "foot_sliding",
    "root distance": "root_distance",
}


@dataclass(frozen=True)
class Metric:
    """A metric over the repeats. ``ci95`` is the half-width of the mean's 95 % interval, None of one repeat."""

    mean: float
    ci95: Optional[float]
    repeats: List[Optional[float]]
    floor: Optional[float]  # of real motions against real ones


@dataclass(frozen=True)
class Scores:
    """Metrics by name, and all else that the file tells.

    >>> scores = read_scores("scores.json")
    >>> metric = scores["fid_mean"]                     # or scores["FIDm"]
    >>> metric.mean >= 0
    True
    """

    metrics: Dict[str, Metric]
    classes: List[Dict[str, Any]]  # a class each: label from 0, real, generated, accuracy, fid ...
    confusion: Optional[List[List[int]]]  # row: true class; column: recognised as
    left_out: List[Dict[str, Any]]  # classes with under two samples on a side
    warnings: List[str]
    real: Dict[str, Any]
    provenance: Dict[str, Any]

    def __getitem__(self, name: str) -> Metric:
        """By its name, or by its heading in tables."""
        name = HEADINGS.get(name, name)
        if name not in self.metrics:
            hint = suggestion(name, self.metrics) or f"; there are {', '.join(self.metrics)}"
            raise Error(f"no metric is called '{name}'{hint}")
        return self.metrics[name]


def read_scores(path: AnyPath) -> Scores:
    """Raises Error where the file is no scores of ``actformer score``."""
    where = Path(path)
    told = read_json(where, "the scores that actformer score -o wrote")
    if not isinstance(told, dict) or "per_class" not in told:
        raise Error(f"{where}: no scores; give the file that actformer score -o wrote")
    floor = told.get("floor", {})
    metrics = {
        name: Metric(value["mean"], value.get("ci95"), list(value["repeats"]), floor.get(name))
        for name, value in told.items()
        if isinstance(value, dict) and {"mean", "repeats"} <= value.keys()
    }
    return Scores(
        metrics,
        told["per_class"],
        told.get("confusion"),
        told.get("left_out", []),
        told.get("warnings", []),
        told.get("real", {}),
        told.get("provenance", {}),
    )
