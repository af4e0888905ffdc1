#!/usr/bin/env python3
"""Runs the checks of scripts/checks.tsv, configuring and building build/release first where one needs it.

    scripts/check.py [NAME...]             runs every check, or only these; continues after a failure, ends with a table
    scripts/check.py --prepared NAME...    runs these with a build/release that is configured and built
    scripts/check.py --test                what `make test` does: builds everything, runs the quick checks and every test
    scripts/check.py --write-guide         writes the table in docs/guides/checks.md
"""

import csv
import os
import pathlib
import shlex
import subprocess
import sys
import tempfile
import time
import typing

import build_tree

ROOT = pathlib.Path(__file__).resolve().parent.parent
GUIDE = ROOT / "docs/guides/checks.md"
BUILD = "build/release"
NEEDS = ("nothing", "configure", "build")  # each includes those before it
IN_MAKE_TEST = ("before", "beside", "no")  # the tests
# Six half cores keep two cores busy, because even tests that compute wait for the processes that they start. A test takes two half
# cores, or one if it mostly waits (duet_share_cores in cmake/DuetTargets.cmake).
TESTS = f"ctest --test-dir {BUILD} --output-on-failure --parallel 6"


class Check(typing.NamedTuple):
    name: str
    needs: str
    in_make_test: str
    command: str
    promise: str


def read_checks(path=ROOT / "scripts/checks.tsv"):
    lines = path.read_text(encoding="utf-8").splitlines()
    rows = csv.reader((line for line in lines if line and not line.startswith("#")),
                      delimiter="\t", quoting=csv.QUOTE_NONE)
    return [Check(*row) for row in rows]


def guide_table(checks):
    """The table of docs/guides/checks.md, one line for each check."""
    yield "| check | script | promise | in `make test` |"
    yield "|---|---|---|---|"
    for check in checks:
        command = check.command.removeprefix("scripts/")
        yield f"| `{check.name}` | `{command}` | {check.promise} | {check.in_make_test} |"


def write_guide(checks):
    """Replaces the one table of the guide."""
    lines = GUIDE.read_text(encoding="utf-8").splitlines()
    first, last = (found for numbers in [[n for n, line in enumerate(lines) if line[:1] == "|"]]
                   for found in (numbers[0], numbers[-1]))
    lines[first:last + 1] = guide_table(checks)
    GUIDE.write_text("\n".join(lines) + "\n", encoding="utf-8")


def prepare(need):
    """Configures or builds the release build. Returns whether that succeeded."""
    if need == "configure":
        werror = "ON" if os.environ.get("CI") else "OFF"
        return step("configure", f"scripts/configure.sh release -DDUET_BUILD_TESTS=ON "
                                 f"-DDUET_BUILD_BENCHMARKS=ON -DDUET_WARNINGS_AS_ERRORS={werror}")
    return step("build", f"scripts/build.sh {BUILD}")


def step(name, command):
    """Runs a command and prints how long it took. Returns whether it succeeded."""
    print(f"== {name}: {command}", flush=True)
    start = time.monotonic()
    passed = subprocess.run(shlex.split(command), cwd=ROOT, check=False).returncode == 0
    print(f"== {name}: {'ok' if passed else 'FAILED'}, {time.monotonic() - start:.0f} s", flush=True)
    return passed


def run(checks, stop_at_failure=False, prepared="nothing"):
    """Runs checks in order. Returns name -> (passed, seconds)."""
    results, done = {}, NEEDS.index(prepared) + 1
    for check in checks:
        for need in NEEDS[done:NEEDS.index(check.needs) + 1]:
            if not prepare(need):
                sys.exit(f"check.py: {need} failed")
            done += 1
        start = time.monotonic()
        passed = step(check.name, check.command)
        results[check.name] = passed, time.monotonic() - start
        if stop_at_failure and not passed:
            break
    return results


def all_passed(results):
    return all(passed for passed, _ in results.values())


def test(checks):
    """Runs the quick checks and every test. Returns whether all passed.

    Tests mostly wait. Therefore, the checks that take long run beside them: at a lower priority and in half of the
    jobs, so that tests come first. Their output follows that of the tests."""
    start = time.monotonic()
    if not all_passed(run([check for check in checks if check.in_make_test == "before"], stop_at_failure=True)):
        return False
    print(f"== Built and checked in {time.monotonic() - start:.0f} s; CTest prints the time of the tests.", flush=True)
    beside = [check.name for check in checks if check.in_make_test == "beside"]
    with tempfile.TemporaryFile("w+", encoding="utf-8") as output:
        others = subprocess.Popen(["nice", sys.executable, __file__, "--prepared", *beside], cwd=ROOT, stdout=output,
                                  stderr=subprocess.STDOUT,
                                  env={**os.environ, "JOBS": str((build_tree.default_jobs() + 1) // 2)})
        passed = step("tests", TESTS)
        others_passed = others.wait() == 0
        output.seek(0)
        print(output.read(), flush=True)
    return passed and others_passed


def main(arguments):
    checks = read_checks()
    if arguments == ["--write-guide"]:
        write_guide(checks)
        return 0
    if arguments == ["--test"]:
        return 0 if test(checks) else 1
    prepared = "build" if arguments[:1] == ["--prepared"] else "nothing"
    names = [name for name in arguments if name != "--prepared"]
    if unknown := set(names) - {check.name for check in checks}:
        sys.exit(f"check.py: expected names of scripts/checks.tsv, got {' '.join(sorted(unknown))}")
    results = run([check for check in checks if not arguments or check.name in names], prepared=prepared)
    print()
    for name, (passed, seconds) in results.items():
        print(f"{name:18} {'ok' if passed else 'FAILED':7} {seconds:5.0f} s")
    return 0 if all_passed(results) else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
