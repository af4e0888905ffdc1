"""Motion files, read and written without a server.

The program `duet` reads and writes them, and detects their unit, up axis and joints
(docs/formats.md). ``DUET_PROGRAM`` names it if it is not on the PATH.
"""

from __future__ import annotations

import json
import os
import pathlib
import tempfile
from typing import Any, Dict, Mapping, Optional, Tuple, Union

from duet_motion import _file_program
from duet_motion._file_options import MotionFileError, Path, checked_options
from duet_motion.motion import Motion
from duet_motion.result import SynthesisResult

__all__ = ["MotionFileError", "read_motion", "read_pair", "write_motion", "write_page"]

Shown = Union[Motion, Tuple[Motion, Motion], SynthesisResult]


def read_motion(path: Path, *, side: str = "left", frame_rate_hz: Optional[float] = None,
                unit: str = "", up_axis: str = "", metres_per_unit: Optional[float] = None,
                joint_map: Optional[Mapping[str, str]] = None,
                resample_hz: Optional[float] = None) -> Motion:
    """Reads the motion of one person from a file, in metres, y up, in the joints of Duet's
    skeleton.

    Args:
        path: a file in any format that Duet reads (docs/formats.md).
        side: ``"left"`` or ``"right"``: the person in a file with two.
        frame_rate_hz: frames per second; overrides the file's.
        unit: ``"metres"``, ``"millimetres"`` or ``"sbu-normalised"``; overrides the file's.
        up_axis: ``"y-up"``, ``"z-up"`` or ``"y-down"``; overrides the file's.
        metres_per_unit: metres in one unit of the file; overrides `unit`.
        joint_map: from joints of Duet to joints of the file, for names that are not recognised.
        resample_hz: frames per second of the result; the motion keeps its speed.

    Raises:
        MotionFileError: the file cannot be read.
        ValueError: an argument is invalid.
        FileNotFoundError: the program `duet` is missing; the message explains how to install it.
    """
    return _file_program.read(path, checked_options(
        side, frame_rate_hz, unit, up_axis, metres_per_unit, joint_map, resample_hz))[0]


def read_pair(path: Path, *, frame_rate_hz: Optional[float] = None, unit: str = "",
              up_axis: str = "", metres_per_unit: Optional[float] = None,
              joint_map: Optional[Mapping[str, str]] = None,
              resample_hz: Optional[float] = None) -> Tuple[Motion, Motion]:
    """Reads both people from a file, leader first, like :func:`read_motion`.

    Args:
        path: a .bvh, .gltf, .glb, .csv, .npy, .json or SBU .txt file with two people.
        frame_rate_hz: frames per second; overrides the file's.
        unit: of length; overrides the file's.
        up_axis: overrides the file's.
        metres_per_unit: metres in one unit of the file; overrides `unit`.
        joint_map: from joints of Duet to joints of the file.
        resample_hz: frames per second of the result; the motion keeps its speed.

    Raises:
        MotionFileError: the file cannot be read, or has one person.
        ValueError: an argument is invalid.
        FileNotFoundError: see :func:`read_motion`.
    """
    motions = _file_program.read(path, checked_options(
        None, frame_rate_hz, unit, up_axis, metres_per_unit, joint_map, resample_hz))
    if len(motions) != 2:
        raise MotionFileError(f"{os.fspath(path)}: expected two people, got one")
    return motions[0], motions[1]


def write_motion(path: Path, leader: Motion, follower: Optional[Motion] = None) -> None:
    """Writes one person or two. Two people as .bvh are written to ``NAME.leader.bvh`` and
    ``NAME.follower.bvh``.

    Args:
        path: its extension selects one of the formats that `duet convert` writes.
        leader: the first person, or the only one.
        follower: the second person, with the leader's joints, rate, number of frames, unit and
            axis.

    Raises:
        ValueError: the two differ in joints, rate or number of frames, unit or axis.
        MotionFileError: the file cannot be written.
        FileNotFoundError: see :func:`read_motion`.
    """
    _file_program.write(to_document(leader if follower is None else (leader, follower)), path)


def write_page(path: Path, motions: Mapping[str, Shown], title: str = "") -> None:
    """Writes a self-contained HTML page that plays named motions side by side.

    Args:
        path: ``.html``.
        motions: up to twelve: a motion, a pair of leader and follower, or a synthesis result.
        title: the page's title; empty: the names.

    Raises:
        MotionFileError: the page cannot be written.
        FileNotFoundError: the program `duet` is missing.
    """
    with tempfile.TemporaryDirectory() as folder:
        arguments = []
        for index, (name, shown) in enumerate(motions.items()):
            source = pathlib.Path(folder) / f"{index}.json"
            source.write_text(to_document(shown), encoding="utf-8")
            arguments.append(f"{name}={source}")
        if title:
            arguments += ["--title", title]
        _file_program.run("view", *arguments, "--out", os.fspath(path), "--quiet")


def to_document(shown: Shown) -> str:
    """One person or two as a "duet-motion" document (docs/formats.md)."""
    if isinstance(shown, SynthesisResult):
        shown = (shown.leader, shown.follower)
    people = (shown,) if isinstance(shown, Motion) else shown
    first = people[0]
    for other in people[1:]:
        for field in ("joint_names", "frame_rate_hz", "unit", "up_axis", "frame_count"):
            if getattr(other, field) != getattr(first, field):
                raise ValueError(f"follower.{field}: expected the leader's {getattr(first, field)}, "
                                 f"got {getattr(other, field)}")
    document: Dict[str, Any] = {
        "format": "duet-motion", "version": 1, "frame_rate_hz": first.frame_rate_hz,
        "unit": first.unit, "up_axis": first.up_axis, "joint_names": first.joint_names}
    for role, person in zip(("leader", "follower"), people):
        document[role] = person.positions.tolist()
    return json.dumps(document, allow_nan=False)
