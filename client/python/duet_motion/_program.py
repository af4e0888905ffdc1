"""The program `duet`, which reads and writes motion files for this package.

Starting a process takes longer than reading a short file, so a process is kept for the next command
(``duet stdio``). It ends with this Python process. If it ends earlier, for any reason, another one
is started.
"""

from __future__ import annotations

import atexit
import contextlib
import json
import os
import shutil
import subprocess
import threading
from typing import Dict, List, Optional, Sequence, Tuple

# Maximum number of idle processes to keep: so many threads can read files without starting one.
_MOST_IDLE = 4
_STOP_SECONDS = 5


class CommandFailed(Exception):
    """A command exited with a code other than 0. The message is its standard error."""

    def __init__(self, message: str, output: str) -> None:
        super().__init__(message)
        self.output = output
        """What it wrote to its standard output."""


class _Ended(Exception):
    """The process ended, or its version has no ``duet stdio``."""


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
    code, out, err = _run(find(), arguments)
    if code != 0:
        raise CommandFailed(err.decode(errors="replace").strip().removeprefix("duet: "),
                            out.decode(errors="replace"))
    return out.decode()


def _run(program: str, arguments: Sequence[str]) -> Tuple[int, bytes, bytes]:
    try:
        line = json.dumps(arguments, ensure_ascii=False).encode() + b"\n"
    except UnicodeEncodeError:  # a file name that is not UTF-8, which JSON cannot carry
        return _run_once(program, arguments)
    key = (program, os.getcwd())
    helper = _idle.take(key)
    while True:
        fresh = helper is None
        helper = helper or _Helper(program)
        try:
            answer = helper.ask(line)
        except _Ended:
            if fresh:  # the command itself reports the cause
                return _run_once(program, arguments)
            helper = None
            continue
        _idle.put(key, helper)
        return answer


def _run_once(program: str, arguments: Sequence[str]) -> Tuple[int, bytes, bytes]:
    done = subprocess.run([program, *arguments], capture_output=True, check=False,
                          env=_environment())
    if done.returncode < 0:
        return done.returncode, b"", (done.stderr + b"the program was ended by signal "
                                      + str(-done.returncode).encode())
    return done.returncode, done.stdout, done.stderr


def _environment() -> Dict[str, str]:
    return {**os.environ, "DUET_CONFIG": "", "NO_COLOR": "1"}


class _Helper:
    """A process that runs one command after another, for one thread at a time."""

    def __init__(self, program: str) -> None:
        # A separate session, so that Ctrl-C at the terminal reaches only this process.
        self._process = subprocess.Popen(
            [program, "stdio"], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL, start_new_session=True, env=_environment())

    def ask(self, line: bytes) -> Tuple[int, bytes, bytes]:
        try:
            return self._ask(line)
        except (OSError, ValueError, KeyError) as error:
            self._kill()
            raise _Ended from error
        except BaseException:  # such as Ctrl-C: the answer would be read by the next command
            self._kill()
            raise

    def _ask(self, line: bytes) -> Tuple[int, bytes, bytes]:
        assert self._process.stdin is not None
        self._process.stdin.write(line)
        self._process.stdin.flush()
        assert self._process.stdout is not None
        answer = json.loads(self._process.stdout.readline())
        return answer["exit_code"], self._read(answer["out_bytes"]), self._read(answer["err_bytes"])

    def _read(self, count: int) -> bytes:
        assert self._process.stdout is not None
        data = self._process.stdout.read(count)
        if len(data) != count:
            raise OSError("the program ended in the middle of its answer")
        return data

    def _kill(self) -> None:
        self._process.kill()
        self.close()

    def abandon(self) -> None:
        """Closes the inherited pipes of a parent's child process without waiting for it."""
        self._process.returncode = 0
        self._close_pipes()

    def close(self) -> None:
        """Closes the input, which ends the process, and waits for it."""
        self._close_pipes()
        try:
            self._process.wait(_STOP_SECONDS)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()

    def _close_pipes(self) -> None:
        for pipe in (self._process.stdin, self._process.stdout):
            if pipe is not None:
                with contextlib.suppress(OSError):  # the buffered data has no reader
                    pipe.close()


class _Idle:
    """Idle processes of one program and working directory."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._key: Optional[Tuple[str, str]] = None
        self._helpers: List[_Helper] = []

    def take(self, key: Tuple[str, str]) -> Optional[_Helper]:
        with self._lock:
            stale = [] if key == self._key else self._helpers
            if key != self._key:
                self._key, self._helpers = key, []
            found = self._helpers.pop() if self._helpers else None
        for helper in stale:
            helper.close()
        return found

    def put(self, key: Tuple[str, str], helper: _Helper) -> None:
        with self._lock:
            kept = key == self._key and len(self._helpers) < _MOST_IDLE
            if kept:
                self._helpers.append(helper)
        if not kept:
            helper.close()

    def close(self) -> None:
        with self._lock:
            helpers, self._helpers = self._helpers, []
        for helper in helpers:
            helper.close()

    def forget(self) -> None:
        """Called in the child after a fork, because the processes belong to the parent."""
        self._lock = threading.Lock()  # the thread that held it does not exist in the child
        for helper in self._helpers:
            helper.abandon()
        self._helpers = []


_idle = _Idle()
atexit.register(_idle.close)
if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_idle.forget)
