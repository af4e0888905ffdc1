"""Motion files by the program `duet`: `duet convert` exchanges motions with this module as JSON."""

from __future__ import annotations

import json
import os
import pathlib
import re
import tempfile
from typing import Any, Dict, List

from duet_motion import _program
from duet_motion._file_options import MotionFileError, Path, ReadOptions
from duet_motion.motion import Motion

# The flags of options with one value, and all flags.
_VALUES = {"side": "--side", "frame_rate_hz": "--frame-rate", "unit": "--unit",
           "up_axis": "--up-axis", "metres_per_unit": "--metres-per-unit",
           "resample_hz": "--resample"}
_FLAGS = {**_VALUES, "joint_map": "--joint-map"}
# A message, its status code, and the advice that follows.
_FAILURE = re.compile(r"(?P<message>.*?)(?: \([A-Z_]+\))?"
                      r"(?:\n(?:Specify it with (?P<flag>--[\w-]+)|Run with --help|Trying again).*)?",
                      re.DOTALL)


def read(path: Path, options: ReadOptions) -> List[Motion]:
    """The people of a file."""
    arguments: List[str] = []
    for argument, flag in _VALUES.items():
        value = getattr(options, argument)
        if value not in (None, ""):
            arguments += [flag, str(value)]
    for joint, name in options.joint_map.items():
        arguments += [_FLAGS["joint_map"], f"{joint}={name}"]
    answer = json.loads(run("convert", _word(path), *arguments, "--out", "-",
                            "--output-format", "json", "--quiet"))
    return [_from_json(answer, role) for role in ("leader", "follower") if role in answer]


def write(document: str, path: Path) -> None:
    """Writes the people of a "duet-motion" document (docs/formats.md)."""
    with tempfile.TemporaryDirectory() as folder:
        source = pathlib.Path(folder) / "motion.json"
        source.write_text(document, encoding="utf-8")
        try:
            run("convert", str(source), "--out", _word(path), "--quiet")
        except MotionFileError as error:
            raise MotionFileError(str(error).replace(str(source), "motion")) from None


def estimate_vertical(documents: List[str]) -> Dict[str, Any]:
    """The vertical of the people in "duet-motion" documents, as in ``duet inspect --json``."""
    with tempfile.TemporaryDirectory() as folder:
        sources = []
        for index, document in enumerate(documents):
            source = pathlib.Path(folder) / f"{index}.json"
            source.write_text(document, encoding="utf-8")
            sources.append(str(source))
        try:
            answer = json.loads(_program.run("inspect", *sources, "--json"))
        except _program.CommandFailed as error:
            raise MotionFileError(_why_unreadable(error)) from None
    vertical: Dict[str, Any] = answer["tilt"]
    return vertical


def _why_unreadable(failed: _program.CommandFailed) -> str:
    """The error of the first file that ``duet inspect --json`` could not read."""
    try:
        files = json.loads(failed.output)["files"]
    except (ValueError, KeyError):
        return str(failed)
    for file in files:
        if not file["readable"]:
            return str(file["error"]).replace(file["file"], "motion")
    return str(failed)


def run(*arguments: str) -> str:
    """Runs a command of the program and returns its output."""
    try:
        return _program.run(*arguments)
    except _program.CommandFailed as error:
        raise MotionFileError(in_arguments(str(error))) from None


def in_arguments(failure: str) -> str:
    """An error of the program with the names of arguments instead of flags, and without the rest
    that is meant for a terminal."""
    match = _FAILURE.fullmatch(failure)
    assert match is not None  # it matches any text
    message = re.sub(r"\A(--out: |cannot write the result: )", "", match["message"])
    message = re.sub(r"\A--resample\b", "resample_hz", message)
    for argument, flag in _FLAGS.items():
        if flag == match["flag"]:
            return f"{message}\nSpecify it with {argument}."
    return message


def _word(path: Path) -> str:
    """The file as a word of a command line, where it cannot be mistaken for a flag."""
    word = os.fspath(path)
    return os.path.join(".", word) if word.startswith("-") else word


def _from_json(answer: Dict[str, Any], role: str) -> Motion:
    return Motion(answer[role], answer["joint_names"], answer["frame_rate_hz"], answer["unit"],
                  answer["up_axis"])
