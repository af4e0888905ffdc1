"""Data sets of `duet batch`: reading them for training, and what follows a run.

``python3 -m duet_motion.sets`` has the functions as commands.
"""

from duet_motion.sets.packing import pack
from duet_motion.sets.reading import MotionSet, PaddedBatch, SetItem, pad, read_set
from duet_motion.sets.shards import DataSetError
from duet_motion.sets.splits import Splits, split
from duet_motion.sets.verifying import VerifyReport, verify

__all__ = ["DataSetError", "MotionSet", "PaddedBatch", "SetItem", "Splits", "VerifyReport", "pack", "pad",
           "read_set", "split", "verify"]
