#!/usr/bin/env python3
"""Compares the engines with eager PyTorch and ONNX Runtime, one thread each, in one run: windows a
second, and their ratio to those of the peers.

    benchmarks/compare_engines.py build/release [NODE_MODULES]

Needs Debian's python3-torch; for ONNX Runtime also node and a folder with it: `npm install
--ignore-scripts onnxruntime-node@1.17.3`. Measures processor time; each figure is the best of three
rounds in which all take turns. Duet's figures are complete answers (standard coordinates, checks,
limb lengths; without clean-up), those of the peers only the network.
"""
import collections
import json
import os
import pathlib
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
BATCHES = (1, 8, 32, 64)
ENGINES = ("int16", "f32", "torch")
ENVIRONMENT = dict(os.environ, OMP_NUM_THREADS="1", MKL_NUM_THREADS="1")


def ours(build):
    """(model, engine, batch) -> windows a second."""
    run = subprocess.run(
        [build / "benchmarks/synthesis_benchmark", "--benchmark_filter=^windows/sbu",
         "--benchmark_min_time=0.5", "--benchmark_format=json"],
        stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=True, env=ENVIRONMENT)
    speeds = {}
    for row in json.loads(run.stdout)["benchmarks"]:
        _, model, engine, batch = row["name"].split("/")
        speeds[model, engine, int(batch)] = 1000 * int(batch) / row["cpu_time"]
    return speeds


def eager():
    run = subprocess.run(
        ["/usr/bin/python3", HERE / "inference_eager.py", "1", *map(str, BATCHES)],
        stdout=subprocess.PIPE, check=True, env=ENVIRONMENT)
    rows = [json.loads(line) for line in run.stdout.splitlines()]
    return {(row["model"], "eager", row["batch"]): 1000 * row["batch"] / row["milliseconds"]
            for row in rows}


def onnx(modules, graphs):
    run = subprocess.run(["node", HERE / "inference_onnx.mjs", modules, graphs,
                          *map(str, BATCHES)], stdout=subprocess.PIPE, check=True)
    rows = [json.loads(line) for line in run.stdout.splitlines()]
    return {(row["model"], "onnx runtime", row["batch"]): 1000 * row["batch"] / row["milliseconds"]
            for row in rows}


def processor():
    info = pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8")
    name = next(line.split(":")[1].strip() for line in info.splitlines()
                if line.startswith("model name"))
    flags = next(line for line in info.splitlines() if line.startswith("flags")).split()
    has = [flag for flag in ("avx2", "avx512f", "avx512_vnni") if flag in flags]
    return f"{name}, {os.cpu_count()} cores, {' '.join(has)}"


def main():
    build = pathlib.Path(sys.argv[1]).resolve()
    modules = pathlib.Path(sys.argv[2]).resolve() if len(sys.argv) > 2 else None
    best = collections.defaultdict(float)
    with tempfile.TemporaryDirectory() as graphs:
        peers = [eager]
        if modules:
            subprocess.run(["/usr/bin/python3", HERE / "inference_eager.py", "--export", graphs],
                           stderr=subprocess.DEVNULL, check=True)
            peers.append(lambda: onnx(modules, graphs))
        for _ in range(3):
            for measure in [*peers, lambda: ours(build)]:
                for key, speed in measure().items():
                    best[key] = max(best[key], speed)
    print_tables(best)


def print_tables(best):
    print(processor())
    for model, what in (("sbu@1", "the paper's generator"), ("sbu@3", "the sampling generator")):
        print(f"\n{what} ({model}), windows of 45 frames a second, one thread")
        print("| engine | " + " | ".join(f"batch {b}" for b in BATCHES)
              + " | one window / eager's | best / eager's best | / onnx runtime's, each batch |")
        print("|---" * (len(BATCHES) + 4) + "|")
        eagers, others = ([best[model, peer, b] for b in BATCHES]
                          for peer in ("eager", "onnx runtime"))
        for engine in ENGINES + ("eager", "onnx runtime"):
            row = [best[model, engine, b] for b in BATCHES]
            if max(row) == 0:
                continue
            ratios = [f"{speed / other:.1f}" for speed, other in zip(row, others) if other]
            print(f"| {engine} | " + " | ".join(f"{speed:.0f}" for speed in row)
                  + f" | {row[0] / eagers[0]:.1f} | {max(row) / max(eagers):.1f} | "
                  + " ".join(ratios) + " |")


if __name__ == "__main__":
    main()
