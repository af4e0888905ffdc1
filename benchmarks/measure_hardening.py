#!/usr/bin/env python3
"""Measures the cost of the release build's hardening (cmake/DuetHardening.cmake): the same programs
built with it and without, in turn.

    benchmarks/measure_hardening.py build/release [--rounds 5] [--calls 2000]

Builds the programs without it in build/unhardened. Prints the table of compare_builds.py for kernels and
clean-up (before: without), then the processor time of either server for a clip of 45 frames under
eight callers. Other programs on the machine disturb processor time less than waiting times.
"""

import argparse
import os
import pathlib
import re
import statistics
import subprocess
import tempfile
import time

from compare_builds import compare
from load_tool import run_load

SOURCE = pathlib.Path(__file__).resolve().parent.parent
UNHARDENED = SOURCE / "build/unhardened"
BENCHMARKS = ("kernel_benchmark", "solver_benchmark")
TICKS = os.sysconf("SC_CLK_TCK")


def build_unhardened(jobs):
    subprocess.run(["scripts/configure.sh", "release", "-B", UNHARDENED, "-DDUET_HARDENING=OFF",
                    "-DDUET_BUILD_TESTS=OFF", "-DDUET_BUILD_BENCHMARKS=ON"], cwd=SOURCE, check=True,
                   stdout=subprocess.DEVNULL)
    subprocess.run(["cmake", "--build", UNHARDENED, "--parallel", jobs, "--target", "duet-server",
                    *BENCHMARKS], cwd=SOURCE, check=True)


class Server:
    """A server that keeps running between its turns."""

    def __init__(self, build, folder):
        self._log = folder / f"{build.name}.log"
        with self._log.open("w", encoding="utf-8") as file:
            self._process = subprocess.Popen(
                [build / "bin/duet-server", "--listen", "127.0.0.1:0", "--metrics-listen", "off",
                 "--log-success-ratio", "0"], stderr=file)
        self.port = None
        while self.port is None:
            if self._process.poll() is not None:
                raise SystemExit(self._log.read_text(encoding="utf-8"))
            found = re.search(r'"event":"serving".*?"port":(\d+)',
                              self._log.read_text(encoding="utf-8"))
            self.port = found and found[1]
            time.sleep(0.02)

    def milliseconds_a_call(self, build, calls):
        """Processor time of the server while duet-load of `build` has so many calls answered."""
        before = self._processor_seconds()
        failed = run_load(build, f"127.0.0.1:{self.port}", "--callers", "8", "--calls", calls,
                          "--warm-up", "0")["failed"]
        if failed:
            raise SystemExit(f"calls failed: {failed}")
        return 1000 * (self._processor_seconds() - before) / calls

    def _processor_seconds(self):
        stat = pathlib.Path(f"/proc/{self._process.pid}/stat").read_text(encoding="utf-8")
        fields = stat.rsplit(")", 1)[1].split()
        return (int(fields[11]) + int(fields[12])) / TICKS

    def stop(self):
        self._process.terminate()
        self._process.wait()


def measure_servers(build, rounds, calls):
    """Milliseconds of processor time for a call, of each round: (without, with)."""
    servers = []
    with tempfile.TemporaryDirectory() as folder:
        try:
            for each in (UNHARDENED, build):
                servers.append(Server(each, pathlib.Path(folder)))
            for server in servers:
                server.milliseconds_a_call(build, calls // 4)  # the warm-up
            return [tuple(server.milliseconds_a_call(build, calls) for server in servers)
                    for _ in range(rounds)]
        finally:
            for server in servers:
                server.stop()


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("build", type=pathlib.Path, help="a release build, hardened as it is by default")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--calls", type=int, default=2000, help="to either server in each round")
    arguments = parser.parse_args()
    build_unhardened(os.environ.get("JOBS", "2"))
    for name in BENCHMARKS:
        compare(UNHARDENED / "benchmarks" / name, arguments.build / "benchmarks" / name,
                arguments.rounds)
    rounds = measure_servers(arguments.build.resolve(), arguments.rounds, arguments.calls)
    ratios = [after / before for before, after in rounds]
    without, hardened = (statistics.median(column) for column in zip(*rounds))
    print(f"server, processor ms a clip: {without:.3f} without, {hardened:.3f} with, ratio "
          f"{statistics.median(ratios):.3f}; rounds' ratios {min(ratios):.3f} to {max(ratios):.3f}")


if __name__ == "__main__":
    main()
