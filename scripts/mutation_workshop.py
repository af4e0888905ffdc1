"""A copy of the tree in which mutate.py compiles a mutation and runs the tests against it."""

import math
import os
import pathlib
import re
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
             # Quick to compile; an index past a vector's end is caught where it happens.
             "-DCMAKE_CXX_FLAGS_DEBUG=-O0 -D_GLIBCXX_ASSERTIONS")
BUILD_LIMIT_S = 900
BASELINE_LIMIT_S = 3600  # a loaded machine may take long; nothing is judged by it
MEMORY_LIMIT = 4 << 30  # bytes of address space: a mutation may allocate without end
# A mutation that computes without end is stopped by processor time, which does not depend on what
# else the machine does; one that waits without end by the clock, set so wide that load alone
# does not reach it.
CPU_ALLOWANCE_S, WALL_ALLOWANCE_S, TIMES_LONGER = 10, 60, 5
SUITE = re.compile(r"^(?:TYPED_)?TEST(?:_F|_P)?\((\w+)", re.MULTILINE)


class TestRun(typing.NamedTuple):
    """A test program, or those of its suites that `filter` (GoogleTest's) lets through."""
    program: str
    filter: str = "*"


def tests_for(targets, library, file, root=build_tree.ROOT):
    """What judges a file: the tests of its own folder in tests/, then all the others of programs
    that link its library, or that start a program which links it."""
    reach = {name: (name, *target.runs) for name, target in targets.items()
             if not target.is_library and "GTest::gtest_main" in target.links}
    users = [name for name, linked in reach.items()
             if all(build_tree.is_torch_free(targets, item) for item in linked)
             and any(library in build_tree.closure(targets, item) for item in linked)]
    own = own_tests(targets, users, file, root)
    whole = {run.program for run in own if run == TestRun(run.program)}
    parts = {run.program for run in own} - whole
    others = [name for name in users if name in parts or name not in whole
              and any(library in targets[item].links for item in reach[name])]
    return own, [TestRun(name) for name in sorted(others)]


def own_tests(targets, users, file, root):
    """Of the programs `users`, the suites whose sources are in the folder of tests/ that mirrors
    the file's, or the nearest above it that has any."""
    room = pathlib.PurePosixPath(file).parent
    mirror = room.relative_to("model") if room.parts[0] == "model" else room
    for folder in (mirror, *mirror.parents):
        found = [TestRun(name, suites_in(targets[name].sources, "tests" / folder, root))
                 for name in users
                 if any(pathlib.PurePosixPath(source).parent == "tests" / folder
                        for source in targets[name].sources)]
        if found and folder.parts:
            return sorted(found)
    return []


def suites_in(sources, folder, root):
    """A filter for the suites of the sources in a folder; "*" where the program has no others."""
    inside = [source for source in sources if pathlib.PurePosixPath(source).parent == folder]
    if len(inside) == len(sources):
        return "*"
    suites = {suite for source in inside
              for suite in SUITE.findall((root / source).read_text(encoding="utf-8"))}
    # Suites with parameters or types have a name in front or behind.
    return ":".join(f"{suite}.*:*/{suite}.*:{suite}/*" for suite in sorted(suites))


class Limits(typing.NamedTuple):
    """What a command may take: seconds by the clock, seconds of processor time, bytes of memory.
    The last two are for each process that it starts."""
    wall_s: float
    cpu_s: typing.Optional[float] = None
    memory: typing.Optional[int] = None


class Workshop:
    def __init__(self, folder, origin):
        self.origin = origin
        self.source_dir, self.build_dir = folder / "source", folder / "build"
        self.tests, self.limits = {}, {}

    def prepare(self):
        """Brings the copy up to date, and configures it."""
        copy_tree(self.origin, self.source_dir)
        subprocess.run(["cmake", "-S", self.source_dir, "-B", self.build_dir, *CONFIGURE],
                       check=True, stdout=subprocess.DEVNULL)

    def build_and_time(self, runs):
        """Builds the tests as they are. They must pass; how long they take sets their limits."""
        programs = sorted({run.program for run in runs})
        environment = {**os.environ, "CCACHE_BASEDIR": str(self.source_dir.parent),
                       "CCACHE_NOHASHDIR": "1"}
        subprocess.run(["ninja", "-C", self.build_dir, *programs], check=True, env=environment,
                       stdout=subprocess.DEVNULL)
        self.tests = build_tree.read_tests(self.build_dir)
        for run in runs:
            start, cpu_start = time.monotonic(), children_cpu_s()
            if self.run(run, Limits(BASELINE_LIMIT_S, memory=MEMORY_LIMIT)) != "passed":
                raise SystemExit(f"{run.program} fails as it is: mend it first")
            self.limits[run] = Limits(
                WALL_ALLOWANCE_S + TIMES_LONGER * (time.monotonic() - start),
                CPU_ALLOWANCE_S + TIMES_LONGER * (children_cpu_s() - cpu_start), MEMORY_LIMIT)

    def attempt(self, file, text, own, others):
        """Puts a mutated file in place, builds, tests: the outcome, and who noticed."""
        self.write(file, text)
        for runs in filter(None, (own, others)):
            if not self.build(sorted({run.program for run in runs})):
                return {"outcome": "invalid"}
            for run in runs:
                result = self.run(run, self.limits[run])
                if result != "passed":
                    return {"outcome": "caught" if result == "failed" else "timeout",
                            "by": run.program, "own": run in own}
        return {"outcome": "survived"}

    def restore(self, file, text):
        self.write(file, text)

    def write(self, file, text):
        (self.source_dir / file).write_text(text, encoding="utf-8")

    def build(self, programs):
        # A mutation is compiled once: a compiler cache would only fill up.
        return limited(["ninja", "-C", self.build_dir, *programs], Limits(BUILD_LIMIT_S),
                       {**os.environ, "CCACHE_DISABLE": "1"}) == "passed"

    def run(self, run, limits):
        command, environment, _ = self.tests[run.program]
        return limited([*command, f"--gtest_filter={run.filter}", "--gtest_fail_fast",
                        "--gtest_brief=1"], limits, {**os.environ, **environment})


def children_cpu_s():
    """Processor time of all processes that have ended, those that they started included."""
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def limited(command, limits, environment):
    """Runs a command with all that it starts: "passed", "failed" or "timeout"."""
    def limit():
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        if limits.memory:
            resource.setrlimit(resource.RLIMIT_AS, (limits.memory, limits.memory))
        if limits.cpu_s:
            seconds = math.ceil(limits.cpu_s)  # SIGXCPU at the first, SIGKILL at the second
            resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds + 5))
    process = subprocess.Popen(list(map(str, command)), env=environment, stdin=subprocess.DEVNULL,
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                               start_new_session=True, preexec_fn=limit)
    try:
        code = process.wait(limits.wall_s)
        return {0: "passed", -signal.SIGXCPU: "timeout"}.get(code, "failed")
    except subprocess.TimeoutExpired:
        return "timeout"
    finally:
        if process.poll() is None:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()


def copy_tree(origin, copy):
    """Makes `copy` equal to `origin`, touching only files that differ: the rest is not rebuilt."""
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
