#!/usr/bin/env python3
"""Checks with Clang that data guarded by a mutex is used only under it (-Wthread-safety as errors).

Checks every file that includes the annotated mutex, which is the header with the attribute
`capability("mutex")`. Most of the time goes into headers of libraries. Therefore, headers that many files include are precompiled once, and
files of one batch of the build (cmake/DuetBatches.cmake) are read together. Builds only the generated protocol headers.

    scripts/check_thread_safety.py [build folder]     build/release, configured
"""

import collections
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import build_tree
import source_tree

COMPILERS = ("clang++-14", "clang++")
FLAGS = ("-fsyntax-only", "-Wthread-safety", "-Wthread-safety-beta", "-Werror=thread-safety",
         "-Werror=thread-safety-beta")
ANNOTATION = re.compile(r'capability\("mutex"\)', re.IGNORECASE)


def annotated_headers(tree):
    """The headers that declare a mutex with annotations."""
    return {header for header in tree.files(".h")
            if ANNOTATION.search((tree.root / header).read_text(encoding="utf-8"))}


def files_to_check(tree, known):
    mutexes = annotated_headers(tree)
    return [file for file in tree.files(".cc") if file in known and mutexes & tree.reach(file)]


def read_together(files, commands):
    """The files by their compile command: files of a batch share theirs."""
    groups = {}
    for file in files:
        groups.setdefault(tuple(commands[file]), []).append(file)
    return groups


def flags_of_all(groups):
    """The flags of all groups together, because a precompiled header must agree with every file in its definitions."""
    return list(dict.fromkeys(flag for words in groups for flag in build_tree.portable_flags(words)))


def shared_headers(tree, groups):
    """The headers of libraries that several groups include, directly or through the project's headers."""
    counts = collections.Counter(
        header for files in groups.values()
        for header in set().union(*map(tree.reach, files)) if not tree.exists(header))
    return sorted(header for header, count in counts.items() if count > 1)


def precompile(compiler, flags, headers, folder):
    """Precompiles the headers. Returns the file."""
    source, precompiled = folder / "shared.h", folder / "shared.pch"
    source.write_text("".join(f"#include <{header}>\n" for header in headers), encoding="utf-8")
    subprocess.run([compiler, *flags, "-fpch-instantiate-templates", "-x", "c++-header", source, "-o", precompiled],
                   check=True)
    return precompiled


def check_command(compiler, flags, precompiled, files):
    """Checks files by including them in an empty one."""
    sources = (word for file in files for word in ("-include", str(build_tree.ROOT / file)))
    return [compiler, *flags, *FLAGS, "-include-pch", str(precompiled), *sources, "-x", "c++", os.devnull]


def main(arguments):
    build_dir = os.path.abspath(arguments[0] if arguments else build_tree.ROOT / "build/release")
    build_tree.require_configured(build_dir)
    compiler = next(filter(None, map(shutil.which, COMPILERS)), None)
    if compiler is None:
        sys.exit("expected clang++, got none; install the packages of packages/develop.txt")
    jobs = build_tree.default_jobs()
    build_tree.build_generated_sources(build_dir, jobs)
    commands = build_tree.compile_commands(build_dir)
    tree = source_tree.SourceTree(build_tree.ROOT)
    files = files_to_check(tree, commands)
    if not files:
        sys.exit("no file sees an annotated mutex: nothing would be checked")
    groups = read_together(files, commands)
    flags = flags_of_all(groups)
    with tempfile.TemporaryDirectory() as folder:
        precompiled = precompile(compiler, flags, shared_headers(tree, groups), pathlib.Path(folder))
        failures = build_tree.run_all([(group[0], check_command(compiler, flags, precompiled, group), build_dir)
                                       for group in groups.values()], jobs)
    for output in failures.values():
        print(output, file=sys.stderr)
    print(f"Thread safety: {len(files)} files in {len(groups)} compilations, {len(failures)} of which failed.")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
