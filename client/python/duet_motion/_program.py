"""The program `duet`, which reads and writes motion files for this package."""

from __future__ import annotations

import os
import shutil
import subprocess


class CommandFailed(Exception):
    """A command exited with a code other than 0. The message is its standard error."""

    def __init__(self, message: str, output: str) -> None:
        super().__init__(message)
        self.output = output
        """What it wrote to its standard output."""


def find() -> str:
    """The path of the program. Raises FileNotFoundError with instructions to install it."""
    name = os.environ.get("DUET_PROGRAM", "duet")
    found = shutil.which(name)
    if found is None:
        raise FileNotFoundError(
            f"program {name!r}: expected Duet's command-line client, which reads and writes motion "
            "files, got no such program; pip does not install it: install the Debian package "
            "duet (deploy/README.md) or build the program, and put it on the PATH or set "
            "DUET_PROGRAM")
    return found


def run(*arguments: str) -> str:
    """Runs a command and returns its output. The user's configuration file is ignored.

    Raises:
        CommandFailed: its exit code is not 0.
        FileNotFoundError: there is no program.
    """
    done = subprocess.run([find(), *arguments], capture_output=True, check=False,
                          env={**os.environ, "DUET_CONFIG": "", "NO_COLOR": "1"})
    errors = done.stderr.decode(errors="replace").strip().removeprefix("duet: ")
    if done.returncode < 0:
        errors += f"the program was ended by signal {-done.returncode}"
    if done.returncode != 0:
        raise CommandFailed(errors, done.stdout.decode(errors="replace"))
    return done.stdout.decode()
