#!/usr/bin/env python3
"""Measures what thirty seconds of the demo's dance cost a server: processor time on one core.

    benchmarks/measure_dance.py BUILD [--seeds 8] [--candidates 1,4]

One server answers `duet synthesize` with the leader and the keyframes of scripts/demo.sh, whose
labels of turns make windows draw further samples. "basic" has one label throughout. The figures are
the server's processor time for an answer: clean-up, grading and sending included.
"""

import argparse
import pathlib
import re
import statistics
import subprocess
import tempfile

from measure_batching import start_server
from measure_lengths import processor_seconds

SOURCE = pathlib.Path(__file__).resolve().parents[1]


def demo_labels():
    """The keyframes of the demo's dance, as flags."""
    script = (SOURCE / "scripts/demo.sh").read_text(encoding="utf-8")
    return re.findall(r"--keyframe|\d+:\w+=1", script)


def answer(build, address, labels, candidates, seed):
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([build / "bin/duet", "synthesize", "--server", address, "--model", "salsa",
                        "--leader", SOURCE / "samples/salsa.bvh", "--seed", str(seed),
                        "--candidates", str(candidates), *labels,
                        "--out", pathlib.Path(folder) / "follower.json"],
                       stdout=subprocess.DEVNULL, check=True)


def measure(build, labels, candidates, seeds):
    """Milliseconds of the server's processor time for each seed."""
    with tempfile.TemporaryDirectory() as folder:
        server, address = start_server(build / "bin/duet-server", pathlib.Path(folder) / "log", 16)
        try:
            answer(build, address, labels, candidates, 0)  # loads what loads on demand
            spent = []
            for seed in range(1, seeds + 1):
                before = processor_seconds(server.pid)
                answer(build, address, labels, candidates, seed)
                spent.append(1000 * (processor_seconds(server.pid) - before))
            return spent
        finally:
            server.terminate()
            server.wait()


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--seeds", type=int, default=8)
    parser.add_argument("--candidates", default="1,4", help="numbers of candidates to measure")
    chosen = parser.parse_args()
    print("| labels | candidates | mean, ms | least, ms | most, ms |\n|---|---|---|---|---|")
    for name, labels in (("the demo's", demo_labels()), ("basic", ["--label", "basic=1"])):
        for candidates in map(int, chosen.candidates.split(",")):
            spent = measure(chosen.build, labels, candidates, chosen.seeds)
            print(f"| {name} | {candidates} | {statistics.mean(spent):.0f} | {min(spent):.0f} | "
                  f"{max(spent):.0f} |", flush=True)


if __name__ == "__main__":
    main()
