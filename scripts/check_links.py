#!/usr/bin/env python3
"""Checks that each target links what its files include, and nothing else.

Reads a configured build folder (cmake/DuetTargetTable.cmake writes the table). For each library,
program and test:
  - libraries that a header of the target includes are linked PUBLIC (DEPS); libraries that only its .cc
    files and the headers of a folder named internal include are linked PRIVATE (PRIVATE_DEPS);
  - programs, tests and benchmarks have no public headers, so they link everything PRIVATE;
  - each linked library is included somewhere; ALLOWED lists exceptions with their reasons.
A header belongs to the library that has the source file of its name, else to the library of its folder.

    scripts/check_links.py [--build-dir build/release] [--suggest [target...]]
"""

import argparse
import pathlib
import re
import sys

import build_tree
import source_tree

# The library of an external include, by the start of its path; the first match counts. If there are several
# names, any of them is accepted.
LIBRARIES = (
    ("absl/strings/str_format.h", "absl::str_format"),
    ("absl/strings/cord.h", "absl::cord"),
    ("absl/strings/", "absl::strings"),
    ("absl/status/statusor.h", "absl::statusor"),
    ("absl/status/", "absl::status"),
    ("absl/time/", "absl::time"),
    ("absl/synchronization/", "absl::synchronization"),
    ("absl/random/", "absl::random_random"),
    ("nlohmann/", "nlohmann_json::nlohmann_json"),
    ("CLI/", "CLI11::CLI11"),
    ("Eigen/", "Eigen3::Eigen"),
    ("hwy/", "hwy::hwy"),
    ("assimp/", "assimp::assimp"),
    ("dlfcn.h", "dl"),
    ("prometheus/", "prometheus-cpp::core"),
    ("openssl/", "OpenSSL::Crypto", "OpenSSL::SSL"),
    ("zlib.h", "ZLIB::ZLIB"),
    ("cblas.h", "openblas"),
    ("gmock/", "GTest::gmock"),
    ("gtest/", "GTest::gtest", "GTest::gmock"),
    ("benchmark/", "benchmark::benchmark_main", "benchmark::benchmark"),
    *((start, build_tree.TORCH_TARGET) for start in source_tree.TORCH),
    ("grpcpp/ext/proto_server_reflection_plugin.h", "gRPC::grpc++_reflection"),
    # Code that uses the protocol links the generated code, which links both.
    ("grpc", "gRPC::grpc++", "duet_proto", "duet_server_proto"),
    ("google/protobuf/", "protobuf::libprotobuf", "duet_proto", "duet_server_proto",
     "duet_batch_proto"),
)

# Headers of the C++ library with their own target. An unused link is reported, but not a missing one, because
# the C library provides them as well.
OPTIONAL = {"Threads::Threads": ("thread", "mutex", "condition_variable", "future")}

# Links without an include, and includes without a link: (target or *, library) -> reason.
ALLOWED = {
    ("*", "GTest::gtest_main"): "the main() of every test",
    ("*", "GTest::gmock"): "linked to every test by duet_test",
    ("*", "benchmark::benchmark_main"): "the main() of every benchmark",
    ("duet_client", "GTest::gmock"): "mocks/ is for callers' tests, which link it",
}


def libraries_of(include):
    """The names of the external library of an include; empty for the standard library."""
    for start, *names in LIBRARIES:
        if include.startswith(start):
            return frozenset(names)
    match = re.match(r"absl/\w+/(\w+)\.h", include)
    return frozenset({f"absl::{match[1]}"}) if match else frozenset()


def link_name(link):
    """The name of a library that is linked by its file."""
    match = re.search(r"/lib(\w+)\.(so|a)$", link)
    return match[1] if match else link


class Owners:
    """Finds the library of a file of the project."""

    def __init__(self, targets):
        self.targets = targets
        self.by_source, self.by_folder, self.generated = {}, {}, {}
        for name, target in targets.items():
            for source in target.sources if target.is_library else ():
                path = pathlib.PurePosixPath(source)
                self.by_source[str(path.with_suffix(""))] = name
                self.by_folder.setdefault(str(path.parent), set()).add(name)
                if path.suffixes[-2:] == [".pb", ".h"]:
                    self.generated[source.partition("/gen/")[2]] = name

    def of(self, include):
        """The names of the libraries that may contain the header; empty if it is not the project's."""
        if include in self.generated:
            return frozenset({self.generated[include]})
        if not include.startswith(tuple(f"{f}/" for f in source_tree.SOURCE_FOLDERS)):
            return frozenset()
        path = pathlib.PurePosixPath(include)
        owner = self.by_source.get(str(path.with_suffix("")))
        if owner:
            return frozenset({owner})
        for folder in path.parents:
            if str(folder) in self.by_folder:
                return self.innermost(self.by_folder[str(folder)])
        return frozenset()

    def is_built(self, header, sources):
        """Whether the source file of a header's name, if there is one, belongs to a library. A build without
        training leaves some out."""
        path = pathlib.PurePosixPath(header)
        return str(path.with_suffix(".cc")) not in sources or str(path.with_suffix("")) in self.by_source

    def innermost(self, names):
        """The library of a folder that all others there link; all of them if there is none."""
        for name in names:
            if all(name in build_tree.closure(self.targets, other) for other in names):
                return frozenset({name})
        return frozenset(names)


class LinkCheck:
    def __init__(self, targets, tree):
        self.targets, self.tree, self.owners = targets, tree, Owners(targets)
        self.headers = {}  # library -> its headers
        sources = set(tree.files(".cc"))
        for header in tree.files(".h"):
            if not self.owners.is_built(header, sources):
                continue
            for owner in self.owners.of(header):
                self.headers.setdefault(owner, []).append(header)

    def needs(self, target, files):
        """The other libraries that the files include: accepted names -> an example."""
        needs = {}
        for file in files:
            for include in self.tree.includes(file):
                libraries = self.owners.of(include) or libraries_of(include)
                if libraries and target.name not in libraries:
                    needs.setdefault(libraries, f"{file} includes {include}")
        return needs

    def needs_of(self, target):
        """The needs of public headers, the needs of all files, and those files."""
        headers = self.headers.get(target.name, []) if target.is_library else []
        files = headers + [source for source in target.sources if source.endswith(".cc")
                           and self.tree.exists(source) and not source.startswith("build/")]
        shown = [header for header in headers if "/internal/" not in header]
        public = self.needs(target, shown)
        return public, {**self.needs(target, files), **public}, files

    def optional(self, files):
        included = {include for file in files for include in self.tree.includes(file)}
        return {name for name, headers in OPTIONAL.items() if included.intersection(headers)}

    def check(self, target):
        """The problems of a target as messages."""
        public, every, files = self.needs_of(target)
        # Of a library that is linked by its file CMake does not tell whether the link is private.
        linked = {link_name(link): link in target.public and "/" not in link
                  for link in target.links}
        excused = {name for about, name in ALLOWED if about in ("*", target.name)}
        for libraries, example in sorted(every.items(), key=lambda need: sorted(need[0])):
            present = libraries.intersection(linked)
            kind = "PUBLIC" if libraries in public else "PRIVATE"
            if not present and not libraries & excused:
                yield f"does not link {' or '.join(sorted(libraries))} ({kind}): {example}"
            elif present and kind == "PUBLIC" and not any(linked[name] for name in present):
                yield f"links {min(present)}: expected PUBLIC, got PRIVATE: {example}"
        unseen = self.optional(files) | excused
        for link, is_public in linked.items():
            if not any(link in libraries for libraries in every):
                if link not in unseen:
                    yield f"links {link} but does not include it"
            elif is_public and not any(link in libraries for libraries in public):
                yield f"links {link}: expected PRIVATE, got PUBLIC: no header includes it"

    def violations(self):
        """Every violation, as "target: message"."""
        for name, target in self.targets.items():
            if is_ours(target):
                yield from (f"{name}: {message}" for message in self.check(target))

    def wanted(self, target):
        """The expected links of a target: (public, private), by name."""
        public, every, files = self.needs_of(target)
        linked = {link_name(link): link for link in target.links}
        excused = {name for about, name in ALLOWED if about in ("*", target.name)}

        def choose(needs):
            met = {linked[name] for libraries in needs for name in libraries - excused
                   if name in linked}
            return met | {min(libraries) for libraries in needs
                          if not libraries & (excused | set(linked))}
        private = choose(every) | {linked[name] for name in self.optional(files) if name in linked}
        return sorted(choose(public)), sorted(private - choose(public))

def is_ours(target):
    """Whether a target has sources that are not generated."""
    return any(not source.startswith("build/") for source in target.sources)


def as_written(links):
    """Links as a CMakeLists.txt lists them: by alias, the project's own first."""
    aliases = (re.sub("^duet_", "duet::", link) for link in links)
    return sorted(aliases, key=lambda link: (not link.startswith("duet::"), link))


def suggest(checker, names):
    """Prints the expected links of each target in the form of its CMakeLists.txt."""
    for name in names or [name for name, target in checker.targets.items() if is_ours(target)]:
        target = checker.targets[name]
        public, private = checker.wanted(target)
        lists = (("DEPS", public), ("PRIVATE_DEPS", private)) if target.is_library else (
            ("DEPS", [*public, *private]),)
        print(name)
        for kind, links in lists:
            print(" ", kind, *as_written(links))


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--build-dir", default=str(build_tree.ROOT / "build/release"))
    parser.add_argument("--suggest", nargs="*", metavar="TARGET",
                        help="print the expected links of these targets (default: all) and exit")
    options = parser.parse_args(arguments)
    build_tree.require_configured(options.build_dir)
    targets = build_tree.read_targets(options.build_dir)
    checker = LinkCheck(targets, source_tree.SourceTree(build_tree.ROOT))
    if options.suggest is not None:
        suggest(checker, options.suggest)
        return 0
    violations = list(checker.violations())
    for violation in violations:
        print(violation, file=sys.stderr)
    if violations:
        print(f"{len(violations)} links differ from the includes "
              "(check_links.py --suggest TARGET says what a target should link).", file=sys.stderr)
        return 1
    print(f"{sum(map(is_ours, targets.values()))} targets link exactly the libraries that they include.")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
