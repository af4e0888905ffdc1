#!/usr/bin/env python3
"""Checks that every header of the project compiles by itself.

The build proves that for a header that some source file includes first, unless that file is compiled with
a precompiled header or in a batch. This check compiles every other header with the flags of a nearby source file. A
compiler cache makes the second run fast.

    scripts/check_headers.py [--torch-free] [build folder]     build/release, configured
    --torch-free  skips headers that include LibTorch, which take twelve seconds each
"""

import argparse
import os
import pathlib
import shutil
import sys

import build_tree
import source_tree


def proven_by_the_build(tree, commands):
    """The headers that a source file includes first, without an include by a flag before."""
    return {tree.includes(file)[0] for file, words in commands.items()
            if tree.includes(file) and "-include" not in words}


def nearest_source(header, sources):
    """The source file of the same name, else of the same folder, else of the nearest folder."""
    def distance(source):
        ours, theirs = pathlib.PurePosixPath(header), pathlib.PurePosixPath(source)
        shared = len(os.path.commonprefix([ours.parent.parts, theirs.parent.parts]))
        steps = len(ours.parent.parts) + len(theirs.parent.parts) - 2 * shared
        return steps, ours.stem != theirs.stem, source
    return min(sources, key=distance)


def write_source(header, folder):
    """Writes a source file that includes only the header, twice, to check its guard as well."""
    source = folder / (header + ".cc")
    text = f'#include "{header}"\n#include "{header}"\n'
    source.parent.mkdir(parents=True, exist_ok=True)
    if not source.exists() or source.read_text(encoding="utf-8") != text:
        source.write_text(text, encoding="utf-8")
    return source


def compile_command(header, commands, build_dir):
    flags = build_tree.portable_flags(commands[nearest_source(header, commands)])
    source = write_source(header, build_dir / "headers")
    cache = [ccache] if (ccache := shutil.which("ccache")) else []
    return [*cache, "g++", *flags, "-I", str(build_tree.ROOT), "-c", str(source),
            "-o", f"{source}.o"]


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("build_dir", nargs="?", default=str(build_tree.ROOT / "build/release"))
    parser.add_argument("--torch-free", action="store_true")
    options = parser.parse_args(arguments)
    build_dir = pathlib.Path(options.build_dir).resolve()
    build_tree.require_configured(build_dir)
    jobs = build_tree.default_jobs()
    build_tree.build_generated_sources(build_dir, jobs)

    tree = source_tree.SourceTree(build_tree.ROOT)
    commands = build_tree.compile_commands(build_dir)
    headers = [header for header in tree.files(".h")
               if not (options.torch_free and tree.reaches_torch(header))]
    proven = proven_by_the_build(tree, commands)
    alone = [header for header in headers if header not in proven]
    failures = build_tree.run_all(
        [(header, compile_command(header, commands, build_dir), build_dir) for header in alone],
        jobs)
    for output in failures.values():
        print(output, file=sys.stderr)
    print(f"{len(headers)} {'torch-free ' if options.torch_free else ''}headers: "
          f"{len(headers) - len(alone)} come first in a source file, {len(alone) - len(failures)} "
          f"of the other {len(alone)} compile by themselves.")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
