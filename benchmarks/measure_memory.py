#!/usr/bin/env python3
"""Measures the memory that a server needs within its limits: plays mixes of valid calls against a real
server, in its own control group if possible.

    benchmarks/measure_memory.py BUILD [MIX ...] [--limit MIB] [--server PROGRAM] [-- FLAG ...]

Prints a table row for each mix: the results of the calls and the peak of the server's memory. --limit
limits the server's memory and also prints the group's peak; FLAGs go to the server. Needs
python3-grpcio. docs/costs.md has the figures and the formula that follows from them.
"""

import argparse
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import time

SOURCE = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(SOURCE / "tests/e2e"))
import memory_mixes as mixes  # pylint: disable=wrong-import-position

MEGABYTE = 1_000_000
LONGEST = dict(frames=144000, rate=240, chunk_frames=240)  # ten minutes: 26 MB


class Server:
    """A server on a free port, in a group that limits its memory if there is one."""

    def __init__(self, program, flags, limit):
        self.group, why = mixes.Cgroup.create(limit) if limit else (None, "")
        if limit and self.group is None:
            raise SystemExit(f"no control group can be made here: {why}")
        command = [program, "--listen", "127.0.0.1:0", "--metrics-listen", "off", *flags]
        self.log = tempfile.NamedTemporaryFile("w+", suffix=".log")
        self.process = subprocess.Popen(self.group.command(command) if self.group else command,
                                        stdout=self.log, stderr=self.log)
        while not (found := re.search(r'"serving".*?"port":(\d+)', self.text())):
            if self.process.poll() is not None:
                raise SystemExit(f"{program} did not start:\n{self.text()}")
            time.sleep(0.02)
        self.port = int(found[1])
        self.idle = mixes.resident_peak(self.process.pid)

    def text(self):
        return pathlib.Path(self.log.name).read_text(encoding="utf-8")

    def alive(self):
        return self.process.poll() is None

    def ask(self, payload, callers, **options):
        return str(mixes.until_answered(self.port, payload, callers, 300, alive=self.alive, **options))

    def stop(self):
        """How it ended, and its peaks: resident, of its group."""
        resident = mixes.resident_peak(self.process.pid) if self.alive() else 0
        self.process.send_signal(signal.SIGTERM)
        code = self.process.wait(timeout=120)
        held = self.group.peak() if self.group else 0
        if self.group:
            self.group.remove()
        return code, resident, held


def leaders(server):
    """Sixteen ten-minute leaders at 240 Hz at once, repeated until they are answered."""
    return server.ask(mixes.request(**LONGEST), 16)


def one_leader(server):
    """One of them."""
    return server.ask(mixes.request(**LONGEST), 1)


def small(server):
    """128 connections with 20 short calls each."""
    return server.ask(mixes.request(46), 128, each=20)


def stalled(server):
    """256 calls of ten seconds at 240 Hz on eight connections with unread replies."""
    readers = mixes.StalledReaders(
        server.port, mixes.request(2400, rate=240, chunk_frames=240), connections=8, calls=32)
    time.sleep(15)
    readers.close()
    return "not read"


def stalled_labels(server):
    """The same with 2,400 label key frames each."""
    readers = mixes.StalledReaders(
        server.port, mixes.request(2400, rate=240, chunk_frames=240, keyframes=2400), connections=8, calls=32)
    time.sleep(15)
    readers.close()
    return "not read"


def stalled_leaders(server):
    """Sixteen ten-minute leaders with unread replies, and eight of the same that are read."""
    readers = mixes.StalledReaders(server.port, mixes.request(**LONGEST), connections=16, calls=1)
    time.sleep(5)
    outcome = server.ask(mixes.request(**LONGEST), 8)
    readers.close()
    return outcome


def uploads(server):
    """48 requests of 31 MiB that lack their last byte."""
    held = mixes.SlowUploads(server.port, 31 * mixes.MIB, 48)
    time.sleep(20)
    held.close()
    return "never whole"


def large_uploads(server):
    """48 requests of 63 MiB that lack their last byte."""
    held = mixes.SlowUploads(server.port, 63 * mixes.MIB, 48)
    time.sleep(20)
    held.close()
    return "never whole"


MIXES = (one_leader, leaders, small, stalled, stalled_labels, stalled_leaders, uploads, large_uploads)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("mixes", nargs="*", metavar="MIX",
                        help=", ".join(mix.__name__ for mix in MIXES))
    parser.add_argument("--limit", type=int, help="MiB that the server is held to")
    parser.add_argument("--server", type=pathlib.Path)
    own = sys.argv[1:sys.argv.index("--")] if "--" in sys.argv else sys.argv[1:]
    args = parser.parse_args(own)
    flags = sys.argv[len(own) + 2:]
    for mix in MIXES:
        if args.mixes and mix.__name__ not in args.mixes:
            continue
        server = Server(args.server or args.build / "bin/duet-server", flags,
                        (args.limit or 0) * mixes.MIB)
        outcome = mix(server)
        code, resident, held = server.stop()
        print(f"| {mix.__name__} | {outcome} | exit {code} | idle {server.idle // MEGABYTE} | "
              f"peak {resident // MEGABYTE} | group {held // MEGABYTE} |", flush=True)


if __name__ == "__main__":
    main()
