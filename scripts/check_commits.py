#!/usr/bin/env python3
"""Checks the form of commit messages: `component: Imperative summary` of at most 72 characters, then an
empty line and a body that says why. Changes of at most 20 lines need no body.

    scripts/check_commits.py                   the commits of HEAD that main's upstream lacks
    scripts/check_commits.py --message FILE    the message of the staged change (scripts/hooks/commit-msg)

Merges are exempt, and so are messages that git writes (Revert) or that a rebase will drop (fixup!, squash!).
Without git or without main's history the check is skipped.
"""

import pathlib
import re
import subprocess
import sys

SUBJECT_LIMIT = 72  # characters
TRIVIAL_LINES = 20  # a change of at most so many lines needs no body
COMPONENT = r"[a-z0-9][a-z0-9_./-]*"
SUBJECT = re.compile(rf"{COMPONENT}(?:, {COMPONENT})*: (?P<verb>[A-Z]\S*)(?: \S+)*")
# Adds, Added and Adding are not imperative; Pass, Embed and Bring are.
NOT_IMPERATIVE = re.compile(r"[A-Z][a-z]+(?:[^suio]s|[^e]ed|ing)")
IMPERATIVE = {"Alias", "Bias", "Bring", "Embed", "Ping", "Shed", "String"}
WRITTEN_BY_GIT = ("Merge ", "Revert ", "fixup! ", "squash! ", "amend! ")
BASES = ("main@{upstream}", "origin/main", "main")


def problems(message, changed_lines):
    """What is wrong with a message, as sentences."""
    lines = message.rstrip("\n").split("\n")
    subject = lines[0]
    if subject.startswith(WRITTEN_BY_GIT):
        return
    form = SUBJECT.fullmatch(subject)
    if not form:
        yield f'subject: expected "component: Imperative summary", got "{subject}"'
    elif form["verb"] not in IMPERATIVE and NOT_IMPERATIVE.fullmatch(form["verb"]):
        yield f'subject: expected the imperative, got "{form["verb"]}"'
    if len(subject) > SUBJECT_LIMIT:
        yield f"subject: expected at most {SUBJECT_LIMIT} characters, got {len(subject)}"
    if subject.endswith("."):
        yield "subject: expected no period at the end"
    if len(lines) > 1 and lines[1]:
        yield f'second line: expected an empty line, got "{lines[1]}"'
    if len(lines) < 3 and changed_lines > TRIVIAL_LINES:
        yield f"body: expected the reason for a change of {changed_lines} lines, got nothing"


def written(text):
    """A message as git keeps it: without comments and the diff of `git commit --verbose`."""
    text = re.split(r"^# -+ >8 -+$", text, maxsplit=1, flags=re.MULTILINE)[0]
    return "\n".join(line for line in text.split("\n") if not line.startswith("#")).strip()


def git(*words):
    """What git prints; None if it fails."""
    try:
        done = subprocess.run(["git", *words], capture_output=True, text=True, check=False)
    except FileNotFoundError:
        return None
    return done.stdout if done.returncode == 0 else None


def changed_lines(numstat):
    """Added and removed lines in the output of --numstat; binary files count nothing."""
    counts = [line.split("\t")[:2] for line in numstat.splitlines() if "\t" in line]
    return sum(int(count) for pair in counts for count in pair if count.isdigit())


def check_message(path):
    message = written(pathlib.Path(path).read_text(encoding="utf-8"))
    return [f"commit message: {problem}"
            for problem in problems(message, changed_lines(git("diff", "--cached", "--numstat") or ""))]


def check_history(base):
    found = []
    for commit in git("rev-list", "--no-merges", "--reverse", f"{base}..HEAD").split():
        message = git("show", "--no-patch", "--format=%B", commit)
        lines = changed_lines(git("show", "--numstat", "--format=", commit))
        found += [f"commit {commit[:9]}: {problem}" for problem in problems(message.strip(), lines)]
    return found


def main(arguments):
    if len(arguments) == 2 and arguments[0] == "--message":
        found = check_message(arguments[1])
    elif arguments:
        sys.exit(__doc__)
    else:
        base = next((name for name in BASES if git("rev-parse", "--verify", "--quiet", name)), None)
        if base is None or git("merge-base", base, "HEAD") is None:
            print("Commits: SKIPPED, expected the history of main, got none.")
            return 0
        found = check_history(base)
    for problem in found:
        print(problem, file=sys.stderr)
    if not found and not arguments:
        print(f"Commits: every message since {base} has the expected form.")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
