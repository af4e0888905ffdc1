#!/usr/bin/env python3
"""Measures the gain of batching: the same load on a server with batching and on one without.

    benchmarks/measure_batching.py BUILD [--server PROGRAM] [--batch 16] [--seconds 5] [--rounds 1]

PROGRAM is the server to measure, by default BUILD/bin/duet-server. BUILD/benchmarks/timed_server has
an engine of known cost, to measure only the batcher. Servers take turns within each round, so that
disturbances affect both; the load generator runs on the same cores.

Prints clips a second and times for callers without pauses, for one short call beside many clips of
ten minutes, and the number of calls that meet tight deadlines.
"""

import argparse
import collections
import pathlib
import re
import statistics
import subprocess
import tempfile
import time

from load_tool import run_load

# (name, flags of duet-load)
LOADS = [
    ("1 caller", ["--callers", "1"]),
    ("8 callers", ["--callers", "8"]),
    ("64 callers", ["--callers", "64"]),
    ("1 caller beside 66 clips of ten minutes", ["--callers", "1", "--background-callers", "66", "--warm-up", "3"]),
    ("64 callers, deadline 0.3 s", ["--callers", "64", "--deadline", "0.3"]),
    ("64 callers, deadline 0.05 s", ["--callers", "64", "--deadline", "0.05"]),
]


def start_server(program, log, batch):
    """The server and its address. The log goes to a file, so no reader delays the server."""
    with log.open("w", encoding="utf-8") as file:
        server = subprocess.Popen(
            [program, "--listen", "127.0.0.1:0", "--metrics-listen", "off",
             "--max-batch-windows", str(batch),
             # All of them for one client: rejected calls would retry and delay the others.
             "--max-queued-windows", "256"], stdout=file, stderr=file)
    while server.poll() is None:
        if found := re.search(r'"event":"serving".*?"port":(\d+)', log.read_text(encoding="utf-8")):
            return server, f"127.0.0.1:{found[1]}"
        time.sleep(0.05)
    raise SystemExit(f"{program} did not start:\n{log.read_text(encoding='utf-8')}")


def measure(chosen, batch, flags):
    with tempfile.TemporaryDirectory() as folder:
        server, address = start_server(chosen.server, pathlib.Path(folder) / "log", batch)
        try:
            return run_load(chosen.build, address, "--seconds", chosen.seconds, *flags)
        finally:
            server.terminate()
            server.wait()


def median(results, figure):
    return statistics.median(result[figure] for result in results)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--server", type=pathlib.Path)
    parser.add_argument("--batch", type=int, default=16)
    parser.add_argument("--seconds", type=float, default=5)
    parser.add_argument("--rounds", type=int, default=1)
    chosen = parser.parse_args()
    chosen.server = chosen.server or chosen.build / "bin" / "duet-server"
    print(f"| load | windows a batch | clips/s | p50 / p99 ms | failed |\n|---|---|---|---|---|")
    for name, flags in LOADS:
        results = collections.defaultdict(list)
        for _ in range(chosen.rounds):
            for batch in (1, chosen.batch):
                results[batch].append(measure(chosen, batch, flags))
        for batch, found in results.items():
            failed = collections.Counter()
            for result in found:
                failed.update(result["failed"])
            print(f"| {name} | {batch} | {median(found, 'clips_per_second'):.0f} | "
                  f"{median(found, 'p50_ms'):.1f} / {median(found, 'p99_ms'):.1f} | "
                  f"{', '.join(f'{count} {code}' for code, count in failed.items()) or '0'} |",
                  flush=True)
        alone, together = (median(results[batch], "clips_per_second")
                           for batch in (1, chosen.batch))
        print(f"| {name} | ratio | {together / max(alone, 1e-9):.2f} | | |", flush=True)


if __name__ == "__main__":
    main()
