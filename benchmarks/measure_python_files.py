#!/usr/bin/env python3
"""Measures reading motion files in Python: measure_python_files.py BUILD [--files COUNT]

Reads motions of 300 frames with duet_motion.read_motion, COUNT times in each way, and prints two tables: one
format in every way (a process for each file, one persistent process, the extension module, four threads),
and every format by the process and by the extension module in turn.
"""

import argparse
import concurrent.futures
import importlib
import os
import pathlib
import statistics
import sys
import tempfile
import time

SOURCE = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(SOURCE / "client" / "python"))

import duet_motion as duet  # noqa: E402  pylint: disable=wrong-import-position
from duet_motion import _file_extension, _program  # noqa: E402  pylint: disable=wrong-import-position

FRAMES = 300
NAMES = ("motion.bvh", "motion.glb", "motion.gltf", "motion.csv", "motion.json", "motion.npy",
         "pair.json", "pair.glb", "pair.txt")


def elapsed(read):
    begin = time.perf_counter()
    read()
    return 1000 * (time.perf_counter() - begin)


def in_threads(read, count):
    """Milliseconds for each read in four threads."""
    def read_all():
        with concurrent.futures.ThreadPoolExecutor(4) as pool:
            for done in [pool.submit(read) for _ in range(count)]:
                done.result()
    return elapsed(read_all) / count


def with_program(read):
    """`read` by the program instead of the extension module."""
    def instead():
        kept, _file_extension.missing = _file_extension.missing, "not used"
        try:
            read()
        finally:
            _file_extension.missing = kept
    return instead


def once(read):
    """`read` by a process of its own."""
    def instead():
        kept, _program._run = _program._run, _program._run_once  # pylint: disable=protected-access
        try:
            read()
        finally:
            _program._run = kept  # pylint: disable=protected-access
    return instead


def medians(ways, count):
    """The median milliseconds of each way. The ways take turns, so that other load meets all of them."""
    spent = [[] for _ in ways]
    for _ in range(count):
        for way, times in zip(ways, spent):
            times.append(elapsed(way))
    return [statistics.median(times) for times in spent]


def reader(path):
    options = {"frame_rate_hz": 30} if path.suffix == ".npy" else {}
    return lambda: duet.read_motion(path, **options)


def write_samples(folder):
    """A motion of 300 frames, alone and as a pair, in every format."""
    motion = duet.read_motion(SOURCE / "samples" / "salsa.bvh").frames(0, FRAMES)
    assert motion.frame_count == FRAMES
    for name in NAMES:
        duet.write_motion(folder / name, motion, motion if name.startswith("pair") else None)


def print_ways(read, count):
    spawned, kept, extension = medians((once(with_program(read)), with_program(read), read), count)
    print(f"| motion.bvh, {FRAMES} frames, {count} times | ms a file |\n|---|---|")
    print(f"| a process for each file | {spawned:.1f} |")
    print(f"| one persistent process | {kept:.1f} |")
    _file_extension.missing = "not used"
    print(f"| the same, four threads | {in_threads(read, count):.1f} |")
    _file_extension.missing = ""
    print(f"| the extension module | {extension:.2f} |")
    print(f"| the same, four threads | {in_threads(read, count):.2f} |")


def print_formats(folder, count):
    print(f"\n| {FRAMES} frames, ms a file | persistent process | extension module |\n|---|---|---|")
    for name in NAMES:
        read = reader(folder / name)
        kept, extension = medians((with_program(read), read), count)
        print(f"| {name} | {kept:.1f} | {extension:.2f} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("build", type=pathlib.Path, help="such as build/release")
    parser.add_argument("--files", type=int, default=200)
    options = parser.parse_args()
    build = options.build.resolve()
    os.environ["DUET_PROGRAM"] = str(build / "bin" / "duet")
    duet.__path__.append(str(build / "python" / "duet_motion"))
    importlib.reload(_file_extension)
    if _file_extension.missing:
        sys.exit(f"{_file_extension.missing}: expected the extension module; build duet_python_module")
    with tempfile.TemporaryDirectory() as folder:
        write_samples(pathlib.Path(folder))
        print_ways(reader(pathlib.Path(folder) / "motion.bvh"), options.files)
        print_formats(pathlib.Path(folder), options.files)


if __name__ == "__main__":
    main()
