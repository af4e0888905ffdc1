"""Motion files, read and written by the program `duet`.

What a file's unit is, which way is up in it and which of its joints is the left knee: `duet convert`
finds out (docs/formats.md), and this module speaks with it in JSON. It is the program beside the
server; ``$DUET_PROGRAM`` says where, where it is not on the PATH. No server is asked.
"""

from __future__ import annotations

import json
import os
import pathlib
import shutil
import subprocess
import tempfile
from typing import Any, Dict, List, Mapping, Optional, Tuple, Union

from duet.motion import Motion
from duet.result import SynthesisResult

Path = Union[str, "os.PathLike[str]"]
Shown = Union[Motion, Tuple[Motion, Motion], SynthesisResult]


class MotionFileError(ValueError):
    """A motion file that cannot be read or written: the program's own words, which name the file,
    the line, what came and what was wanted."""


def read_motion(path: Path, *, side: str = "left", frame_rate_hz: Optional[float] = None,
                unit: str = "", up_axis: str = "", metres_per_unit: Optional[float] = None,
                joint_map: Optional[Mapping[str, str]] = None,
                resample_hz: Optional[float] = None) -> Motion:
    """The motion of one person of a file, in metres, y up, in the joints of Duet's skeleton.

    Args:
        path: .bvh, .gltf, .glb, .amc, .csv, .npy, .json or SBU .txt.
        side: ``"left"`` or ``"right"``, who is read of a file with two people.
        frame_rate_hz: replaces what the file says.
        unit, up_axis: replace what the file says.
        metres_per_unit: for BVH, glTF and ASF.
        joint_map: joints of the file by joints of Duet, where names alone do not tell.
        resample_hz: frames a second of what is returned; the motion keeps its pace.

    Raises:
        MotionFileError: the file cannot be read.
        FileNotFoundError: there is no program `duet`.
    """
    motions = _read(path, ["--side", side], frame_rate_hz, unit, up_axis, metres_per_unit,
                    joint_map, resample_hz)
    return motions[0]


def read_pair(path: Path, *, frame_rate_hz: Optional[float] = None, unit: str = "",
              up_axis: str = "", metres_per_unit: Optional[float] = None,
              joint_map: Optional[Mapping[str, str]] = None,
              resample_hz: Optional[float] = None) -> Tuple[Motion, Motion]:
    """The motions of both people of a file, as :func:`read_motion` reads one.

    Raises:
        MotionFileError: the file cannot be read, or has one person.
    """
    motions = _read(path, [], frame_rate_hz, unit, up_axis, metres_per_unit, joint_map, resample_hz)
    if len(motions) != 2:
        raise MotionFileError(f"{os.fspath(path)}: one person, wanted two")
    return motions[0], motions[1]


def write_motion(path: Path, leader: Motion, follower: Optional[Motion] = None) -> None:
    """Writes one person or two; the extension says how: whatever `duet convert` writes.

    Two people as .bvh are two files, ``NAME.leader.bvh`` and ``NAME.follower.bvh``.

    Raises:
        ValueError: the two differ in joints, rate or number of frames, unit or axis.
        MotionFileError: the file cannot be written.
    """
    shown: Shown = leader if follower is None else (leader, follower)
    with tempfile.TemporaryDirectory() as folder:
        source = _write_json(pathlib.Path(folder) / "motion.json", shown)
        _run("convert", str(source), "--out", os.fspath(path), "--quiet")


def write_page(path: Path, motions: Mapping[str, Shown], title: str = "") -> None:
    """One self-contained HTML page that plays motions side by side, by their names.

    Args:
        path: ``.html``.
        motions: up to twelve: a motion, a pair of leader and follower, or a synthesis result.
        title: of the page.

    Raises:
        MotionFileError: the page cannot be written.
    """
    with tempfile.TemporaryDirectory() as folder:
        arguments = [f"{name}={_write_json(pathlib.Path(folder) / f'{index}.json', shown)}"
                     for index, (name, shown) in enumerate(motions.items())]
        if title:
            arguments += ["--title", title]
        _run("view", *arguments, "--out", os.fspath(path), "--quiet")


def _read(path: Path, arguments: List[str], frame_rate_hz: Optional[float], unit: str, up_axis: str,
          metres_per_unit: Optional[float], joint_map: Optional[Mapping[str, str]],
          resample_hz: Optional[float]) -> List[Motion]:
    flags = {"--frame-rate": frame_rate_hz, "--unit": unit, "--up-axis": up_axis,
             "--metres-per-unit": metres_per_unit, "--resample": resample_hz}
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
    """The "duet-motion" file of one person or two (docs/formats.md)."""
    if isinstance(shown, SynthesisResult):
        shown = (shown.leader, shown.follower)
    people = (shown,) if isinstance(shown, Motion) else shown
    first = people[0]
    for other in people[1:]:
        for field in ("joint_names", "frame_rate_hz", "unit", "up_axis", "frame_count"):
            if getattr(other, field) != getattr(first, field):
                raise ValueError(f"follower.{field}: {getattr(other, field)}, wanted the leader's "
                                 f"{getattr(first, field)}")
    document: Dict[str, Any] = {
        "format": "duet-motion", "version": 1, "frame_rate_hz": first.frame_rate_hz,
        "unit": first.unit, "up_axis": first.up_axis, "joint_names": first.joint_names}
    for role, person in zip(("leader", "follower"), people):
        document[role] = person.positions.tolist()
    path.write_text(json.dumps(document, allow_nan=False), encoding="utf-8")
    return path


def _program() -> str:
    name = os.environ.get("DUET_PROGRAM", "duet")
    found = shutil.which(name)
    if found is None:
        raise FileNotFoundError(f"no program {name!r}, which reads and writes motion files; put "
                                "Duet's duet on the PATH, or say where it is in DUET_PROGRAM")
    return found


def _run(*arguments: str) -> str:
    """What the program prints; the settings of its user's configuration do not count."""
    done = subprocess.run([_program(), *arguments], capture_output=True, check=False,
                          env={**os.environ, "DUET_CONFIG": "", "NO_COLOR": "1"})
    if done.returncode != 0:
        raise MotionFileError(done.stderr.decode(errors="replace").strip().removeprefix("duet: "))
    return done.stdout.decode()
