"""The arguments of `read_motion`, checked, and the error of motion files."""

from __future__ import annotations

import dataclasses
import os
import reprlib
from typing import Dict, Iterable, Mapping, Optional, Union

from duet_motion._wire import UNITS, UP_AXES
from duet_motion.motion import checked_choice, checked_number

Path = Union[str, "os.PathLike[str]"]
SIDES = ("left", "right")


class MotionFileError(ValueError):
    """A motion file cannot be read or written. The message names the file, the place in it, what was
    expected and what was found."""


@dataclasses.dataclass(frozen=True)
class ReadOptions:
    """See :func:`duet_motion.read_motion`. ``side``: empty: all people."""

    side: str = ""
    frame_rate_hz: Optional[float] = None
    unit: str = ""
    up_axis: str = ""
    metres_per_unit: Optional[float] = None
    joint_map: Mapping[str, str] = dataclasses.field(default_factory=dict)
    resample_hz: Optional[float] = None


def checked_options(side: Optional[str], frame_rate_hz: Optional[float], unit: str, up_axis: str,
                    metres_per_unit: Optional[float], joint_map: Optional[Mapping[str, str]],
                    resample_hz: Optional[float]) -> ReadOptions:
    """Raises ValueError for an invalid argument. ``side``: None: all people."""
    return ReadOptions(
        side="" if side is None else checked_choice("side", side, SIDES),
        frame_rate_hz=_number("frame_rate_hz", frame_rate_hz),
        unit=_choice("unit", unit, UNITS), up_axis=_choice("up_axis", up_axis, UP_AXES),
        metres_per_unit=_number("metres_per_unit", metres_per_unit),
        joint_map=_joint_map(joint_map), resample_hz=_number("resample_hz", resample_hz))


def _number(field: str, value: Optional[float]) -> Optional[float]:
    return None if value is None else checked_number(field, value, above=0)


def _choice(field: str, value: Optional[str], choices: Iterable[str]) -> str:
    return checked_choice(field, value, choices) if value else ""


def _joint_map(joint_map: Optional[Mapping[str, str]]) -> Dict[str, str]:
    kept = dict(joint_map or {})
    for joint, name in kept.items():
        # The program takes both as one word, joint=name.
        if not (isinstance(joint, str) and isinstance(name, str) and joint and name) or "=" in joint:
            raise ValueError("joint_map: expected names of joints of the file by joints of Duet, got "
                             f"{reprlib.repr({joint: name})}")
    return kept
