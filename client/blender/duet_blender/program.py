"""Runs the program `duet` beside Blender, and says what it says when it fails."""

import json
import os
import shutil
import subprocess

import bpy


class DuetError(Exception):
    """Something that the user can read and mend."""


def find(program):
    path = bpy.path.abspath(program)
    found = path if os.path.isfile(path) else shutil.which(program)
    if not found:
        raise DuetError(f"There is no program {program!r}: say in the panel, under Server, where it is")
    return found


def run(settings, *arguments):
    """A generator that yields until the program has ended; returns what it printed."""
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
        raise DuetError(_in_the_panel(errors.strip())
                        or f"duet ended with status {process.returncode}")
    return output


def _in_the_panel(message):
    """An error with the panel's names for what the program's flags are."""
    lines = message.splitlines()
    hints = [line for line in lines if "joint-map" in line and line.startswith("Say it with")]
    kept = [line for line in lines if line not in hints]
    return "\n".join(kept + ["Choose the bones in the panel, under Reading the leader."] * bool(hints))


def classes(settings):
    """The interaction classes of the server's default model (a generator, as run)."""
    models = json.loads((yield from run(settings, "models", "--server", settings.server, "--json")))
    chosen = [model for model in models["models"] if model["is_default"]] or models["models"]
    if not chosen:
        raise DuetError("The server serves no model")
    return chosen[0]["interaction_classes"]
