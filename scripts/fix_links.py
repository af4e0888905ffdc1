#!/usr/bin/env python3
"""Rewrites DEPS and PRIVATE_DEPS of the CMakeLists.txt files as check_links.py expects.

Every duet_library, duet_program and duet_test whose links differ is laid out anew; what else the
call says stays as it is. Targets made by other means stay as they are: check_links.py names them.

    scripts/fix_links.py [--build-dir build/release]     then configure and build
"""

import argparse
import re
import sys
import textwrap

import build_tree
import check_links
import source_tree

CALL = re.compile(r"^duet_(library|program|test)\(NAME (\S+)([^()]*)\)", re.MULTILINE)
SECTION = re.compile(r"\s+(?=(?:SOURCES|DEPS|PRIVATE_DEPS|LABELS|ENVIRONMENT|TIMEOUT)\s)")
WIDTH = 100


def section(name, links):
    """One list of a call, the project's own libraries first; empty if there are none."""
    if not links:
        return []
    return [textwrap.fill(" ".join([name, *check_links.as_written(links)]), WIDTH,
                          initial_indent="  ", subsequent_indent=" " * (len(name) + 3),
                          break_long_words=False, break_on_hyphens=False)]


def rewritten(kind, name, body, public, private):
    """A call with other links, in the order SOURCES, DEPS, PRIVATE_DEPS, the rest."""
    parts = [part for part in SECTION.split(body) if part.strip()]
    kept = [part.rstrip() for part in parts if not part.startswith(("DEPS", "PRIVATE_DEPS"))]
    links = [*section("DEPS", public), *section("PRIVATE_DEPS", private)]
    sources = [f"  {part}" for part in kept if part.startswith("SOURCES")]
    rest = [f"  {part}" for part in kept if not part.startswith("SOURCES")]
    return "\n".join([f"duet_{kind}(NAME {name}", *sources, *links, *rest]) + ")"


def fix(text, checker):
    """A CMakeLists.txt with corrected links."""
    def replace(call):
        kind, name, body = call.groups()
        target = checker.targets.get(f"duet_{name}" if kind == "library" else name)
        if target is None or not any(checker.check(target)):
            return call[0]
        # These lists do not contain libraries that are linked by their file.
        public, private = ([link for link in links if "/" not in link]
                           for links in checker.wanted(target))
        if kind != "library":
            public, private = sorted({*public, *private}), []
        return rewritten(kind, name, body, public, private)
    return CALL.sub(replace, text)


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--build-dir", default=str(build_tree.ROOT / "build/release"))
    options = parser.parse_args(arguments)
    build_tree.require_configured(options.build_dir)
    checker = check_links.LinkCheck(build_tree.read_targets(options.build_dir),
                                    source_tree.SourceTree(build_tree.ROOT))
    for folder in source_tree.SOURCE_FOLDERS:
        for file in sorted((build_tree.ROOT / folder).rglob("CMakeLists.txt")):
            text = file.read_text(encoding="utf-8")
            fixed = fix(text, checker)
            if fixed != text:
                file.write_text(fixed, encoding="utf-8")
                print(f"{file.relative_to(build_tree.ROOT)}: links corrected")


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
