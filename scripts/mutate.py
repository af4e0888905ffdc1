#!/usr/bin/env python3
"""Measures how often the tests notice when the code is broken on purpose, one small change at a time.

Each room (a folder of a library that needs no LibTorch) gets a sample of mutations, drawn by --seed. Each is compiled
into the room's test programs in a copy of the tree below build/mutate, which then run: first the tests of the
room's own folder in tests/, then the others that link its library or start a program that does, last the LibTorch
tests of its own folder. The next draw replaces a mutation that does not compile. A stopped run can be continued: a
caught mutation counts until its file changes; a survivor is tried again after any change.

    scripts/mutate.py [--rooms model/motion server/*] [--per-room 30] [--seed 1] [--jobs 2]
                      [--report docs/mutation.md] [--wanted 90] [--fresh]
    scripts/mutate.py --at server/batching/batch_decision.cc:209       every mutation of a line, listed

Fails if the tests catch less than --wanted per cent.
"""

import argparse
import collections
import concurrent.futures
import datetime
import fnmatch
import hashlib
import json
import os
import pathlib
import queue
import random
import re
import shlex
import sys
import threading

import build_tree
import mutations
import source_tree
from mutation_workshop import TestRun, Workshop

MARK = "<!-- scripts/mutate.py --report writes the rest of this page. -->"
WORK = build_tree.ROOT / "build/mutate"
SUITE = re.compile(r"^(?:TYPED_)?TEST(?:_F|_P)?\((\w+)", re.MULTILINE)


def rooms_of(targets, root):
    """Folder -> its source files with the library that holds each."""
    rooms = collections.defaultdict(dict)
    for name, target in targets.items():
        if target.is_library and build_tree.is_torch_free(targets, name):
            for source in target.sources:
                if (re.match(r"(model|server|client)/.*\.cc$", source) and (root / source).is_file()):
                    rooms[str(pathlib.PurePosixPath(source).parent)][source] = name
    return dict(sorted(rooms.items()))


def draw(room, sources, root, seed):
    """Every mutation of a room as (file, mutation), in the order in which they are drawn."""
    every = [(file, mutation) for file in sorted(sources)
             for mutation in mutations.mutations((root / file).read_text(encoding="utf-8"))]
    random.Random(f"{seed} {room}").shuffle(every)
    return every


def tests_for(targets, library, file, root=build_tree.ROOT):
    """The tests that judge a file, in tiers: the suites of the nearest folder of tests/ that mirrors the file's; all
    others of programs that link its library or start one that does; LibTorch programs of its folder or one above."""
    room = pathlib.PurePosixPath(file).parent
    mirror = room.relative_to("model") if room.parts[0] == "model" else room
    folders = ["tests" / folder for folder in (mirror, *mirror.parents) if folder.parts]
    users, torch = [], []
    for name, target in targets.items():
        reach = (name, *target.runs)
        if (target.is_library or "GTest::gtest_main" not in target.links
                or not any(library in build_tree.closure(targets, item) for item in reach)):
            continue
        if all(build_tree.is_torch_free(targets, item) for item in reach):
            users.append(name)
        elif any(suites_in(target.sources, folder, root) for folder in folders):
            torch.append(TestRun(name))
    own = next(filter(None, (
        [TestRun(name, suites) for name in users
         if (suites := suites_in(targets[name].sources, folder, root))] for folder in folders)), [])
    parts = {run.program for run in own if run.filter != "*"}
    whole = {run.program for run in own} - parts
    others = [TestRun(name) for name in users if name in parts or name not in whole and any(
        library in targets[item].links for item in (name, *targets[name].runs))]
    return sorted(own), sorted(others), sorted(torch)


def suites_in(sources, folder, root):
    """A filter for the suites of the sources in a folder; "*" if the program has no others."""
    inside = [source for source in sources if pathlib.PurePosixPath(source).parent == folder]
    if inside and len(inside) == len(sources):
        return "*"
    suites = {suite for source in inside
              for suite in SUITE.findall((root / source).read_text(encoding="utf-8"))}
    # Suites with parameters or types have a prefix or a suffix.
    return ":".join(f"{suite}.*:*/{suite}.*:{suite}/*" for suite in sorted(suites))


class Journal:
    """Results of earlier runs, one line each. Caught: valid until the file changes. Survived: until any file does."""

    def __init__(self, path, root, fresh=False):
        self.path, self.known, self.lock = path, {}, threading.Lock()
        tree = source_tree.SourceTree(root)
        self.tree = digest(*(part for suffix in (".h", ".cc", "CMakeLists.txt") for file in tree.files(suffix)
                             for part in (file, (tree.root / file).read_text(encoding="utf-8"))))
        path.parent.mkdir(parents=True, exist_ok=True)
        if fresh:
            path.unlink(missing_ok=True)
        for line in path.read_text(encoding="utf-8").splitlines() if path.exists() else ():
            try:
                entry = json.loads(line)
                self.known[entry["key"]] = entry
            except ValueError:  # a stopped run left the line incomplete
                continue

    def result(self, key):
        """The result of a mutation; None if unknown or no longer valid."""
        entry = self.known.get(key)
        if entry and (entry["result"]["outcome"] != "survived" or entry["tree"] == self.tree):
            return entry["result"]
        return None

    def add(self, key, result):
        entry = {"key": key, "tree": self.tree, "result": result}
        with self.lock, self.path.open("a", encoding="utf-8") as out:
            self.known[key] = entry
            out.write(json.dumps(entry) + "\n")


def digest(*parts):
    return hashlib.sha256("\0".join(parts).encode()).hexdigest()[:24]


class Run:
    """Tries the mutations of rooms, one room at a time in each workshop."""

    def __init__(self, shops, journal, root, tests):
        self.journal, self.root, self.tests = journal, root, tests
        self.stopped, self.jobs, self.free = threading.Event(), len(shops), queue.Queue()
        for shop in shops:
            self.free.put(shop)

    def rooms(self, drawn, wanted):
        """Room -> results of its first `wanted` mutations that compile."""
        with concurrent.futures.ThreadPoolExecutor(self.jobs) as pool:
            try:
                return dict(zip(drawn, pool.map(lambda room: self.room(room, drawn[room], wanted), drawn)))
            except BaseException:  # an interruption as well: the journal has what is known
                self.stopped.set()
                raise

    def room(self, room, drawn, wanted):
        shop, results, place = self.free.get(), [], 0
        try:
            while len(results) < wanted and place < len(drawn) and not self.stopped.is_set():
                batch = drawn[place:place + wanted - len(results)]
                place += len(batch)
                # The mutations of one file follow each other: fewer files are compiled again.
                tried = [self.one(shop, file, mutation) for file, mutation in sorted(batch)]
                results += [result for result in tried if result and result["outcome"] != "invalid"]
                survived = sum(result["outcome"] == "survived" for result in results)
                print(f"{room}: {len(results)} tried, {survived} survived", flush=True)
        finally:
            self.free.put(shop)
        return results

    def one(self, shop, file, mutation):
        """The result of a mutation; None if the run was stopped before it."""
        text = (self.root / file).read_text(encoding="utf-8")
        key = digest(file, text, *map(str, mutation))
        known = self.journal.result(key)
        if known is None and not self.stopped.is_set():
            line = mutation.line(text)
            known = {"file": file, "line": line, "code": text.splitlines()[line - 1].strip(),
                     "before": " ".join(text[mutation.start:mutation.end].split()),
                     "after": " ".join(mutation.replacement.split()),
                     **shop.attempt(file, mutation.apply(text), self.tests[file])}
            self.journal.add(key, known)
        return known


def percent(results):
    caught = sum(result["outcome"] != "survived" for result in results)
    return 100.0 * caught / len(results) if results else 100.0


def with_total(results, name):
    """(room, its results), and all of them under `name`."""
    return [*results.items(), (name, [result for found in results.values() for result in found])]


def table(results):
    yield "| folder | tried | caught | by its own tests | by a time limit | survived | score |"
    yield "|---|---|---|---|---|---|---|"
    for room, found in with_total({f"`{room}`": found for room, found in results.items()}, "**all**"):
        count = collections.Counter(result["outcome"] for result in found)
        own = sum(bool(result.get("own")) for result in found)
        yield (f"| {room} | {len(found)} | {len(found) - count['survived']} | {own} | "
               f"{count['timeout']} | {count['survived']} | {percent(found):.1f} % |")


def listing(results, title, outcome):
    rows = [f"| `{result['file']}:{result['line']}` | "
            + " | ".join(cell(result[part]) for part in ("before", "after", "code")) + " |"
            for found in results.values() for result in found if result["outcome"] == outcome]
    return ["", f"## {title}", "",
            *(["| where | before | after | line |", "|---|---|---|---|", *rows] if rows else ["None."])]


def cell(code):
    """C++ as a cell of a Markdown table."""
    escaped = code.replace("&", "&amp;").replace("<", "&lt;").replace("|", "&#124;")
    return f"<code>{escaped}</code>" if code else "(nothing)"


def page(results, options, arguments, left_out=()):
    """The generated part of the report."""
    command = shlex.join(["scripts/mutate.py", *arguments])
    return "\n".join([
        f"{MARK}\nWritten by `{command}` on {datetime.date.today().isoformat()}: up to {options.per_room} "
        f"mutations that compile from each folder, drawn with seed {options.seed}.\n",
        *table(results),
        *([f"\nLeft out, because no test reaches them: {', '.join(map('`{}`'.format, left_out))}."]
          if left_out else []),
        *listing(results, "Survivors", "survived"),
        *listing(results, "Caught by a time limit", "timeout")]) + "\n"


def write_report(path, text):
    """Replaces the generated part of a page, and keeps what stands above it."""
    before = path.read_text(encoding="utf-8") if path.exists() else ""
    path.write_text(before.partition(MARK)[0] + text, encoding="utf-8")


def parse(arguments):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rooms", nargs="+", default=["*"], metavar="PATTERN", help="folders to sample")
    parser.add_argument("--at", nargs="+", metavar="FILE:LINE", help="only mutations of these lines")
    parser.add_argument("--per-room", type=int, default=30, help="mutations of each room that compile")
    parser.add_argument("--seed", type=int, default=1, help="which mutations are drawn")
    parser.add_argument("--jobs", type=int, default=build_tree.default_jobs(), help="copies of the tree")
    parser.add_argument("--report", type=pathlib.Path, help="page to write")
    parser.add_argument("--wanted", type=float, default=90, help="minimum per cent to catch")
    parser.add_argument("--fresh", action="store_true", help="ignore earlier runs")
    return parser.parse_args(arguments)


def chosen(options, rooms, root):
    """Room -> its mutations in the order in which they are tried."""
    drawn = {room: draw(room, sources, root, options.seed) for room, sources in rooms.items()
             if any(fnmatch.fnmatchcase(room, pattern) for pattern in options.rooms)}
    if options.at:
        drawn = {room: [(file, mutation) for file, mutation in found if f"{file}:" in "".join(options.at) and
                        f"{file}:{mutation.line((root / file).read_text(encoding='utf-8'))}" in options.at]
                 for room, found in drawn.items()}
    drawn = {room: found for room, found in drawn.items() if found}
    return drawn or sys.exit("expected --rooms or --at with mutations, got none")


def main(arguments):
    options, root = parse(arguments), build_tree.ROOT
    os.nice(5)
    shops = [Workshop(WORK / str(number), root) for number in range(1, options.jobs + 1)]
    print("Copying the tree and configuring it.", flush=True)
    for shop in shops:
        shop.prepare()
    targets = build_tree.read_targets(shops[0].build_dir)
    rooms = rooms_of(targets, root)
    drawn = chosen(options, rooms, root)
    tests = {file: tests_for(targets, rooms[room][file], file) for room in drawn
             for file in {file for file, _ in drawn[room]}}
    left_out = [room for room in drawn if not any(any(tests[file]) for file, _ in drawn[room])]
    for room in left_out:
        print(f"{room}: left out, because no test program links it")
        del drawn[room]
    runs = sorted({run for tiers in tests.values() for tier in tiers for run in tier})
    print(f"Building and running {len({run.program for run in runs})} test programs as they are.", flush=True)
    for shop in shops:
        shop.build_and_time(runs)

    run = Run(shops, Journal(WORK / "journal.jsonl", root, options.fresh), root, tests)
    results = {room: found for room, found in run.rooms(
        drawn, sys.maxsize if options.at else options.per_room).items() if found}
    for room, found in with_total(results, "all"):
        print(f"{room:32} {percent(found):5.1f} % of {len(found)}")
    if options.at:
        print("\n".join(f"{result['outcome']:9} {result['before']} -> {result['after'] or '(nothing)'}"
                        for found in results.values() for result in found))
    if options.report:
        write_report(options.report, page(results, options, arguments, left_out))
    return 0 if percent(with_total(results, "all")[-1][1]) >= options.wanted else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
