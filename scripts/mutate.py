#!/usr/bin/env python3
"""Breaks the code in small ways, one at a time, and counts how often the tests notice.

Works on copies of the tree below build/mutate, one for each job: the sources are never touched. Of
each room (a folder of a library that needs no LibTorch) a sample of mutations is drawn by --seed;
each is compiled into the room's test programs, which then run. What does not compile is replaced by
the next draw. First come the tests of the room's own folder in tests/, then all the others of the
programs that link its library or start one that does. A run that is stopped goes on where it was; a
mutation that was caught counts as caught until its file changes, one that survived is tried again
after any change.

    scripts/mutate.py [--rooms model/motion server/*] [--per-room 30] [--seed 1] [--jobs 2]
                      [--report docs/mutation.md] [--wanted 90] [--fresh]

Fails when fewer than --wanted per cent are caught.
"""

import argparse
import collections
import concurrent.futures
import fnmatch
import os
import pathlib
import queue
import random
import sys
import threading

import build_tree
import mutation_journal
import mutation_report
import mutation_workshop
import mutations

WORK = build_tree.ROOT / "build/mutate"


def rooms_of(targets, root):
    """Folder -> its source files with the library that holds each: what can be mutated."""
    rooms = collections.defaultdict(dict)
    for name, target in targets.items():
        if not target.is_library or not build_tree.is_torch_free(targets, name):
            continue
        for source in target.sources:
            if source.endswith(".cc") and source.startswith(("model/", "server/", "client/")):
                if (root / source).is_file():
                    rooms[str(pathlib.PurePosixPath(source).parent)][source] = name
    return dict(sorted(rooms.items()))


def draw(room, sources, root, seed):
    """Every mutation of a room as (file, mutation), in the order in which they are drawn."""
    every = [(file, mutation) for file in sorted(sources)
             for mutation in mutations.mutations((root / file).read_text(encoding="utf-8"))]
    random.Random(f"{seed} {room}").shuffle(every)
    return every


class Run:
    """Tries mutations in all workshops at once, and keeps what came out."""

    def __init__(self, shops, journal, targets, tests):
        self.shops, self.journal = shops, journal
        self.targets, self.tests = targets, tests
        self.lock, self.stopped = threading.Lock(), threading.Event()

    def room(self, room, sources, drawn, wanted):
        """Results of the first `wanted` mutations of a room that compile."""
        results, place = [], 0
        while len(results) < wanted and place < len(drawn):
            batch = drawn[place:place + wanted - len(results)]
            place += len(batch)
            results += [result for result in self.batch(sources, batch)
                        if result["outcome"] != "invalid"]
            print(f"{room}: {len(results)} tried, "
                  f"{sum(r['outcome'] == 'survived' for r in results)} survived", flush=True)
        return results

    def batch(self, sources, batch):
        """Tries a batch, the mutations of one file after one another in one workshop."""
        by_file = collections.defaultdict(list)
        for file, mutation in batch:
            by_file[file].append(mutation)
        free = queue.Queue()
        for shop in self.shops:
            free.put(shop)

        def work(file):
            shop = free.get()
            try:
                return self.file(shop, file, sources[file], by_file[file])
            finally:
                free.put(shop)
        with concurrent.futures.ThreadPoolExecutor(len(self.shops)) as pool:
            try:
                return [result for results in pool.map(work, by_file) for result in results]
            except BaseException:  # an interruption as well: what is known is in the journal
                self.stopped.set()
                raise

    def file(self, shop, file, library, wanted):
        """Tries the mutations of one file."""
        text = (build_tree.ROOT / file).read_text(encoding="utf-8")
        results = []
        try:
            for mutation in sorted(wanted, key=lambda m: m.start):
                known = self.journal.result(file, text, mutation)
                if known is None:
                    if self.stopped.is_set():
                        break
                    known = self.describe(file, text, mutation)
                    known.update(shop.attempt(file, mutation.apply(text),
                                              *self.tests[library, file]))
                    with self.lock:
                        self.journal.add(file, text, mutation, known)
                results.append(known)
        finally:
            shop.restore(file, text)
        return results

    @staticmethod
    def describe(file, text, mutation):
        line = mutation.line(text)
        return {"file": file, "line": line, "kind": mutation.kind,
                "code": text.splitlines()[line - 1].strip(),
                "before": " ".join(text[mutation.start:mutation.end].split()),
                "after": " ".join(mutation.replacement.split())}


def parse(arguments):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rooms", nargs="+", default=["*"], metavar="PATTERN")
    parser.add_argument("--per-room", type=int, default=30)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=build_tree.default_jobs())
    parser.add_argument("--report", type=pathlib.Path, help="the page to write")
    parser.add_argument("--wanted", type=float, default=90, help="per cent to be caught")
    parser.add_argument("--fresh", action="store_true", help="forget earlier runs")
    return parser.parse_args(arguments)


def main(arguments):
    options = parse(arguments)
    os.nice(5)
    shops = [mutation_workshop.Workshop(WORK / str(number), build_tree.ROOT)
             for number in range(1, options.jobs + 1)]
    print("Copying the tree and configuring it.", flush=True)
    for shop in shops:
        shop.prepare()
    targets = build_tree.read_targets(shops[0].build_dir)
    rooms = {room: sources for room, sources in rooms_of(targets, build_tree.ROOT).items()
             if any(fnmatch.fnmatchcase(room, pattern) for pattern in options.rooms)}
    if not rooms:
        sys.exit(f"--rooms: no room matches {' '.join(options.rooms)}")
    tests = {(library, file): mutation_workshop.tests_for(targets, library, file)
             for sources in rooms.values() for file, library in sources.items()}
    left_out = [room for room, sources in rooms.items()
                if not any(any(tests[library, file]) for file, library in sources.items())]
    for room in left_out:
        print(f"{room}: left out, no test program without LibTorch links it")
        del rooms[room]
    runs = sorted({run for tiers in tests.values() for tier in tiers for run in tier})
    print(f"Building and running {len({run.program for run in runs})} test programs as they are.",
          flush=True)
    for shop in shops:
        shop.build_and_time(runs)

    journal = mutation_journal.Journal(WORK / "journal.jsonl", build_tree.ROOT, options.fresh)
    run = Run(shops, journal, targets, tests)
    results = {room: run.room(room, sources, draw(room, sources, build_tree.ROOT, options.seed),
                              options.per_room)
               for room, sources in rooms.items()}
    summary = mutation_report.Summary({room: found for room, found in results.items() if found})
    print(summary.text())
    if options.report:
        options.report.write_text(summary.page(options, arguments, left_out), encoding="utf-8")
    return 0 if summary.score >= options.wanted else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
