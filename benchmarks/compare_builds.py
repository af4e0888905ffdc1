#!/usr/bin/env python3
"""Compares the speed of two builds of one benchmark program, taking turns on the same machine.

    benchmarks/compare_builds.py BEFORE AFTER [--rounds 5] [--filter REGEX]

BEFORE and AFTER are programs, such as <build>/benchmarks/synthesis_benchmark of two revisions. The
two run one after the other, --rounds times, so that disturbances affect both. Prints the median CPU time of each benchmark in either build, and their ratio (above 1: AFTER is slower)
with the smallest and largest ratio of a round.
"""

import argparse
import collections
import json
import statistics
import subprocess


def run(program, pattern):
    """One run: benchmark -> CPU time in milliseconds."""
    scale = {"ns": 1e-6, "us": 1e-3, "ms": 1.0, "s": 1e3}
    printed = subprocess.run(
        [program, "--benchmark_format=json", f"--benchmark_filter={pattern}"],
        capture_output=True, check=True, text=True).stdout
    return {row["name"]: row["cpu_time"] * scale[row["time_unit"]]
            for row in json.loads(printed)["benchmarks"]
            if row["run_type"] == "iteration" and "error_occurred" not in row}


def compare(before_program, after_program, rounds, pattern="."):
    """Runs both `rounds` times and prints the table."""
    times = collections.defaultdict(lambda: ([], []))
    for _ in range(rounds):
        for side, program in enumerate((before_program, after_program)):
            for name, milliseconds in run(program, pattern).items():
                times[name][side].append(milliseconds)
    print(f"{'benchmark':<34} {'before ms':>10} {'after ms':>10} {'ratio':>6}  rounds' ratios")
    for name, (before, after) in times.items():
        if not before or not after:
            print(f"{name:<34} only in one build")
            continue
        ratios = [b / a for a, b in zip(before, after)]
        print(f"{name:<34} {statistics.median(before):>10.3f} {statistics.median(after):>10.3f} "
              f"{statistics.median(ratios):>6.2f}  {min(ratios):.2f} to {max(ratios):.2f}")


def main():
    arguments = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    arguments.add_argument("before")
    arguments.add_argument("after")
    arguments.add_argument("--rounds", type=int, default=5)
    arguments.add_argument("--filter", default=".")
    chosen = arguments.parse_args()
    compare(chosen.before, chosen.after, chosen.rounds, chosen.filter)


if __name__ == "__main__":
    main()
