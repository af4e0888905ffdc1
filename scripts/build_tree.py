"""Reads a configured build folder: targets with their links, tests, compile commands."""

import concurrent.futures
import dataclasses
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
TORCH_TARGET = "duet_torch"
BATCH = re.compile(r"/Unity/unity_\w+\.cxx$")  # a file of CMake's that includes the sources of a batch
BATCHED = re.compile(r'^#include "(.+)"$', re.MULTILINE)


@dataclasses.dataclass(frozen=True)
class Target:
    name: str
    type: str  # CMake's: STATIC_LIBRARY, EXECUTABLE, ...
    sources: tuple  # relative to the top folder
    public: tuple  # links that its users inherit
    private: tuple

    @property
    def links(self):
        return self.public + self.private


def read_targets(build_dir):
    """The targets of cmake/DuetTargetTable.cmake by name."""
    rows = json.loads((pathlib.Path(build_dir) / "targets.json").read_text(encoding="utf-8"))
    return {row["name"]: Target(row["name"], row["type"], tuple(row["sources"]),
                                tuple(row["public"]), tuple(row["private"]))
            for row in rows}


def closure(targets, name):
    """A target and everything that is linked with it, by name."""
    found, waiting = set(), [name]
    while waiting:
        item = waiting.pop()
        if item not in found:
            found.add(item)
            waiting.extend(targets[item].links if item in targets else ())
    return found


def is_torch_free(targets, name):
    return TORCH_TARGET not in closure(targets, name)


def read_tests(build_dir):
    """CTest's entries: name -> (command, environment, labels)."""
    listing = subprocess.run(["ctest", "--test-dir", str(build_dir), "--show-only=json-v1"],
                             capture_output=True, check=True, text=True).stdout
    tests = {}
    for test in json.loads(listing)["tests"]:
        properties = {item["name"]: item["value"] for item in test.get("properties", ())}
        environment = dict(setting.split("=", 1)
                           for setting in properties.get("ENVIRONMENT", ()) if setting)
        tests[test["name"]] = (test.get("command", []), environment,
                               tuple(properties.get("LABELS", ())))
    return tests


def torch_free_tests(build_dir, label=None):
    """The test programs that do not link LibTorch; with `label`, only those with this label."""
    targets = read_targets(build_dir)
    return sorted(name for name, (_, _, labels) in read_tests(build_dir).items()
                  if name in targets and is_torch_free(targets, name)
                  and (label is None or label in labels))


def compile_commands(build_dir):
    """The project's source files -> their compile commands as words, relative to `build_dir`.

    A file of a batch (cmake/DuetBatches.cmake) gets the command of its batch, with the batch as an include by a flag."""
    database = pathlib.Path(build_dir) / "compile_commands.json"
    commands = {}
    for entry in json.loads(database.read_text(encoding="utf-8")):
        compiled, words = pathlib.Path(entry["directory"], entry["file"]), shlex.split(entry["command"])
        files = [compiled]
        if BATCH.search(compiled.as_posix()):
            files = [compiled.parent / name for name in BATCHED.findall(compiled.read_text(encoding="utf-8"))]
            words += ["-include", str(compiled)]
        for file in (file.resolve() for file in files):
            if file.is_relative_to(ROOT) and file.suffix == ".cc":
                commands[file.relative_to(ROOT).as_posix()] = words
    return commands


def portable_flags(command):
    """Include folders, definitions and the language of a compile command; no precompiled header."""
    kept, words = [], iter(command)
    for word in words:
        if word in ("-isystem", "-I"):
            kept.append(word + next(words))
        elif word.startswith(("-D", "-I", "-std=")):
            kept.append(word)
    return kept


def build_generated_sources(build_dir, jobs):
    """Generates protoc's headers, which sources that use the protocol include."""
    if any(source.endswith(".pb.h") for target in read_targets(build_dir).values()
           for source in target.sources):
        subprocess.run(["cmake", "--build", str(build_dir), "--parallel", str(jobs), "--target",
                        "duet_generated"], check=True, stdout=subprocess.DEVNULL)


def require_configured(build_dir):
    if not (pathlib.Path(build_dir) / "targets.json").is_file():
        sys.exit(f"{build_dir}: expected a configured build folder; run cmake --preset release first "
                 "(scripts/check.py does)")


def run_all(commands, jobs):
    """Runs (name, command, folder) triples, `jobs` at a time.

    Returns the output of the failed ones by name."""
    def run(item):
        name, command, folder = item
        done = subprocess.run(command, capture_output=True, check=False, text=True, cwd=folder)
        return name, done.returncode, done.stdout + done.stderr
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        return {name: output for name, status, output in pool.map(run, commands) if status != 0}


def default_jobs():
    return int(os.environ.get("JOBS") or
               subprocess.run([ROOT / "scripts" / "build_jobs.sh"], capture_output=True,
                              check=True, text=True).stdout)
