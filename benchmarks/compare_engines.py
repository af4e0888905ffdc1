#!/usr/bin/env python3
"""The engines beside eager PyTorch, one thread each, in one run: windows a second and how many times
eager's best batch.

    benchmarks/compare_engines.py build/release

Needs Debian's python3-torch. Each figure is the better of two rounds, in which all take turns:
machines are noisy.
"""
import collections
import json
import os
import pathlib
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
BATCHES = (1, 8, 32, 64)
ENGINES = ("bf16", "f32", "torch")
ENVIRONMENT = dict(os.environ, OMP_NUM_THREADS="1", MKL_NUM_THREADS="1")


def ours(build):
    """(model, engine, batch) -> windows a second."""
    run = subprocess.run(
        [build / "benchmarks/synthesis_benchmark", "--benchmark_filter=windows/sbu",
         "--benchmark_min_time=0.5", "--benchmark_format=json"],
        stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=True, env=ENVIRONMENT)
    speeds = {}
    for row in json.loads(run.stdout)["benchmarks"]:
        _, model, engine, batch = row["name"].split("/")
        speeds[model, engine, int(batch)] = 1000 * int(batch) / row["real_time"]
    return speeds


def eager():
    run = subprocess.run(
        ["/usr/bin/python3", HERE / "inference_eager.py", "1", *map(str, BATCHES)],
        stdout=subprocess.PIPE, check=True, env=ENVIRONMENT)
    rows = [json.loads(line) for line in run.stdout.splitlines()]
    return {(row["model"], "eager", row["batch"]): 1000 * row["batch"] / row["milliseconds"]
            for row in rows}


def processor():
    info = pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8")
    name = next(line.split(":")[1].strip() for line in info.splitlines()
                if line.startswith("model name"))
    flags = next(line for line in info.splitlines() if line.startswith("flags")).split()
    has = [flag for flag in ("avx2", "avx512f", "avx512_bf16", "amx_bf16") if flag in flags]
    return f"{name}, {os.cpu_count()} cores, {' '.join(has)}"


def main():
    build = pathlib.Path(sys.argv[1]).resolve()
    best = collections.defaultdict(float)
    for _ in range(2):
        for measured in (eager(), ours(build)):
            for key, speed in measured.items():
                best[key] = max(best[key], speed)
    print(processor())
    for model, what in (("sbu@1", "the paper's generator"), ("sbu@2", "the sampling generator")):
        print(f"\n{what} ({model}), windows of 45 frames a second, one thread")
        print("| engine | " + " | ".join(f"batch {b}" for b in BATCHES)
              + " | one window / eager's | best batch / eager's best |")
        print("|---" * (len(BATCHES) + 3) + "|")
        peer = max(best[model, "eager", b] for b in BATCHES)
        for engine in ENGINES + ("eager",):
            row = [best[model, engine, b] for b in BATCHES]
            if max(row) == 0:
                continue
            print(f"| {engine} | " + " | ".join(f"{speed:.0f}" for speed in row)
                  + f" | {row[0] / best[model, 'eager', 1]:.1f} | {max(row) / peer:.1f} |")


if __name__ == "__main__":
    main()
