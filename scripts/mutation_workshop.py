"""A copy of the tree in which mutate.py compiles a mutation and runs the tests against it."""

import filecmp
import os
import shutil
import subprocess
import time

import build_tree

CONFIGURE = ("-G", "Ninja", "-DCMAKE_BUILD_TYPE=Debug", "-DDUET_BUILD_TESTS=ON", "-DDUET_BUILD_BENCHMARKS=OFF",
             # Compiles quickly, and catches an index past a vector's end where it happens.
             "-DCMAKE_CXX_FLAGS_DEBUG=-O0 -D_GLIBCXX_ASSERTIONS")
MEMORY = 8 << 30  # bytes of address space; LibTorch maps several GB
LONGEST_S = 3600  # of a build, and of the tests as they are
TIMES_LONGER, ALLOWANCE_S = 10, 60  # load does not reach this limit


class Workshop:
    def __init__(self, folder, origin):
        self.origin, self.source_dir, self.build_dir = origin, folder / "source", folder / "build"
        self.tests, self.limit_s, self.mutated = {}, {}, None
        # Workshops share compiled objects, and a file that is restored compiles from the cache.
        self.environment = {**os.environ, "CCACHE_BASEDIR": str(folder), "CCACHE_NOHASHDIR": "1"}

    def prepare(self):
        """Brings the copy up to date, and configures it."""
        listing = subprocess.run(["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
                                 cwd=self.origin, capture_output=True, check=True, text=True).stdout
        for name in filter(None, listing.split("\0")):
            self.copy(name)
        subprocess.run(["cmake", "-S", self.source_dir, "-B", self.build_dir, *CONFIGURE],
                       check=True, stdout=subprocess.DEVNULL)

    def copy(self, name):
        """Copies a file of the tree. An equal one stays untouched, so that nothing is rebuilt."""
        source, target = self.origin / name, self.source_dir / name
        if source.exists() and not (target.exists() and filecmp.cmp(source, target, shallow=False)):
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(source, target)

    def build_and_time(self, programs):
        """Builds the tests as they are. They must pass; their times set the limits."""
        subprocess.run(["ninja", "-C", self.build_dir, *programs], check=True, env=self.environment,
                       stdout=subprocess.DEVNULL)
        self.tests = build_tree.read_tests(self.build_dir)
        for program in programs:
            start = time.monotonic()
            if not self.run(program, LONGEST_S):
                raise SystemExit(f"{program}: expected the unchanged tests to pass, got a failure")
            self.limit_s[program] = ALLOWANCE_S + TIMES_LONGER * (time.monotonic() - start)

    def attempt(self, file, text, programs):
        """Builds and tests with a mutated file: the outcome."""
        if self.mutated:
            self.copy(self.mutated)
        self.mutated = file
        (self.source_dir / file).write_text(text, encoding="utf-8")
        for program in programs:
            if not passes(["ninja", "-C", self.build_dir, program], LONGEST_S, self.environment):
                return "invalid"
            if not self.run(program, self.limit_s[program]):
                return "caught"
        return "survived"

    def run(self, program, limit_s):
        command, environment, _ = self.tests[program]
        return passes(["prlimit", "--core=0", f"--as={MEMORY}", *command, "--gtest_fail_fast", "--gtest_brief=1"],
                      limit_s, {**os.environ, **environment})


def passes(command, limit_s, environment):
    """Runs a command with all that it starts. Returns whether it succeeds within the limit."""
    return subprocess.run(["timeout", "--signal=KILL", str(limit_s), *map(str, command)],
                          env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                          stderr=subprocess.DEVNULL, check=False).returncode == 0
