#!/usr/bin/env python3
"""Runs the engine's benchmarks and prints each beside the last committed figure.

    benchmarks/bench.py build/release                prints the table
    benchmarks/bench.py build/release --commit       writes the figures to benchmarks/figures.json

Speeds of different machines, or of a machine with other load, are not comparable: the table names
the machine of the committed figures and shows this machine's speed at plain arithmetic (roofline/...).
"""
import argparse
import json
import os
import pathlib
import subprocess

FIGURES = pathlib.Path(__file__).resolve().parent / "figures.json"
PROGRAMS = {
    "roofline": ("roofline_benchmark", ""),
    "kernel": ("kernel_benchmark", ""),
    "solver": ("solver_benchmark", ""),
    # Clips only with the default engine: the others take minutes.
    "synthesis": ("synthesis_benchmark", "^windows/|^cleaned_windows/.*/(f32|int16)|^clip/.*/int16"),
}


def run(build, program, chosen, seconds):
    """The benchmarks of one program: name -> milliseconds of processor time an iteration."""
    command = [build / "benchmarks" / program, "--benchmark_format=json",
               f"--benchmark_min_time={seconds}"]
    if chosen:
        command.append(f"--benchmark_filter={chosen}")
    printed = subprocess.run(command, check=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                             env={**os.environ, "OMP_NUM_THREADS": "1"})
    scale = {"ns": 1e-6, "us": 1e-3, "ms": 1.0, "s": 1e3}
    return {entry["name"]: entry["cpu_time"] * scale[entry["time_unit"]]
            for entry in json.loads(printed.stdout)["benchmarks"]
            if entry["run_type"] == "iteration" and "error_occurred" not in entry}


def machine():
    for line in pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
        if line.startswith("model name"):
            return f"{line.split(':', 1)[1].strip()}, {os.cpu_count()} processors"
    return "unknown"


def table(figures, before):
    """Lines: name, milliseconds now, milliseconds committed, how many times as long now."""
    width = max(len(name) for name in figures)
    yield f"{'':{width}}  {'ms':>12}  {'committed':>12}  times"
    for name, now in figures.items():
        then = before.get(name)
        committed = f"{then:12.5f}  {now / then:5.2f}" if then else f"{'-':>12}"
        yield f"{name:{width}}  {now:12.5f}  {committed}"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--commit", action="store_true", help="keep the figures")
    parser.add_argument("--seconds", type=float, default=0.3, help="of each benchmark, at least")
    arguments = parser.parse_args()
    committed = json.loads(FIGURES.read_text(encoding="utf-8")) if FIGURES.exists() else {}
    figures = {}
    for room, (program, chosen) in PROGRAMS.items():
        for name, time in run(arguments.build, program, chosen, arguments.seconds).items():
            figures[f"{room}/{name}"] = time
    print(f"here: {machine()}")
    print(f"committed: {committed.get('machine', 'nothing')}")
    print("\n".join(table(figures, committed.get("milliseconds", {}))))
    if arguments.commit:
        kept = {"machine": machine(), "milliseconds": figures}
        FIGURES.write_text(json.dumps(kept, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
