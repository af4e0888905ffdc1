#!/usr/bin/env python3
"""Checks with Clang that data guarded by a mutex is used only under it (-Wthread-safety as errors).

Checks every file that includes the annotated mutex, which is the header with the attribute
`capability("mutex")`. Files of one batch of the build (cmake/DuetBatches.cmake) are read together, because most of the time goes into
headers that they share. Builds only the generated protocol headers.

    scripts/check_thread_safety.py [build folder]     build/release, configured
"""

import os
import re
import shutil
import sys

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


def check_command(compiler, words, files):
    """Checks files by including them in an empty one."""
    sources = (word for file in files for word in ("-include", str(build_tree.ROOT / file)))
    return [compiler, *build_tree.portable_flags(words), *FLAGS, *sources, "-x", "c++", os.devnull]


def main(arguments):
    build_dir = os.path.abspath(arguments[0] if arguments else build_tree.ROOT / "build/release")
    build_tree.require_configured(build_dir)
    compiler = next(filter(None, map(shutil.which, COMPILERS)), None)
    if compiler is None:
        sys.exit("expected clang++, got none; install the packages of packages/develop.txt")
    jobs = build_tree.default_jobs()
    build_tree.build_generated_sources(build_dir, jobs)
    commands = build_tree.compile_commands(build_dir)
    files = files_to_check(source_tree.SourceTree(build_tree.ROOT), commands)
    if not files:
        sys.exit("no file sees an annotated mutex: nothing would be checked")
    groups = read_together(files, commands)
    failures = build_tree.run_all([(group[0], check_command(compiler, words, group), build_dir)
                                   for words, group in groups.items()], jobs)
    for output in failures.values():
        print(output, file=sys.stderr)
    print(f"Thread safety: {len(files)} files in {len(groups)} compilations, {len(failures)} of which failed.")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
