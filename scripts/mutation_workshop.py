"""A copy of the tree in which mutate.py compiles a mutation and runs the tests against it."""

import os
import pathlib
import resource
import shutil
import signal
import subprocess
import time

import build_tree

LEFT_OUT = {".git", "build", "out", "__pycache__"}
CONFIGURE = ("-G", "Ninja", "-DCMAKE_BUILD_TYPE=Debug", "-DDUET_BUILD_TESTS=ON",
             "-DDUET_BUILD_BENCHMARKS=OFF",
             # Quick to compile; an index past a vector's end is caught where it happens.
             "-DCMAKE_CXX_FLAGS_DEBUG=-O0 -D_GLIBCXX_ASSERTIONS")
BUILD_LIMIT_S = 300
MEMORY_LIMIT = 4 << 30  # bytes of address space: a mutation may allocate without end


def tests_for(targets, library, file):
    """The test programs that judge a file: those of its own folder in tests/, then the others that
    link its library."""
    users = [name for name, target in targets.items()
             if not target.is_library and "GTest::gtest_main" in target.links
             and build_tree.is_torch_free(targets, name)
             and library in build_tree.closure(targets, name)]
    own = own_tests(targets, users, file)
    others = [name for name in users if name not in own and library in targets[name].links]
    return own, sorted(others)


def own_tests(targets, users, file):
    """Of the programs `users`, those with sources in the folder of tests/ that mirrors the file's,
    or the nearest above it that has any."""
    room = pathlib.PurePosixPath(file).parent
    mirror = room.relative_to("model") if room.parts[0] == "model" else room
    for folder in (mirror, *mirror.parents):
        found = [name for name in users
                 if any(pathlib.PurePosixPath(source).parent == "tests" / folder
                        for source in targets[name].sources)]
        if found and folder.parts:
            return sorted(found)
    return []


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

    def build_and_time(self, programs):
        """Builds the tests as they are. They must pass; how long they take sets their limits."""
        environment = {**os.environ, "CCACHE_BASEDIR": str(self.source_dir),
                       "CCACHE_NOHASHDIR": "1"}
        subprocess.run(["ninja", "-C", self.build_dir, *programs], check=True, env=environment,
                       stdout=subprocess.DEVNULL)
        self.tests = build_tree.read_tests(self.build_dir)
        for program in programs:
            start = time.monotonic()
            if self.run(program, limit_s=600) != "passed":
                raise SystemExit(f"{program} fails as it is: mend it first")
            self.limits[program] = 10 + 5 * (time.monotonic() - start)

    def attempt(self, file, text, own, others):
        """Puts a mutated file in place, builds, tests: the outcome, and who noticed."""
        self.write(file, text)
        for programs in filter(None, (own, others)):
            if not self.build(programs):
                return {"outcome": "invalid"}
            for program in programs:
                result = self.run(program, self.limits[program])
                if result != "passed":
                    return {"outcome": "caught" if result == "failed" else "timeout",
                            "by": program, "own": program in own}
        return {"outcome": "survived"}

    def restore(self, file, text):
        self.write(file, text)

    def write(self, file, text):
        (self.source_dir / file).write_text(text, encoding="utf-8")

    def build(self, programs):
        # A mutation is compiled once: a compiler cache would only fill up.
        return limited(["ninja", "-C", self.build_dir, *programs], BUILD_LIMIT_S,
                       {**os.environ, "CCACHE_DISABLE": "1"}) == "passed"

    def run(self, program, limit_s):
        command, environment, _ = self.tests[program]
        return limited([*command, "--gtest_fail_fast", "--gtest_brief=1"], limit_s,
                       {**os.environ, **environment}, memory=MEMORY_LIMIT)


def limited(command, limit_s, environment, memory=None):
    """Runs a command with all that it starts: "passed", "failed" or "timeout"."""
    def limit():
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        if memory:
            resource.setrlimit(resource.RLIMIT_AS, (memory, memory))
    process = subprocess.Popen(list(map(str, command)), env=environment, stdin=subprocess.DEVNULL,
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                               start_new_session=True, preexec_fn=limit)
    try:
        return "passed" if process.wait(limit_s) == 0 else "failed"
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
