#!/usr/bin/env python3
"""Measures reading motion files in Python: measure_python_files.py BUILD [--files COUNT]

Reads a sample COUNT times with duet_motion.read_motion: with a process for each file, with one
persistent process, and in four threads.
"""

import argparse
import concurrent.futures
import os
import pathlib
import statistics
import sys
import time

SOURCE = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(SOURCE / "client" / "python"))

import duet_motion as duet  # noqa: E402  pylint: disable=wrong-import-position
from duet_motion import _program  # noqa: E402  pylint: disable=wrong-import-position


def timed(read, count):
    """Milliseconds of each read: the median."""
    spent = []
    for _ in range(count):
        begin = time.perf_counter()
        read()
        spent.append(1000 * (time.perf_counter() - begin))
    return statistics.median(spent)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("build", type=pathlib.Path, help="such as build/release")
    parser.add_argument("--files", type=int, default=200)
    options = parser.parse_args()
    os.environ["DUET_PROGRAM"] = str(options.build.resolve() / "bin" / "duet")
    sample = SOURCE / "samples" / "hug.bvh"

    def read():
        duet.read_motion(sample)

    kept = _program._run  # pylint: disable=protected-access
    _program._run = _program._run_once  # pylint: disable=protected-access
    once = timed(read, options.files)
    _program._run = kept  # pylint: disable=protected-access
    again = timed(read, options.files)
    with concurrent.futures.ThreadPoolExecutor(4) as pool:
        begin = time.perf_counter()
        for done in [pool.submit(read) for _ in range(options.files)]:
            done.result()
        threads = 1000 * (time.perf_counter() - begin) / options.files
    print(f"| {sample.name}, {options.files} times | ms a file |\n|---|---|")
    print(f"| a process for each file | {once:.1f} |")
    print(f"| a process that is kept | {again:.1f} |")
    print(f"| the same, four threads | {threads:.1f} |")


if __name__ == "__main__":
    main()
