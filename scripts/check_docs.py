#!/usr/bin/env python3
"""Checks that relative links, and paths in `backquotes` that begin with a folder of the repository, exist.

A path may contain wildcards (`without_*`), name a header and its source (`clip.{h,cc}`), or omit its
extension (`model/motion/clip`). CHANGELOG.md describes the past, so only its links are checked. Files that a build or a run makes (build/, out/, results/) are not checked.

    scripts/check_docs.py [source folder]
"""

import pathlib
import re
import sys

LINK = re.compile(r"\]\(([^)#\s]+)(?:#[^)\s]*)?\)")
PATH = re.compile(r"`([\w.*{},/-]+/[\w.*{},/-]*)`")
OF_THE_PAST = ("CHANGELOG.md",)
MADE = ("build", "out", "results")  # top folders


def expand(path):
    """Every path that a path with {a,b} names."""
    braces = re.search(r"\{([^{}]*)\}", path)
    if not braces:
        return [path]
    return [found for choice in braces[1].split(",")
            for found in expand(path[:braces.start()] + choice + path[braces.end():])]


def exists(root, path):
    path = path.rstrip("/")
    return any(root.glob(path)) or any(root.glob(path + ".*"))


def documents_of(root):
    # Made folders are not entered: one may hold the root of another system (scripts/try_release.sh).
    folders = [entry for entry in root.iterdir()
               if entry.is_dir() and entry.name not in MADE and not entry.name.startswith(".")]
    found = [*root.glob("*.md"), *(file for folder in folders for file in folder.rglob("*.md"))]
    return sorted(file.relative_to(root).as_posix() for file in found)


def problems(root, document):
    """The problems of a document as (line, message)."""
    file = root / document
    folders = {entry.name for entry in root.iterdir()
               if entry.is_dir() and entry.name not in MADE}
    for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), start=1):
        for target in LINK.findall(line):
            if ":" not in target and not (file.parent / target).exists():
                yield number, f"links to {target}, which does not exist"
        if document.startswith(OF_THE_PAST):
            continue
        for path in PATH.findall(line):
            if path.split("/")[0] not in folders:
                continue
            for one in expand(path):
                if not exists(root, one):
                    yield number, f"names {one}, which does not exist"


def main(arguments):
    root = pathlib.Path(arguments[0] if arguments else pathlib.Path(__file__).parent.parent)
    documents = documents_of(root)
    found = [f"{document}:{line}: {message}"
             for document in documents for line, message in problems(root, document)]
    for problem in found:
        print(problem, file=sys.stderr)
    if found:
        return 1
    print(f"{len(documents)} documents: all links and paths exist.")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
