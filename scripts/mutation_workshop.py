"""A copy of the tree in which mutate.py compiles a mutation and runs the tests against it."""

import math
import os
import resource
import shutil
import signal
import subprocess
import time
import typing

import build_tree

LEFT_OUT = {".git", "build", "out", "__pycache__"}
CONFIGURE = ("-G", "Ninja", "-DCMAKE_BUILD_TYPE=Debug", "-DDUET_BUILD_TESTS=ON",
             "-DDUET_BUILD_BENCHMARKS=OFF",
             # Compiles quickly, and catches an index past a vector's end where it happens.
             "-DCMAKE_CXX_FLAGS_DEBUG=-O0 -D_GLIBCXX_ASSERTIONS")


class Limits(typing.NamedTuple):
    """Limits of a command: seconds of wall time and, for each process, of CPU time; bytes of address space."""
    wall_s: float
    cpu_s: typing.Optional[float] = None
    memory: typing.Optional[int] = None


BUILD_LIMITS = Limits(900)
BASELINE_LIMITS = Limits(3600, memory=4 << 30)  # a loaded machine may take long
# Endless computation hits the CPU limit, which other load does not move. Endless waiting hits the wall limit,
# which is too wide for load to reach.
CPU_ALLOWANCE_S, WALL_ALLOWANCE_S, TIMES_LONGER = 10, 60, 5


class TestRun(typing.NamedTuple):
    """A test program, or those of its suites that GoogleTest's `filter` selects."""
    program: str
    filter: str = "*"


class Workshop:
    def __init__(self, folder, origin):
        self.origin, self.source_dir, self.build_dir = origin, folder / "source", folder / "build"
        self.tests, self.limits, self.mutated = {}, {}, None
        # Workshops share compiled objects, and a file that is restored compiles from the cache.
        self.environment = {**os.environ, "CCACHE_BASEDIR": str(folder), "CCACHE_NOHASHDIR": "1"}

    def prepare(self):
        """Brings the copy up to date, and configures it."""
        copy_tree(self.origin, self.source_dir)
        subprocess.run(["cmake", "-S", self.source_dir, "-B", self.build_dir, *CONFIGURE],
                       check=True, stdout=subprocess.DEVNULL)

    def build_and_time(self, runs):
        """Builds the tests as they are. They must pass; their times set the limits."""
        subprocess.run(self.ninja(runs), check=True, env=self.environment, stdout=subprocess.DEVNULL)
        self.tests = build_tree.read_tests(self.build_dir)
        for run in runs:
            start, cpu_start = time.monotonic(), children_cpu_s()
            if self.run(run, BASELINE_LIMITS) != "passed":
                raise SystemExit(f"{run.program}: expected the unchanged tests to pass, got a failure")
            self.limits[run] = Limits(
                WALL_ALLOWANCE_S + TIMES_LONGER * (time.monotonic() - start),
                CPU_ALLOWANCE_S + TIMES_LONGER * (children_cpu_s() - cpu_start), BASELINE_LIMITS.memory)

    def attempt(self, file, text, tiers):
        """Builds and tests with a mutated file: the outcome, and the program that noticed."""
        if self.mutated not in (None, file):
            shutil.copyfile(self.origin / self.mutated, self.source_dir / self.mutated)
        self.mutated = file
        (self.source_dir / file).write_text(text, encoding="utf-8")
        for tier in filter(None, tiers):
            if limited(self.ninja(tier), BUILD_LIMITS, self.environment) != "passed":
                return {"outcome": "invalid"}
            for run in tier:
                result = self.run(run, self.limits[run])
                if result != "passed":
                    return {"outcome": "caught" if result == "failed" else "timeout",
                            "by": run.program, "own": tier is tiers[0]}
        return {"outcome": "survived"}

    def ninja(self, runs):
        return ["ninja", "-C", self.build_dir, *sorted({run.program for run in runs})]

    def run(self, run, limits):
        command, environment, _ = self.tests[run.program]
        return limited([*command, f"--gtest_filter={run.filter}", "--gtest_fail_fast",
                        "--gtest_brief=1"], limits, {**os.environ, **environment})


def children_cpu_s():
    """CPU time of all processes that have ended, including those that they started."""
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def limited(command, limits, environment):
    """Runs a command with all that it starts: "passed", "failed" or "timeout"."""
    bounds = ["prlimit", "--core=0", *([f"--as={limits.memory}"] if limits.memory else []),
              # SIGXCPU at the first, SIGKILL at the second
              *([f"--cpu={math.ceil(limits.cpu_s)}:{math.ceil(limits.cpu_s) + 5}"] if limits.cpu_s else [])]
    code = subprocess.run(["timeout", "--signal=KILL", str(limits.wall_s), *bounds, *map(str, command)],
                          env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                          stderr=subprocess.DEVNULL, check=False).returncode
    return {0: "passed", -signal.SIGXCPU: "timeout", -signal.SIGKILL: "timeout"}.get(code, "failed")


def copy_tree(origin, copy):
    """Makes `copy` equal to `origin`. Equal files stay untouched, so that they are not rebuilt."""
    copy.mkdir(parents=True, exist_ok=True)
    names = {entry.name for entry in os.scandir(origin)} - LEFT_OUT
    for entry in list(os.scandir(copy)):
        if entry.name not in names:
            shutil.rmtree(entry.path) if entry.is_dir() else os.unlink(entry.path)
    for name in names:
        source, target = origin / name, copy / name
        if source.is_dir():
            copy_tree(source, target)
        elif not target.exists() or source.read_bytes() != target.read_bytes():
            shutil.copyfile(source, target)
            shutil.copymode(source, target)
