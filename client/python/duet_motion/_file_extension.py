"""Motion files by the extension module, which is part of wheels that were built for one platform."""

from __future__ import annotations

from typing import Any, Dict, List

import numpy as np

from duet_motion._file_options import MotionFileError, Path, ReadOptions
from duet_motion.motion import Motion, adopt

try:
    from duet_motion import _motion_files
    missing = ""  # why there is no module; empty: there is one
except ImportError as import_error:  # another platform or Python, or installed from the sources
    missing = str(import_error)


def read(path: Path, options: ReadOptions) -> List[Motion]:
    """The people of a file. Their arrays share the memory that the extension filled."""
    try:
        people = _motion_files.read(
            path, side=options.side, frame_rate_hz=options.frame_rate_hz, unit=options.unit,
            up_axis=options.up_axis, metres_per_unit=options.metres_per_unit,
            joint_map=options.joint_map, resample_hz=options.resample_hz, layout=options.layout,
            body_model=options.body_model)
    except _motion_files.Error as error:
        raise MotionFileError(str(error)) from None
    return [adopt(np.asarray(person.positions), person.joint_names, person.frame_rate_hz)
            for person in people]


def write(document: str, path: Path) -> None:
    """Writes the people of a "duet-motion" document (docs/formats.md)."""
    try:
        _motion_files.write(document, path)
    except _motion_files.Error as error:
        raise MotionFileError(str(error)) from None


def estimate_vertical(documents: List[str]) -> Dict[str, Any]:
    """The vertical of the people in "duet-motion" documents, as in ``duet inspect --json``."""
    try:
        return dict(_motion_files.estimate_vertical(documents))
    except _motion_files.Error as error:
        raise MotionFileError(str(error)) from None
