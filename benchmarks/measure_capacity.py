#!/usr/bin/env python3
"""What a core does and what a call holds, by the length of clips: the two figures by which servers are counted.

    benchmarks/measure_capacity.py BUILD [--frames 46 230 920 4600 9000] [--callers 32]

A server for each length on the first core, callers that ask without a pause on the others (on the same
one, where there is no other). Prints clips and seconds of motion a second, and by how much the server's
greatest resident memory is above that before the calls, for each caller: what a call holds at the
worst, its leader on the wire and as motion included. `--total-frames` says how many frames are asked for at
each length, though every caller asks at least twice.
"""

import argparse
import os
import pathlib
import re
import subprocess
import tempfile
import time

from load_tool import run_load

FRAME_RATE = 15  # of the default model


class Server:
    """A duet-server on one core; ends with the `with`."""

    def __init__(self, build, core, log):
        with log.open("w", encoding="utf-8") as file:
            # One client makes all calls: it may have every place.
            self._process = subprocess.Popen(
                [build / "bin/duet-server", "--listen", "127.0.0.1:0", "--metrics-listen", "off",
                 "--client-share", "1"], stderr=file,
                preexec_fn=lambda: os.sched_setaffinity(0, {core}))
        while not (found := re.search(r'"event":"serving".*?"port":(\d+)',
                                      log.read_text(encoding="utf-8"))):
            if self._process.poll() is not None:
                raise SystemExit(log.read_text(encoding="utf-8"))
            time.sleep(0.05)
        self.address = f"127.0.0.1:{found[1]}"

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._process.terminate()
        self._process.wait()

    def kilobytes(self, field):
        status = pathlib.Path(f"/proc/{self._process.pid}/status").read_text(encoding="utf-8")
        return int(re.search(rf"{field}:\s+(\d+)", status)[1])

    def forget_peak(self):
        """VmHWM counts from now."""
        pathlib.Path(f"/proc/{self._process.pid}/clear_refs").write_text("5", encoding="utf-8")


def measure(chosen, frames, core, folder):
    with Server(chosen.build, core, folder / "log") as server:
        # One caller first: threads, heaps and scratch memory are there whether few or many ask.
        run_load(chosen.build, server.address, "--callers", 1, "--calls", 4, "--frames", frames)
        before = server.kilobytes("VmRSS")
        server.forget_peak()
        calls = max(2 * chosen.callers, chosen.total_frames // frames)
        seen = run_load(chosen.build, server.address, "--callers", chosen.callers, "--calls", calls,
                        "--warm-up", 0, "--frames", frames)
        if seen["failed"]:
            raise SystemExit(f"calls of {frames} frames failed: {seen['failed']}")
        return seen["clips_per_second"], (server.kilobytes("VmHWM") - before) / chosen.callers


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--frames", type=int, nargs="+", default=[46, 230, 920, 4600, 9000])
    parser.add_argument("--callers", type=int, default=32)
    parser.add_argument("--total-frames", type=int, default=400_000)
    chosen = parser.parse_args()
    chosen.build = chosen.build.resolve()
    core, *others = sorted(os.sched_getaffinity(0))
    os.sched_setaffinity(0, others or {core})
    print("| frames | clips a second a core | seconds of motion a second a core | kB a call |\n"
          "|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        for frames in chosen.frames:
            clips, kilobytes = measure(chosen, frames, core, pathlib.Path(folder))
            print(f"| {frames:,} | {clips:.1f} | {clips * frames / FRAME_RATE:,.0f} "
                  f"| {kilobytes:,.0f} |", flush=True)


if __name__ == "__main__":
    main()
