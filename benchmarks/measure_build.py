#!/usr/bin/env python3
"""Measures what the build of `make demo` or of `make test` takes from an empty compiler cache: the processor time of all commands,
and the compilations and links that take the most. Processor time varies less with other load than the time on a clock.

    benchmarks/measure_build.py demo|test [CMAKE_OPTION...]     in build/measure, which it empties first
    benchmarks/measure_build.py demo -DDUET_BATCHES=OFF -DDUET_PRECOMPILE=OFF
"""

import os
import pathlib
import resource
import shutil
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
BUILD = ROOT / "build/measure"
TARGETS = {"demo": ("OFF", ["duet-server", "duet"]), "test": ("ON", ["all"])}  # with tests and benchmarks or without; what to build
SHOWN = 20  # steps


def processor_seconds():
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def run_step(log, command):
    """Runs a command of the build as its launcher, and notes its time and output file."""
    status = subprocess.run(command, check=False).returncode
    output = command[command.index("-o") + 1] if "-o" in command else command[-1]
    with open(log, "a", encoding="utf-8") as file:
        file.write(f"{processor_seconds():.3f}\t{output}\n")
    return status


def configure(with_tests, options, log):
    shutil.rmtree(BUILD, ignore_errors=True)
    launcher = f"{sys.executable};-ISB;{pathlib.Path(__file__).resolve()};--step;{log}"
    subprocess.run(["cmake", "--preset", "release", "-B", BUILD, f"-DDUET_BUILD_TESTS={with_tests}",
                    f"-DDUET_BUILD_BENCHMARKS={with_tests}", f"-DCMAKE_CXX_COMPILER_LAUNCHER={launcher}",
                    f"-DCMAKE_CXX_LINKER_LAUNCHER={launcher}", *options], cwd=ROOT, check=True, stdout=subprocess.DEVNULL)


def read_steps(log):
    rows = (line.split("\t") for line in log.read_text(encoding="utf-8").splitlines())
    return sorted(((float(seconds), output) for seconds, output in rows), reverse=True)


def main(arguments):
    if arguments[:1] == ["--step"]:
        return run_step(arguments[1], arguments[2:])
    if not arguments or arguments[0] not in TARGETS:
        sys.exit(f"measure_build.py: expected {' or '.join(TARGETS)}, got {' '.join(arguments) or 'nothing'}")
    with_tests, targets = TARGETS[arguments[0]]
    log = BUILD / "steps.tsv"
    configure(with_tests, arguments[1:], log)
    jobs = subprocess.run([ROOT / "scripts/build_jobs.sh"], check=True, stdout=subprocess.PIPE, text=True).stdout.strip()
    start, used = time.monotonic(), processor_seconds()
    subprocess.run(["cmake", "--build", BUILD, "--parallel", jobs, "--target", *targets], check=True,
                   env={**os.environ, "CCACHE_DISABLE": "1"})
    used, elapsed, steps = processor_seconds() - used, time.monotonic() - start, read_steps(log)
    for seconds, output in steps[:SHOWN]:
        print(f"{seconds:6.1f} s  {output}")
    print(f"{arguments[0]}: {len(steps)} compilations and links, {used / 60:.1f} minutes of processor time, "
          f"{elapsed / 60:.1f} minutes with {jobs} jobs")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
