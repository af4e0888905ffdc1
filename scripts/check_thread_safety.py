#!/usr/bin/env python3
"""Checks with Clang that data guarded by a mutex is used only under it (-Wthread-safety as errors).

Checks every file that includes the annotated mutex, which is the header with the attribute
`capability("mutex")`. Builds only the generated protocol headers.

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


def main(arguments):
    build_dir = os.path.abspath(arguments[0] if arguments else build_tree.ROOT / "build/release")
    build_tree.require_configured(build_dir)
    compiler = next(filter(None, map(shutil.which, COMPILERS)), None)
    if compiler is None:
        sys.exit("expected clang++, got none; install the packages of packages/develop.txt")
    jobs = build_tree.default_jobs()
    build_tree.build_generated_sources(build_dir, jobs)
    flags = build_tree.compile_flags(build_dir)
    files = files_to_check(source_tree.SourceTree(build_tree.ROOT), flags)
    if not files:
        sys.exit("no file sees an annotated mutex: nothing would be checked")
    failures = build_tree.run_all(
        [(file, [compiler, *flags[file], *FLAGS, str(build_tree.ROOT / file)], build_dir)
         for file in files], jobs)
    for output in failures.values():
        print(output, file=sys.stderr)
    kept = len(files) - len(failures)
    print(f"Thread safety: {kept} of {len(files)} files use their mutexes correctly.")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
