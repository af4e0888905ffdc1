#!/usr/bin/env python3
"""Measures duet-server from its start to its first answer, and its memory then: the median of five
starts.

    benchmarks/measure_start.py build/release
"""
import pathlib
import re
import statistics
import subprocess
import sys
import tempfile
import time

SAMPLE = pathlib.Path(__file__).resolve().parent.parent / "samples/kick.bvh"


def start(build, folder):
    """Seconds until models are served and until the first answer came, resident megabytes then."""
    log = folder / "log"
    begin = time.perf_counter()
    with log.open("w", encoding="utf-8") as file:
        server = subprocess.Popen([build / "bin/duet-server", "--listen", "127.0.0.1:0",
                                   "--metrics-listen", "off"], stderr=file)
    try:
        while not (found := re.search(r'"event":"serving".*?"port":(\d+)',
                                      log.read_text(encoding="utf-8"))):
            if server.poll() is not None:
                raise SystemExit(log.read_text(encoding="utf-8"))
            time.sleep(0.002)
        serving = time.perf_counter() - begin
        subprocess.run([build / "bin/duet", "synthesize", "--server", f"127.0.0.1:{found[1]}",
                        "--leader", SAMPLE, "--label", "kick=1", "--out", folder / "out.npy"],
                       check=True, stdout=subprocess.DEVNULL)
        answered = time.perf_counter() - begin
        status = pathlib.Path(f"/proc/{server.pid}/status").read_text(encoding="utf-8")
        return serving, answered, int(re.search(r"VmRSS:\s+(\d+)", status)[1]) / 1024
    finally:
        server.terminate()
        server.wait()


def main():
    build = pathlib.Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory() as name:
        runs = [start(build, pathlib.Path(name)) for _ in range(5)]
    serving, answered, megabytes = (statistics.median(column) for column in zip(*runs))
    print(f"serving after {serving:.2f} s, first answer after {answered:.2f} s, {megabytes:.0f} MB resident")


if __name__ == "__main__":
    main()
