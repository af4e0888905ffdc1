"""A live session of the program `duet`, which runs beside Blender. Two threads write and read its lines,
so that nobody else waits for them."""

import collections
import json
import queue
import subprocess
import threading

from . import program

_INTERRUPTED, _RESUMED = "; resuming", "duet: resumed"


class Stream:
    """Runs `duet live` with lines of JSON (docs/live.md).

    Requires no Blender: all methods return at once, and none is called by the threads."""

    def __init__(self, path, flags, clock):
        self._clock = clock
        self._process = subprocess.Popen(
            [path, "live", "--from", "-", "--realtime", "--to", "-", *map(str, flags)],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self._lines = queue.SimpleQueue()  # to write; None ends the leader
        self._answers = collections.deque()
        self._errors = collections.deque(maxlen=20)
        self.joints = None
        """The names of the follower's joints; None before the program has written them."""
        self.resumed = 0
        self.interrupted = False
        self._threads = [threading.Thread(target=work, daemon=True)
                         for work in (self._write, self._read, self._read_errors)]
        for thread in self._threads:
            thread.start()

    def send(self, line):
        """Sends a line: a dictionary."""
        self._lines.put(json.dumps(line))

    def finish(self):
        """Ends the leader's motion. The frames that are due still arrive."""
        self._lines.put(None)

    def take(self):
        """Answers since the last call: (frame, positions of the joints, time of arrival)."""
        taken = []
        while self._answers:
            taken.append(self._answers.popleft())
        return taken

    def has_ended(self):
        """Whether the program has ended and its last answer has been read."""
        return self._process.poll() is not None and not any(
            thread.is_alive() for thread in self._threads[1:])

    def error(self):
        """What the program reported if it failed; "" if it did not. Only after its end."""
        if self._process.returncode == 0:
            return ""
        return (program.in_the_panel("\n".join(self._errors))
                or f"duet exited with code {self._process.returncode}")

    def kill(self):
        """Ends the program at once."""
        self._process.kill()
        self._process.wait()
        self._lines.put(None)

    def _write(self):
        try:
            while (line := self._lines.get()) is not None:
                self._process.stdin.write(line + "\n")
                if self._lines.empty():
                    self._process.stdin.flush()
            self._process.stdin.close()
        except OSError:  # the program has ended; error() has the reason
            pass

    def _read(self):
        for text in self._process.stdout:
            line = json.loads(text)
            if "joints" in line:
                self.joints = line["joints"]
            else:
                self._answers.append((line["frame"], line["positions"], self._clock()))

    def _read_errors(self):
        for line in self._process.stderr:
            line = line.rstrip()
            if line.endswith(_INTERRUPTED):
                self.interrupted = True
            elif line == _RESUMED:
                self.interrupted = False
                self.resumed += 1
            elif line:
                self._errors.append(line)
