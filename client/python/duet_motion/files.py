"""Motion files, read and written by the program `duet`.

`duet convert` detects a file's unit, up axis and joints (docs/formats.md), and exchanges motions
with this module as JSON. No server is involved. The program is not part of the wheel;
``DUET_PROGRAM`` names it if it is not on the PATH.
"""

from __future__ import annotations

import json
import os
import pathlib
import tempfile
from typing import Any, Dict, List, Mapping, Optional, Tuple, Union

from duet_motion import _program
from duet_motion.motion import Motion
from duet_motion.result import SynthesisResult

Path = Union[str, "os.PathLike[str]"]
Shown = Union[Motion, Tuple[Motion, Motion], SynthesisResult]


class MotionFileError(ValueError):
    """A motion file cannot be read or written. The message is from the program and names the file,
    the line, what was expected and what was found."""


def read_motion(path: Path, *, side: str = "left", frame_rate_hz: Optional[float] = None,
                unit: str = "", up_axis: str = "", metres_per_unit: Optional[float] = None,
                joint_map: Optional[Mapping[str, str]] = None,
                resample_hz: Optional[float] = None, layout: str = "",
                body_model: Optional[Path] = None) -> Motion:
    """Reads the motion of one person from a file, in metres, y up, in the joints of Duet's
    skeleton.

    Args:
        path: .bvh, .gltf, .glb, .amc, .csv, .npy, .npz, .json or SBU .txt.
        side: ``"left"`` or ``"right"``: the person in a file with two.
        frame_rate_hz: frames per second; overrides the file's.
        unit: ``"metres"``, ``"millimetres"`` or ``"sbu-normalised"``; overrides the file's.
        up_axis: ``"y-up"``, ``"z-up"`` or ``"y-down"``; overrides the file's.
        metres_per_unit: metres in one unit of the file, for BVH, glTF and ASF.
        joint_map: from joints of Duet to joints of the file, for names that are not recognised.
        resample_hz: frames per second of the result; the motion keeps its speed.
        layout: the meaning of a .npy array of research: ``"humanml3d"``, ``"humanml3d-263"``,
            ``"intergen"``, ``"intergen-262"`` or ``"inter-x"`` (docs/guides/research_layouts.md).
        body_model: the .npz of the body model of a .npz motion (AMASS, SMPL).

    Raises:
        MotionFileError: the file cannot be read.
        FileNotFoundError: the program `duet` is missing; the message explains how to install it.
    """
    motions = _read(path, ["--side", side], frame_rate_hz, unit, up_axis, metres_per_unit,
                    joint_map, resample_hz, layout, body_model)
    return motions[0]


def read_pair(path: Path, *, frame_rate_hz: Optional[float] = None, unit: str = "",
              up_axis: str = "", metres_per_unit: Optional[float] = None,
              joint_map: Optional[Mapping[str, str]] = None,
              resample_hz: Optional[float] = None, layout: str = "") -> Tuple[Motion, Motion]:
    """Reads both people from a file, leader first, like :func:`read_motion`.

    Args:
        path: a .bvh, .gltf, .glb, .csv, .npy, .json or SBU .txt file with two people.
        frame_rate_hz: frames per second; overrides the file's.
        unit: of length; overrides the file's.
        up_axis: overrides the file's.
        metres_per_unit: metres in one unit of the file, for BVH, glTF and ASF.
        joint_map: from joints of Duet to joints of the file.
        resample_hz: frames per second of the result; the motion keeps its speed.
        layout: the meaning of a .npy array of research, as for :func:`read_motion`.

    Raises:
        MotionFileError: the file cannot be read, or has one person.
        FileNotFoundError: the program `duet` is missing.
    """
    motions = _read(path, [], frame_rate_hz, unit, up_axis, metres_per_unit, joint_map, resample_hz,
                    layout, None)
    if len(motions) != 2:
        raise MotionFileError(f"{os.fspath(path)}: expected two people, got one")
    return motions[0], motions[1]


def write_motion(path: Path, leader: Motion, follower: Optional[Motion] = None, *,
                 layout: str = "") -> None:
    """Writes one person or two. Two people as .bvh are written to ``NAME.leader.bvh`` and
    ``NAME.follower.bvh``.

    Args:
        path: its extension selects one of the formats that `duet convert` writes.
        leader: the first person, or the only one.
        follower: the second person, with the leader's joints, rate, number of frames, unit and
            axis.
        layout: of a .npy array of research: 22 joints at the rate of the data set, or its features
            (docs/guides/research_layouts.md).

    Raises:
        ValueError: the two differ in joints, rate or number of frames, unit or axis.
        MotionFileError: the file cannot be written.
    """
    shown: Shown = leader if follower is None else (leader, follower)
    with tempfile.TemporaryDirectory() as folder:
        source = _write_json(pathlib.Path(folder) / "motion.json", shown)
        arguments = ["--output-layout", layout] if layout else []
        _run("convert", str(source), "--out", os.fspath(path), "--quiet", *arguments)


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
        arguments = [f"{name}={_write_json(pathlib.Path(folder) / f'{index}.json', shown)}"
                     for index, (name, shown) in enumerate(motions.items())]
        if title:
            arguments += ["--title", title]
        _run("view", *arguments, "--out", os.fspath(path), "--quiet")


def _read(path: Path, arguments: List[str], frame_rate_hz: Optional[float], unit: str, up_axis: str,
          metres_per_unit: Optional[float], joint_map: Optional[Mapping[str, str]],
          resample_hz: Optional[float], layout: str, body_model: Optional[Path]) -> List[Motion]:
    flags = {"--frame-rate": frame_rate_hz, "--unit": unit, "--up-axis": up_axis,
             "--metres-per-unit": metres_per_unit, "--resample": resample_hz, "--layout": layout,
             "--body-model": None if body_model is None else os.fspath(body_model)}
    for flag, value in flags.items():
        if value not in (None, ""):
            arguments += [flag, str(value)]
    for joint, name in (joint_map or {}).items():
        arguments += ["--joint-map", f"{joint}={name}"]
    answer = json.loads(_run("convert", os.fspath(path), *arguments, "--out", "-",
                             "--output-format", "json", "--quiet"))
    return [_from_json(answer, role) for role in ("leader", "follower") if role in answer]


def _from_json(answer: Dict[str, Any], role: str) -> Motion:
    return Motion(answer[role], answer["joint_names"], answer["frame_rate_hz"], answer["unit"],
                  answer["up_axis"])


def _write_json(path: pathlib.Path, shown: Shown) -> pathlib.Path:
    """Writes one person or two as a "duet-motion" file (docs/formats.md)."""
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
    path.write_text(json.dumps(document, allow_nan=False), encoding="utf-8")
    return path


def _run(*arguments: str) -> str:
    try:
        return _program.run(*arguments)
    except _program.CommandFailed as error:
        raise MotionFileError(str(error)) from None
