#!/usr/bin/env python3
"""Checks that every file that states Duet's version states that of the project in CMakeLists.txt.

The programs, their manual pages, the metrics and the Debian packages take the version from CMake, and
deploy/image/build.sh reads it from CMakeLists.txt. Other tools read only a file of their own, which must agree; RULES
lists these files. The changelog and the release notes must have a section and a page for the version, unless it is a
development version (a last part of 99 or more).

    scripts/check_version.py                    reports each file that differs
    scripts/check_version.py --write            writes the version into the files of RULES
    scripts/check_version.py --date 2026-12-01  writes the day of the release into the changelogs
"""

import argparse
import datetime
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
PROJECT = re.compile(r"^project\(duet VERSION (\d+\.\d+\.\d+)\b", re.MULTILINE)
NUMBER = r"\d+\.\d+\.\d+"


# Files by pattern, and how each of them states the version; group 1 is the version.
RULES = (
    ("client/python/duet_motion/__init__.py", rf'^__version__ = "({NUMBER})"$'),
    ("contrib/blender/duet_blender/__init__.py", r'^    "version": \((\d+, \d+, \d+)\),$'),
    ("deploy/debian/changelog", rf"\Aduet \(({NUMBER})-\d+\) "),
    ("Dockerfile", rf"^ARG VERSION=({NUMBER})$"),
    ("deploy/kubernetes/**/kustomization.yaml", rf"^ *newTag: ({NUMBER})$"),
    ("deploy/kubernetes/**/kustomization.yaml", rf"^ *app\.kubernetes\.io/version: ({NUMBER})$"),
    ("deploy/image/write_sbom.py", rf"--version ({NUMBER}) "),
    ("docs/releases/README.md", rf"^The current version is ({NUMBER})\.$"),
)


def project_version(root):
    return PROJECT.search((root / "CMakeLists.txt").read_text(encoding="utf-8"))[1]


def spelled(version, like):
    """The version as a file spells it: 1.0.0, or (1, 0, 0) as in Blender."""
    return version.replace(".", ", ") if "," in like else version


def statements(root):
    """Each (file, text, match) that states a version; match None: a rule without any."""
    for pattern, expression in RULES:
        found = False
        for file in sorted(root.glob(pattern)):
            text = file.read_text(encoding="utf-8")
            for match in re.finditer(expression, text, re.MULTILINE):
                found = True
                yield file, text, match
        if not found:
            yield root / pattern, "", None


def problems(root):
    version = project_version(root)
    for file, text, match in statements(root):
        where = file.relative_to(root)
        if match is None:
            yield f"{where}: expected the version {version}, got none"
        elif match[1] != spelled(version, match[1]):
            line = text.count("\n", 0, match.start(1)) + 1
            yield f"{where}:{line}: expected the version {spelled(version, match[1])}, got {match[1]}"
    if int(version.split(".")[2]) >= 99:
        return
    if f"\n## [{version}]" not in (root / "CHANGELOG.md").read_text(encoding="utf-8"):
        yield f"CHANGELOG.md: expected a section [{version}], got none"
    if not (root / "docs" / "releases" / f"{version}.md").is_file():
        yield f"docs/releases/{version}.md: expected release notes, got no file"


def write(root):
    version = project_version(root)
    for pattern, expression in RULES:
        for file in sorted(root.glob(pattern)):
            text = file.read_text(encoding="utf-8")

            def replaced(match):
                begin, end = match.start(1) - match.start(), match.end(1) - match.start()
                return match[0][:begin] + spelled(version, match[1]) + match[0][end:]
            file.write_text(re.sub(expression, replaced, text, flags=re.MULTILINE),
                            encoding="utf-8")


def write_date(root, day):
    """The day of the release into the changelog's section, and of the first entry of Debian's."""
    version = project_version(root)
    changelog = root / "CHANGELOG.md"
    text = changelog.read_text(encoding="utf-8")
    heading = re.compile(rf"^## \[{re.escape(version)}\] - .*$", re.MULTILINE)
    if not heading.search(text):
        raise SystemExit(f'CHANGELOG.md: expected a line "## [{version}] - ", got none')
    changelog.write_text(heading.sub(f"## [{version}] - {day.isoformat()}", text, count=1),
                         encoding="utf-8")
    debian = root / "deploy" / "debian" / "changelog"
    text = debian.read_text(encoding="utf-8")
    stamp = day.strftime("%a, %d %b %Y 12:00:00 +0000")
    debian.write_text(re.sub(r"^( -- .*>  ).*$", rf"\g<1>{stamp}", text, count=1,
                             flags=re.MULTILINE), encoding="utf-8")


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--date", type=datetime.date.fromisoformat)
    options = parser.parse_args(arguments)
    if options.write:
        write(ROOT)
    if options.date:
        write_date(ROOT, options.date)
    found = list(problems(ROOT))
    for problem in found:
        print(problem)
    print(f"Version: {project_version(ROOT)}, {len(found)} problems.")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
