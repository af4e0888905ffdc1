"""Runs the program `duet` without blocking Blender, and reports its errors."""

import json
import os
import shutil
import subprocess

import bpy


class DuetError(Exception):
    """An error that the user can correct."""


def find(program):
    path = bpy.path.abspath(program)
    found = path if os.path.isfile(path) else shutil.which(program)
    if not found:
        raise DuetError(f"There is no program {program!r}. Set its path under Server.")
    return found


def run(settings, *arguments):
    """A generator that yields until the program has ended, and returns its output."""
    process = subprocess.Popen([find(settings.program), *map(str, arguments)],
                               stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                               stderr=subprocess.PIPE, text=True)
    try:
        while True:
            try:
                output, errors = process.communicate(timeout=0.01)
                break
            except subprocess.TimeoutExpired:
                yield
    finally:
        if process.poll() is None:
            process.kill()
            process.communicate()
    if process.returncode != 0:
        raise DuetError(in_the_panel(errors.strip())
                        or f"duet exited with code {process.returncode}")
    return output


def in_the_panel(message):
    """Replaces hints about the program's flags by hints about the panel."""
    lines = message.splitlines()
    hints = [line for line in lines if "joint-map" in line and line.startswith("Specify it with")]
    kept = [line for line in lines if line not in hints]
    return "\n".join(kept + ["Choose the bones in the panel, under Reading the leader."] * bool(hints))


def models(settings):
    """The server's models, as `duet models --json` describes them. A generator like run()."""
    found = json.loads((yield from run(settings, "models", "--server", settings.server, "--json")))
    if not found["models"]:
        raise DuetError("The server serves no model.")
    return found["models"]
