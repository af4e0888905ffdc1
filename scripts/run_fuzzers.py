#!/usr/bin/env python3
"""Runs built fuzzers and reports their results; scripts/fuzz.sh calls it.

    scripts/run_fuzzers.py [--seconds N] [--jobs N] BUILD_FOLDER TARGET...

Each target gets N seconds of CPU time, even on a busy machine. Findings are written to
BUILD_FOLDER/findings/TARGET/, and inputs that reach new code to BUILD_FOLDER/corpus/TARGET/ for the next run. An
input that takes more than a second of CPU time is a finding too.
"""

import argparse
import concurrent.futures
import dataclasses
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import threading
import time

FUZZ_FOLDER = pathlib.Path("tests/fuzz")
MOST_FINDINGS = 3  # for each target and run: more are usually the same finding
SLOW_SECONDS = 1
# libFuzzer measures wall time, so this is generous for a busy machine.
HANG_SECONDS = 60
LOOK_SECONDS = 0.05
LONGEST_INPUT = 32768
MEMORY_MIB = 2048
# The largest allocation that any of these inputs justifies.
PIECE_MIB = 64
PIECES_MIB = {"batch_journal": 600}  # an offset for each item up to the last one


@dataclasses.dataclass
class Outcome:
    target: str
    runs: int = 0
    edges: int = 0
    seconds: float = 0
    findings: int = 0



def read_output(text):
    """The number of inputs and of covered edges in libFuzzer's output."""
    runs = re.search(r"^stat::number_of_executed_units: (\d+)", text, re.MULTILINE)
    counts = re.findall(r"^#(\d+)\s.* cov: (\d+) ", text, re.MULTILINE)
    last = int(counts[-1][0]) if counts else 0
    return int(runs[1]) if runs else last, int(counts[-1][1]) if counts else 0


def processor_seconds(pid):
    """The CPU seconds of a running process."""
    fields = pathlib.Path(f"/proc/{pid}/stat").read_text(encoding="utf-8").rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def run(command, environment, seconds=None):
    """Runs a command and stops it after `seconds` of CPU time with libFuzzer's signal. Returns its exit
    status, its standard error and its CPU seconds."""
    with tempfile.TemporaryFile() as written:
        process = subprocess.Popen(command, env=environment, stdout=subprocess.DEVNULL,
                                   stderr=written)
        signalled = False
        while True:
            pid, status, usage = os.wait4(process.pid, 0 if seconds is None else os.WNOHANG)
            if pid:
                break
            if not signalled and processor_seconds(process.pid) >= seconds:
                process.send_signal(signal.SIGUSR1)
                signalled = True
            time.sleep(LOOK_SECONDS)
        process.returncode = os.waitstatus_to_exitcode(status)
        written.seek(0)
        text = written.read().decode(errors="replace")
    return process.returncode, text, usage.ru_utime + usage.ru_stime


class Fuzzer:
    def __init__(self, build, target):
        self.target = target
        self.program = str(build / "fuzz" / f"fuzz_{target}")
        self.learnt = build / "corpus" / target
        self.findings = build / "findings" / target
        self.learnt.mkdir(parents=True, exist_ok=True)
        self.findings.mkdir(parents=True, exist_ok=True)
        # Protobuf, gRPC and abseil are built without sanitizers and do not mark what they put into
        # containers.
        self.environment = dict(os.environ, UBSAN_OPTIONS="print_stacktrace=1",
                                ASAN_OPTIONS="detect_container_overflow=0")

    def command(self):
        folders = [self.learnt] + [FUZZ_FOLDER / kind / self.target
                                   for kind in ("corpus", "regressions")]
        dictionary = FUZZ_FOLDER / "dictionaries" / f"{self.target}.dict"
        return [self.program, "-print_final_stats=1", f"-timeout={HANG_SECONDS}",
                f"-report_slow_units={SLOW_SECONDS}", f"-rss_limit_mb={MEMORY_MIB}",
                f"-malloc_limit_mb={PIECES_MIB.get(self.target, PIECE_MIB)}",
                f"-max_len={LONGEST_INPUT}", f"-artifact_prefix={self.findings}/",
                *([f"-dict={dictionary}"] if dictionary.exists() else []),
                *(str(folder) for folder in folders if folder.is_dir())]

    def fuzz(self, seconds):
        outcome = Outcome(self.target)
        before = set(self.findings.iterdir())
        while outcome.seconds < seconds and outcome.findings < MOST_FINDINGS:
            status, text, used = run(self.command(), self.environment, seconds - outcome.seconds)
            runs, edges = read_output(text)
            outcome.runs += runs
            outcome.edges = max(outcome.edges, edges)
            outcome.seconds += used
            if status == 0:
                break
            outcome.findings += 1
            print(text[-6000:])
        slow = [path for path in set(self.findings.iterdir()) - before
                if path.name.startswith("slow-unit-")]
        outcome.findings += sum(self.is_slow(path) for path in slow)
        return outcome

    def is_slow(self, path):
        """Whether an input is slow in CPU time too; if not, its file is removed."""
        _, _, nothing = run([self.program, "-runs=0"], self.environment)
        _, _, used = run([self.program, str(path)], self.environment)
        if used - nothing > SLOW_SECONDS:
            print(f"{path}: takes {used - nothing:.1f} s")
            return True
        path.unlink()
        return False


def main():
    parser = argparse.ArgumentParser(description="Runs built fuzzers.")
    parser.add_argument("--seconds", type=float, default=60)
    parser.add_argument("--jobs", type=int, default=1, help="targets in parallel")
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("targets", nargs="+")
    options = parser.parse_args()
    one_tells = threading.Lock()

    def fuzz(target):
        begin = time.monotonic()
        outcome = Fuzzer(options.build, target).fuzz(options.seconds)
        with one_tells:
            print(f"{target}: {outcome.runs} inputs, {outcome.edges} edges, "
                  f"{outcome.seconds:.0f} s of CPU time in {time.monotonic() - begin:.0f} s, "
                  f"{outcome.findings} findings", flush=True)
        return outcome.findings

    with concurrent.futures.ThreadPoolExecutor(options.jobs) as jobs:
        return 1 if sum(jobs.map(fuzz, options.targets)) else 0


if __name__ == "__main__":
    sys.exit(main())
