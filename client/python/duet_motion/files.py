"""Motion files, read and written without a server.

The program `duet` reads and writes them, and detects their unit, up axis and joints
(docs/formats.md). ``DUET_PROGRAM`` names it if it is not on the PATH. It exchanges motions with this
module as JSON.
"""

from __future__ import annotations

import json
import os
import pathlib
import re
import shutil
import subprocess
import tempfile
from typing import Any, Dict, List, Mapping, Optional, Tuple, Union

from duet_motion.motion import Motion
from duet_motion.result import SynthesisResult

Path = Union[str, "os.PathLike[str]"]
Shown = Union[Motion, Tuple[Motion, Motion], SynthesisResult]

# The arguments of reading, and the flags of `duet convert`.
_FLAGS = {"side": "--side", "frame_rate_hz": "--frame-rate", "unit": "--unit", "up_axis": "--up-axis",
          "metres_per_unit": "--metres-per-unit", "joint_map": "--joint-map",
          "resample_hz": "--resample"}
# A message, its status code, and the advice that follows.
_FAILURE = re.compile(r"(?P<message>.*?)(?: \([A-Z_]+\))?"
                      r"(?:\n(?:Specify it with (?P<flag>--[\w-]+)|Run with --help|Trying again).*)?",
                      re.DOTALL)


class MotionFileError(ValueError):
    """A motion file cannot be read or written. The message names the file, the place in it, what was
    expected and what was found."""


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
        MotionFileError: the file cannot be read, or an argument is invalid.
        FileNotFoundError: the program `duet` is missing; the message explains how to install it.
    """
    return _read(path, joint_map, side=side, frame_rate_hz=frame_rate_hz, unit=unit, up_axis=up_axis,
                 metres_per_unit=metres_per_unit, resample_hz=resample_hz)[0]


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
        MotionFileError: the file cannot be read or has one person, or an argument is invalid.
        FileNotFoundError: see :func:`read_motion`.
    """
    motions = _read(path, joint_map, frame_rate_hz=frame_rate_hz, unit=unit, up_axis=up_axis,
                    metres_per_unit=metres_per_unit, resample_hz=resample_hz)
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
    shown: Shown = leader if follower is None else (leader, follower)
    with tempfile.TemporaryDirectory() as folder:
        source = _documents(folder, [shown])[0]
        try:
            run("convert", source, "--out", _word(path), "--quiet")
        except MotionFileError as error:
            raise MotionFileError(str(error).replace(source, "motion")) from None


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
        sources = _documents(folder, list(motions.values()))
        shown = [f"{name}={source}" for name, source in zip(motions, sources)]
        run("view", *shown, *(["--title", title] if title else []), "--out", _word(path), "--quiet")


def run(*arguments: str) -> str:
    """Runs a command of the program and returns its output. Raises MotionFileError if it fails, and
    FileNotFoundError without the program."""
    done = _run(*arguments)
    if done.returncode != 0:
        raise MotionFileError(_failure(done))
    return done.stdout.decode()


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


def _documents(folder: str, motions: List[Shown]) -> List[str]:
    """Writes motions as documents into a folder and returns their paths."""
    sources = []
    for index, shown in enumerate(motions):
        source = pathlib.Path(folder) / f"{index}.json"
        source.write_text(to_document(shown), encoding="utf-8")
        sources.append(str(source))
    return sources


def _read(path: Path, joint_map: Optional[Mapping[str, str]], **options: Any) -> List[Motion]:
    """The people of a file. Options that are None or empty are left to the file."""
    arguments: List[str] = []
    for option, value in options.items():
        if value not in (None, ""):
            arguments += [_FLAGS[option], str(value)]
    for joint, name in (joint_map or {}).items():
        arguments += ["--joint-map", f"{joint}={name}"]
    with tempfile.TemporaryDirectory() as folder:
        document = pathlib.Path(folder) / "motion.json"
        run("convert", _word(path), *arguments, "--out", str(document), "--quiet")
        answer = json.loads(document.read_text(encoding="utf-8"))
    return [Motion(answer[role], answer["joint_names"], answer["frame_rate_hz"], answer["unit"],
                   answer["up_axis"]) for role in ("leader", "follower") if role in answer]


def _word(path: Path) -> str:
    """The file as a word of a command line, where it cannot be mistaken for a flag."""
    word = os.fspath(path)
    return os.path.join(".", word) if word.startswith("-") else word


def _run(*arguments: str) -> subprocess.CompletedProcess[bytes]:
    name = os.environ.get("DUET_PROGRAM", "duet")
    program = shutil.which(name)
    if program is None:
        raise FileNotFoundError(
            f"program {name!r}: expected Duet's command-line client, which reads and writes motion "
            "files, got no such program; pip does not install it: install the Debian package "
            "duet (deploy/README.md) or build the program, and put it on the PATH or set "
            "DUET_PROGRAM")
    return subprocess.run([program, *arguments], capture_output=True, check=False,
                          env={**os.environ, "NO_COLOR": "1"})


def _failure(done: subprocess.CompletedProcess[bytes]) -> str:
    """The error of a command, with the names of arguments instead of flags, and without the rest
    that is meant for a terminal."""
    if done.returncode < 0:
        return f"the program was ended by signal {-done.returncode}"
    match = _FAILURE.fullmatch(done.stderr.decode(errors="replace").strip().removeprefix("duet: "))
    assert match is not None  # it matches any text
    message = re.sub(r"\A(--out: |cannot write the result: )", "", match["message"])
    for argument, flag in _FLAGS.items():
        message = re.sub(rf"\A{flag}\b", argument, message)
        if flag == match["flag"]:
            message += f"\nSpecify it with {argument}."
    return message
