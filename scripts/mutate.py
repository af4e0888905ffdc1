#!/usr/bin/env python3
"""Measures how often the tests notice when the code is broken on purpose, one small change at a time.

Each room (a folder of a library that needs no LibTorch) gets a sample of mutations, drawn by --seed. Each is compiled
into the room's test programs in a copy of the tree below build/mutate, which then run: first those with tests of the
room's own folder, then the others that link its library or start a program that does, last the LibTorch programs with
tests of its own folder. The next draw replaces a mutation that does not compile. A stopped run can be continued: a
caught mutation counts until its file changes or build/mutate/caught is deleted; a survivor is tried again.

    scripts/mutate.py [--rooms model/motion server/*] [--per-room 30] [--seed 1] [--jobs 2]
                      [--report docs/mutation.md]
    scripts/mutate.py --at server/batching/batch_decision.cc:209       every mutation of a line, listed

Fails if the tests catch less than 90 %.
"""

import argparse
import collections
import concurrent.futures
import datetime
import fnmatch
import hashlib
import os
import pathlib
import queue
import random
import re
import shlex
import sys
import threading
import typing

import build_tree
import mutations
from mutation_workshop import Workshop

MARK = "<!-- scripts/mutate.py --report writes the rest of this page. -->"
WANTED = 90  # per cent


class Result(typing.NamedTuple):
    file: str
    line: int
    code: str  # the line
    before: str
    after: str
    outcome: str  # caught, timeout or survived


def rooms_of(targets, root):
    """Folder -> its source files with the library that holds each."""
    rooms = collections.defaultdict(dict)
    for name, target in targets.items():
        if target.is_library and build_tree.is_torch_free(targets, name):
            for source in target.sources:
                if re.match(r"(model|server|client)/.*\.cc$", source) and (root / source).is_file():
                    rooms[str(pathlib.PurePosixPath(source).parent)][source] = name
    return dict(sorted(rooms.items()))


def tests_for(targets, library, file):
    """The programs that judge a file, in the order in which they run."""
    room = pathlib.PurePosixPath(file).parent
    mirror = f"tests/{room.relative_to('model') if room.parts[0] == 'model' else room}/"
    ranked = []
    for name, target in targets.items():
        reach = (name, *target.runs)
        if (not target.is_library and "GTest::gtest_main" in target.links
                and any(library in build_tree.closure(targets, item) for item in reach)):
            own = any(source.startswith(mirror) for source in target.sources)
            torch = not all(build_tree.is_torch_free(targets, item) for item in reach)
            if own or not torch:
                ranked.append((torch, not own, name))
    return [name for _, _, name in sorted(ranked)]


def draw(options, rooms, root):
    """Room -> its mutations as (file, mutation), in the order in which they are tried."""
    drawn = {}
    for room, sources in rooms.items():
        found = [(file, mutation) for file in sorted(sources)
                 for mutation in mutations.mutations((root / file).read_text(encoding="utf-8"))
                 if (f"{file}:{mutation.line}" in options.at if options.at else
                     any(fnmatch.fnmatchcase(room, pattern) for pattern in options.rooms))]
        random.Random(f"{options.seed} {room}").shuffle(found)
        if found:
            drawn[room] = found
    return drawn or sys.exit("expected --rooms or --at with mutations, got none")


class Run:
    """Tries mutations in the workshops, one room at a time in each. `known` names those caught earlier."""

    def __init__(self, shops, known, root, tests):
        self.root, self.tests, self.path, self.lock = root, tests, known, threading.Lock()
        self.known = dict(line.split() for line in known.read_text().splitlines()) if known.exists() else {}
        self.stopped, self.jobs, self.free = threading.Event(), len(shops), queue.Queue()
        for shop in shops:
            self.free.put(shop)

    def rooms(self, drawn, wanted):
        """Room -> results of its first `wanted` mutations that compile."""
        with concurrent.futures.ThreadPoolExecutor(self.jobs) as pool:
            try:
                return dict(zip(drawn, pool.map(lambda room: self.room(room, drawn[room], wanted), drawn)))
            finally:
                self.stopped.set()  # an interruption

    def room(self, room, drawn, wanted):
        shop, results = self.free.get(), []
        try:
            for file, mutation in drawn:
                if len(results) == wanted or self.stopped.is_set():
                    break
                result = self.one(shop, file, mutation)
                if result.outcome != "invalid":
                    results.append(result)
                    print(f"{room} {len(results)}: {' '.join(map(str, result))}", flush=True)
        finally:
            self.free.put(shop)
        return results

    def one(self, shop, file, mutation):
        text = (self.root / file).read_text(encoding="utf-8")
        key = hashlib.sha256(f"{file} {mutation} {text}".encode()).hexdigest()
        outcome = self.known.get(key) or shop.attempt(file, mutation.apply(text), self.tests[file])
        if key not in self.known and outcome != "survived":
            with self.lock, self.path.open("a", encoding="utf-8") as out:
                out.write(f"{key} {outcome}\n")
        return Result(file, mutation.line, text.splitlines()[mutation.line - 1].strip(),
                      text[mutation.start:mutation.end], mutation.replacement, outcome)


def percent(results):
    return 100 * sum(result.outcome != "survived" for result in results) / len(results) if results else 100


def page(results, options, arguments):
    """The generated part of the report."""
    everything = [result for found in results.values() for result in found]
    yield f"{MARK}\nWritten by `{shlex.join(['scripts/mutate.py', *arguments])}` on {datetime.date.today()}:"
    yield f"up to {options.per_room} mutations that compile from each folder, drawn with seed {options.seed}.\n"
    yield "| folder | tried | caught | of these by a time limit | survived | score |\n|---|---|---|---|---|---|"
    for room, found in (*((f"`{room}`", found) for room, found in results.items()), ("**all**", everything)):
        count = collections.Counter(result.outcome for result in found)
        yield (f"| {room} | {len(found)} | {len(found) - count['survived']} | {count['timeout']} | "
               f"{count['survived']} | {percent(found):.1f} % |")
    yield "\n## Survivors\n\n| where | before | after | line |\n|---|---|---|---|"
    for result in everything:
        if result.outcome == "survived":
            yield f"| `{result.file}:{result.line}` | {cell(result.before)} | {cell(result.after)} | {cell(result.code)} |"


def cell(code):
    """C++ as a cell of a Markdown table."""
    escaped = " ".join(code.split()).replace("&", "&amp;").replace("<", "&lt;").replace("|", "&#124;")
    return f"<code>{escaped}</code>" if code else "(nothing)"


def write_report(path, lines):
    """Replaces the generated part of a page, and keeps the text above it."""
    before = path.read_text(encoding="utf-8") if path.exists() else ""
    path.write_text(before.partition(MARK)[0] + "\n".join(lines) + "\n", encoding="utf-8")


def parse(arguments):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rooms", nargs="+", default=["*"], metavar="PATTERN", help="folders to sample")
    parser.add_argument("--at", nargs="+", metavar="FILE:LINE", help="only mutations of these lines")
    parser.add_argument("--per-room", type=int, default=30, help="mutations of each room that compile")
    parser.add_argument("--seed", type=int, default=1, help="which mutations are drawn")
    parser.add_argument("--jobs", type=int, default=build_tree.default_jobs(), help="copies of the tree")
    parser.add_argument("--report", type=pathlib.Path, help="page to write")
    return parser.parse_args(arguments)


def main(arguments):
    options, root = parse(arguments), build_tree.ROOT
    os.nice(5)
    work = root / "build/mutate"
    shops = [Workshop(work / str(number), root) for number in range(1, options.jobs + 1)]
    for shop in shops:
        shop.prepare()
    targets = build_tree.read_targets(shops[0].build_dir)
    rooms = rooms_of(targets, root)
    drawn = draw(options, rooms, root)
    tests = {file: tests_for(targets, rooms[room][file], file) for room in drawn for file, _ in drawn[room]}
    for file in sorted(file for file in tests if not tests[file]):
        print(f"{file}: left out, because no test program links it")
    drawn = {room: [change for change in drawn[room] if tests[change[0]]] for room in drawn}
    for shop in shops:
        shop.build_and_time(sorted(set().union(*tests.values())))

    run = Run(shops, work / "caught", root, tests)
    results = run.rooms(drawn, sys.maxsize if options.at else options.per_room)
    for room, found in results.items():
        print(f"{room:32} {percent(found):5.1f} % of {len(found)}")
    if options.report:
        write_report(options.report, page(results, options, arguments))
    return 0 if percent([result for found in results.values() for result in found]) >= WANTED else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
