#!/usr/bin/env python3
"""Divides the sources of targets into batches that compile as one file (cmake/DuetBatches.cmake).

In a batch, a name that one file keeps to itself is visible in the files after it. So that no file changes its meaning, it joins only
if neither it nor a header that it adds mentions an own name of a file before it (cpp_names.py).

    scripts/batch_sources.py BUILD_FOLDER TARGET...     prints CMake code that sets UNITY_GROUP
"""

import pathlib
import sys

import build_tree
import cpp_names
import source_tree

SIZE = 8  # files; 16 would save another tenth, and double what an edited file compiles again


class Batches:
    def __init__(self, tree, size=SIZE):
        self.tree, self.size, self.names = tree, size, {}

    def of(self, sources):
        """The batches of a target's sources, each file in the first one that takes it."""
        batches = []
        for source in sources:
            self.names[source] = cpp_names.read_names((self.tree.root / source).read_text(encoding="utf-8"))
            batch = next((batch for batch in batches if self.fits(source, batch)), None)
            if batch is None:
                batches.append([source])
            else:
                batch.append(source)
        return batches

    def fits(self, source, batch):
        if len(batch) == self.size or self.names[source].alone or self.names[batch[0]].alone:
            return False
        included = frozenset()  # before the own names of `other`
        for other in batch:
            included |= self.tree.reach(other)
            if self.mentions_own_name_of(other, source, included):
                return False
        return True

    def mentions_own_name_of(self, other, source, included):
        """Whether `source`, or a header that it adds to those `included`, mentions a name that `other` keeps to itself."""
        names, own = self.names[source], self.names[other].own
        foreign = {name: one for name, one in own.items()
                   if one.alias is None or name not in names.own or names.own[name].alias != one.alias}
        headers = self.tree.reach(source) - included
        files = [names] + [cpp_names.names_of(self.tree.root / header) for header in headers if self.tree.exists(header)]
        return any(file.can_reach(name, one) for file in files for name, one in foreign.items())


def sources_of(target, build_dir):
    """The C++ files of a target that exist before the build."""
    files = ((source, build_tree.ROOT / source) for source in target.sources if source.endswith(".cc"))
    return [source for source, file in files if file.is_file() and not file.is_relative_to(build_dir)]


def cmake_code(target, batches):
    for number, batch in enumerate(batches):
        if len(batch) > 1:
            files = " ".join(f'"{build_tree.ROOT / source}"' for source in batch)
            yield f"set_source_files_properties({files} TARGET_DIRECTORY {target} PROPERTIES UNITY_GROUP {number})"


def main(arguments):
    build_dir, names = pathlib.Path(arguments[0]).resolve(), arguments[1:]
    targets = build_tree.read_targets(build_dir)
    batches = Batches(source_tree.SourceTree(build_tree.ROOT))
    for name in names:
        for line in cmake_code(name, batches.of(sources_of(targets[name], build_dir))):
            print(line)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
