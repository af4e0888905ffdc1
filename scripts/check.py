#!/usr/bin/env python3
"""Runs the checks of scripts/checks.tsv, configuring and building build/release first where one needs it.

    scripts/check.py [NAME...]       runs every check, or only these; continues after a failure, ends with a table
    scripts/check.py --quick         runs the checks of `make test`; stops at the first failure
    scripts/check.py --write-guide   writes the table in docs/guides/checks.md
"""

import csv
import os
import pathlib
import shlex
import subprocess
import sys
import time
import typing

ROOT = pathlib.Path(__file__).resolve().parent.parent
GUIDE = ROOT / "docs/guides/checks.md"
BUILD = "build/release"
NEEDS = ("nothing", "configure", "build")  # each includes those before it


class Check(typing.NamedTuple):
    name: str
    needs: str
    in_make_test: str  # yes, no, or the command that `make test` runs instead
    command: str
    promise: str

    @property
    def quick_command(self):
        """The command of `make test`; None: the check is not part of it."""
        return {"yes": self.command, "no": None}.get(self.in_make_test, self.in_make_test)


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
        quick = (check.in_make_test if check.in_make_test in ("yes", "no")
                 else f"`{check.in_make_test.removeprefix('scripts/')}`")
        yield f"| `{check.name}` | `{command}` | {check.promise} | {quick} |"


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


def run(commands, stop_at_failure):
    """Runs (check, command) pairs in order. Returns name -> (passed, seconds)."""
    results, done = {}, 1
    for check, command in commands:
        for need in NEEDS[done:NEEDS.index(check.needs) + 1]:
            if not prepare(need):
                sys.exit(f"check.py: {need} failed")
            done += 1
        start = time.monotonic()
        passed = step(check.name, command)
        results[check.name] = passed, time.monotonic() - start
        if stop_at_failure and not passed:
            break
    return results


def main(arguments):
    checks = read_checks()
    if arguments == ["--write-guide"]:
        write_guide(checks)
        return 0
    if arguments == ["--quick"]:
        results = run([(check, check.quick_command) for check in checks if check.quick_command],
                      stop_at_failure=True)
        return 0 if all(passed for passed, _ in results.values()) else 1
    if unknown := set(arguments) - {check.name for check in checks}:
        sys.exit(f"check.py: expected names of scripts/checks.tsv, got {' '.join(sorted(unknown))}")
    results = run([(check, check.command) for check in checks
                   if not arguments or check.name in arguments], stop_at_failure=False)
    print()
    for name, (passed, seconds) in results.items():
        print(f"{name:18} {'ok' if passed else 'FAILED':7} {seconds:5.0f} s")
    return 0 if all(passed for passed, _ in results.values()) else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
