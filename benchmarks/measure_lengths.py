#!/usr/bin/env python3
"""Measures the cost of a clip by its length: time, time to its first chunk, the server's processor
time and memory, and the overhead of a call over the engine's own time.

    benchmarks/measure_lengths.py BUILD [--model sbu@2] [--rounds 3] [--frames 46] [--awake]

Each length has its own server, so that the peak memory belongs to that length. One caller calls it,
and one calls a server whose engine answers at once (tests/duet-fake-server), which measures the call
without an engine. The engine without a server is BUILD/benchmarks/synthesis_benchmark with clips of
the same length in the same rounds. Prints the median of the rounds; ratios are to the previous length.

--awake keeps every core awake with a process of idle priority: the difference in a call's time is the
wake-up time of the machine.
"""

import argparse
import json
import math
import multiprocessing
import os
import pathlib
import re
import statistics
import subprocess
import tempfile

from load_tool import run_load
from measure_batching import start_server

# Calls of each length, up to the ten minutes that a server takes.
CALLS = {46: 200, 460: 40, 4600: 8, 9000: 4}
TICK_SECONDS = 1 / os.sysconf("SC_CLK_TCK")


def processor_seconds(pid):
    fields = pathlib.Path(f"/proc/{pid}/stat").read_text(encoding="utf-8").rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) * TICK_SECONDS


def megabytes(pid, field):
    status = pathlib.Path(f"/proc/{pid}/status").read_text(encoding="utf-8")
    return int(re.search(rf"{field}:\s+(\d+)", status)[1]) / 1024


def measure(build, program, frames, *flags):
    with tempfile.TemporaryDirectory() as folder:
        server, address = start_server(build / program, pathlib.Path(folder) / "log", 16)
        try:
            before = processor_seconds(server.pid), megabytes(server.pid, "VmRSS")
            found = run_load(build, address, "--frames", frames, "--warm-up", 0, "--calls",
                             CALLS[frames], *flags)
            if found["failed"]:
                raise SystemExit(f"{frames} frames: {found['failed']}")
            seconds = processor_seconds(server.pid) - before[0]
            return {"whole": found["p50_ms"], "first": found["first_chunk_p50_ms"],
                    "microseconds": seconds * 1e6 / CALLS[frames] / frames,
                    "megabytes": megabytes(server.pid, "VmHWM") - before[1]}
        finally:
            server.terminate()
            server.wait()


def alone(build, model, frames):
    """Milliseconds of the engine for one clip, in the precision that this processor's server has."""
    name, _, version = model.partition("@")
    printed = subprocess.run(
        [build / "benchmarks/synthesis_benchmark", "--benchmark_format=json",
         f"--benchmark_filter=clip/{name}@{version}/(f32|bf16)/{frames}$"],
        env={**os.environ, "OMP_NUM_THREADS": "1"}, stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL, check=True).stdout
    if not printed:
        return math.nan  # it has no clips of ten minutes
    return min(run["real_time"] for run in json.loads(printed)["benchmarks"])


def spin():
    os.sched_setscheduler(0, os.SCHED_IDLE, os.sched_param(0))
    while True:
        pass


def keep_awake():
    for _ in os.sched_getaffinity(0):
        multiprocessing.Process(target=spin, daemon=True).start()


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--model", default="sbu@2")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--frames", type=int, choices=CALLS, help="only this length")
    parser.add_argument("--awake", action="store_true")
    chosen = parser.parse_args()
    if chosen.awake:
        keep_awake()
    print("| frames | first chunk, ms | whole call, ms | engine only, ms | call without engine, ms "
          "| server's time, us a frame | ratio | memory above idle, MB |\n" + "|---" * 8 + "|")
    last = None
    for frames in [chosen.frames] if chosen.frames else CALLS:
        rounds = [(measure(chosen.build, "bin/duet-server", frames, "--model", chosen.model),
                   alone(chosen.build, chosen.model, frames),
                   measure(chosen.build, "tests/duet-fake-server", frames)["whole"])
                  for _ in range(chosen.rounds)]
        middle = {key: statistics.median(call[key] for call, _, _ in rounds)
                  for key in rounds[0][0]}
        engine = statistics.median(engine for _, engine, _ in rounds)
        without = statistics.median(without for _, _, without in rounds)
        engine = "" if math.isnan(engine) else f"{engine:.2f}"
        cost = middle["microseconds"]
        print(f"| {frames} | {middle['first']:.2f} | {middle['whole']:.2f} | {engine} | "
              f"{without:.2f} | {cost:.1f} | {f'{cost / last:.2f}' if last else ''} | "
              f"{middle['megabytes']:.1f} |", flush=True)
        last = cost


if __name__ == "__main__":
    main()
