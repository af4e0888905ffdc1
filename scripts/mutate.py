#!/usr/bin/env python3
"""Measures how often the tests notice when the code is broken on purpose, one small change at a time.

Each room (a folder of a library that needs no LibTorch) gets a sample of mutations, drawn by --seed. Each is compiled
into the room's test programs in a copy of the tree below build/mutate, which then run: first those with tests of the
room's own folder, then the others that link its library or start a program that does, last the LibTorch programs with
tests of its own folder. The next draw replaces a mutation that does not compile. A stopped run can be continued: a
caught mutation counts until its file changes or build/mutate/caught is deleted; a survivor is tried again.

    scripts/mutate.py [--rooms model/motion server/*] [--per-room 30] [--seed 1] [--jobs 2]
    scripts/mutate.py --at server/batching/batch_decision.cc:209       every mutation of a line

Prints each mutation with its outcome, then the share that was caught of each room. Fails if it is below 90 % in all.
"""

import argparse
import collections
import concurrent.futures
import fnmatch
import hashlib
import os
import pathlib
import random
import re
import sys
import threading

import build_tree
import mutations
from mutation_workshop import Workshop

WANTED = 90  # per cent


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
    """Tries mutations in workshops, each of which takes its share of the rooms. `known` has those caught earlier."""

    def __init__(self, shops, known, root, tests):
        self.shops, self.root, self.tests, self.path, self.lock = shops, root, tests, known, threading.Lock()
        self.known = set(known.read_text().split()) if known.exists() else set()
        self.stopped, self.caught = threading.Event(), collections.defaultdict(list)

    def rooms(self, drawn, wanted):
        """Room -> for each of its first `wanted` mutations that compile, whether it was caught."""
        with concurrent.futures.ThreadPoolExecutor(len(self.shops)) as pool:
            try:
                list(pool.map(lambda number: self.share(number, drawn, wanted), range(len(self.shops))))
                return dict(self.caught)
            finally:
                self.stopped.set()  # an interruption

    def share(self, number, drawn, wanted):
        for room in list(drawn)[number::len(self.shops)]:
            for file, mutation in drawn[room]:
                if len(self.caught[room]) == wanted or self.stopped.is_set():
                    break
                outcome = self.one(self.shops[number], file, mutation)
                if outcome != "invalid":
                    self.caught[room].append(outcome == "caught")

    def one(self, shop, file, mutation):
        text = (self.root / file).read_text(encoding="utf-8")
        key = hashlib.sha256(f"{file} {mutation} {text}".encode()).hexdigest()
        outcome = "caught" if key in self.known else shop.attempt(file, mutation.apply(text), self.tests[file])
        if key not in self.known and outcome == "caught":
            with self.lock, self.path.open("a", encoding="utf-8") as out:
                out.write(f"{key}\n")
        print(f"{outcome} {file}:{mutation.line}: {text[mutation.start:mutation.end]!r} became {mutation.replacement!r}"
              f" in {text.splitlines()[mutation.line - 1].strip()}", flush=True)
        return outcome


def percent(caught):
    return 100 * sum(caught) / len(caught) if caught else 100


def parse(arguments):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rooms", nargs="+", default=["*"], metavar="PATTERN", help="folders to sample")
    parser.add_argument("--at", nargs="+", metavar="FILE:LINE", help="all mutations of these lines")
    parser.add_argument("--per-room", type=int, default=30, help="mutations of each room that compile")
    parser.add_argument("--seed", type=int, default=1, help="which mutations are drawn")
    parser.add_argument("--jobs", type=int, default=build_tree.default_jobs(), help="copies of the tree")
    return parser.parse_args(arguments)


def main(arguments):
    options, root = parse(arguments), build_tree.ROOT
    os.nice(5)
    shops = [Workshop(root / "build/mutate" / str(number), root) for number in range(1, options.jobs + 1)]
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
    run = Run(shops, root / "build/mutate/caught", root, tests)
    results = run.rooms(drawn, sys.maxsize if options.at else options.per_room)
    results = {**dict(sorted(results.items())), "all": sum(results.values(), [])}
    for room, caught in results.items():
        print(f"{room:32} {percent(caught):5.1f} % of {len(caught)}")
    return 0 if percent(results["all"]) >= WANTED else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
