"""Reads what the program ``actformer`` writes, and writes motions that it reads.

>>> import actformer
>>> data = actformer.Dataset("ntu/ntu-1p")
>>> clip = data.clips("xsub/train")[0]
>>> motion = data.motion(clip)                      # (frames, persons, nodes, numbers)
>>> joints = data.joints(clip)                      # (frames, persons, joints, 3) metres
>>> motion.shape[:2] == joints.shape[:2] == (clip.frames, data.persons)
True

``Motions`` reads files of motions, ``write_motions`` writes them; ``read_features`` and ``read_scores`` read what
``actformer features`` and ``actformer score`` leave.
"""

from .body import Body, joint_positions
from .dataset import Clip, Condition, Dataset
from .errors import Error
from .features import Features, read_features
from .motions import Motion, Motions, write_motions
from .scores import Metric, Scores, read_scores

__version__ = "0.1.0"

__all__ = [
    "Body",
    "Clip",
    "Condition",
    "Dataset",
    "Error",
    "Features",
    "Metric",
    "Motion",
    "Motions",
    "Scores",
    "joint_positions",
    "read_features",
    "read_scores",
    "write_motions",
]
