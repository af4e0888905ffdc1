#!/usr/bin/env python3
"""Checks who includes whom: fails, naming file and line, when an include crosses a layer.

LAYERS is the whole rule book; ARCHITECTURE.md explains it. A file belongs to the first layer whose
pattern matches its path. It may include its own layer, the layers in `sees`, and of the guarded
libraries only those in `libraries`, directly or through any header of the project. Tests and
benchmarks may include everything.

    scripts/check_layers.py [source folder]
"""

import dataclasses
import fnmatch
import pathlib
import re
import sys


@dataclasses.dataclass(frozen=True)
class Layer:
    name: str
    files: tuple  # patterns; * also matches /
    sees: tuple  # other layers that it may include
    libraries: tuple = ()  # guarded libraries that it may include


TORCH_FREE_MODEL = ("motion", "formats", "dataset", "engine", "checkpoint", "embedded checkpoints")
WHOLE_MODEL = TORCH_FREE_MODEL + ("network", "torch engine", "training")

LAYERS = (
    # The method, innermost first.
    Layer("motion", ("model/motion/*",), sees=()),
    Layer("formats", ("model/formats/*",), sees=("motion",)),
    Layer("dataset", ("model/dataset/*",), sees=("motion", "formats")),
    Layer("torch engine", ("model/engine/torch_*",),
          sees=("motion", "engine", "checkpoint", "embedded checkpoints", "network"),
          libraries=("torch",)),
    Layer("engine", ("model/engine/*",), sees=("motion",)),
    Layer("checkpoint", ("model/checkpoint/*",), sees=("motion", "engine")),
    Layer("embedded checkpoints", ("model/checkpoints/*",), sees=()),
    Layer("network", ("model/network/*",), sees=("motion", "engine", "checkpoint"),
          libraries=("torch",)),
    Layer("training", ("model/training/*",),
          sees=TORCH_FREE_MODEL + ("network", "torch engine"), libraries=("torch",)),
    # The headers are the torch-free layer's.
    Layer("torch evaluation", ("model/evaluation/judge/*.cc",), sees=WHOLE_MODEL + ("evaluation",),
          libraries=("torch",)),
    Layer("augmentation experiment", ("model/evaluation/augmentation/*",),
          sees=TORCH_FREE_MODEL + ("evaluation", "training")),
    Layer("evaluation program", ("model/evaluation/eval_main.cc", "model/evaluation/commands/*"),
          sees=TORCH_FREE_MODEL + ("evaluation", "augmentation experiment", "torch engine")),
    Layer("evaluation", ("model/evaluation/*",), sees=TORCH_FREE_MODEL),
    # The programs around it.
    Layer("server main", ("server/main.cc",),
          sees=("server", "motion", "engine", "checkpoint", "embedded checkpoints", "torch engine"),
          libraries=("rpc", "prometheus")),
    Layer("server", ("server/*",), sees=("motion", "engine"), libraries=("rpc", "prometheus")),
    Layer("viewer", ("client/viewer/*",), sees=("motion", "client")),
    Layer("client program", ("client/cli/*",), sees=("motion", "formats", "viewer", "client")),
    Layer("client", ("client/*",), sees=("motion",), libraries=("rpc",)),
)

# Libraries that only some layers may know, by the start of the include path.
GUARDED_LIBRARIES = {
    "torch": ("torch/", "ATen/", "c10/", "caffe2/"),
    "rpc": ("grpc/", "grpcpp/", "grpc++/", "google/", "duet/v1/", "duet/rpc/"),
    "prometheus": ("prometheus/",),
}

SOURCE_FOLDERS = ("model", "server", "client")
INCLUDE = re.compile(r'^\s*#\s*include\s*["<]([^">]+)[">]')


def layer_of(path):
    for layer in LAYERS:
        if any(fnmatch.fnmatchcase(path, pattern) for pattern in layer.files):
            return layer
    return None


def library_of(include):
    for library, prefixes in GUARDED_LIBRARIES.items():
        if include.startswith(prefixes):
            return library
    return None


def read_includes(root):
    """Every C++ file of the source folders, with its includes as (line number, path)."""
    includes = {}
    for folder in SOURCE_FOLDERS:
        for file in sorted((root / folder).rglob("*")):
            if file.suffix in (".h", ".cc", ".inc"):
                lines = file.read_text(encoding="utf-8").splitlines()
                matches = ((n, INCLUDE.match(line)) for n, line in enumerate(lines, start=1))
                includes[file.relative_to(root).as_posix()] = [(n, m[1]) for n, m in matches if m]
    return includes


def way_to_library(include, library, includes, seen):
    """The chain of includes that leads from `include` to the library, or None."""
    if library_of(include) == library:
        return [include]
    if include in seen:
        return None
    seen.add(include)
    for _, next_include in includes.get(include, ()):
        way = way_to_library(next_include, library, includes, seen)
        if way:
            return [include] + way
    return None


def check_include(layer, include, includes):
    """What is wrong with a file of `layer` including `include`, as messages."""
    if include.startswith(tuple(f"{folder}/" for folder in SOURCE_FOLDERS)):
        target = layer_of(include)
        if target and target is not layer and target.name not in layer.sees:
            sees = ", ".join(layer.sees) or "no other layer"
            yield (f'layer "{layer.name}" includes {include} of layer "{target.name}"; '
                   f"it sees {sees}")
    for library in GUARDED_LIBRARIES:
        if library not in layer.libraries:
            way = way_to_library(include, library, includes, seen=set())
            if way:
                yield f'layer "{layer.name}" reaches {library} by ' + " -> ".join(way)


def check(root):
    """Every violation below `root`, as "path:line: message"."""
    includes = read_includes(root)
    for path, lines in includes.items():
        layer = layer_of(path)
        if layer is None:
            yield f"{path}:1: belongs to no layer; add its folder to LAYERS in check_layers.py"
            continue
        for line, include in lines:
            for message in check_include(layer, include, includes):
                yield f"{path}:{line}: {message}"


def main(arguments):
    root = pathlib.Path(arguments[0] if arguments else pathlib.Path(__file__).parent.parent)
    violations = list(check(root))
    for violation in violations:
        print(violation, file=sys.stderr)
    if violations:
        print(f"{len(violations)} includes cross a layer.", file=sys.stderr)
        return 1
    print(f"{len(read_includes(root))} files keep to {len(LAYERS)} layers.")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
