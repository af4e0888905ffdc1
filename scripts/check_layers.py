#!/usr/bin/env python3
"""Checks that includes follow the layers; reports file and line of each include that does not.

LAYERS has all rules; ARCHITECTURE.md explains them. A file belongs to the first layer whose folder
contains it. It may include its own layer, the layers in `sees`, and, of the guarded libraries, only those
in `libraries` (in `source_libraries`: only from .cc files), directly or through any header of the
project. Its namespace is its folder's path. Tests and benchmarks may include everything of the layers.
A tool of contrib may include everything but another tool; nothing outside contrib includes a tool.

    scripts/check_layers.py [source folder]
"""

import dataclasses
import pathlib
import re
import sys


@dataclasses.dataclass(frozen=True)
class Layer:
    name: str
    folder: str  # with its subfolders, except those of earlier layers
    sees: tuple  # other layers that it may include
    libraries: tuple = ()  # guarded libraries that it may include
    source_libraries: tuple = ()  # the same, but not from its headers


MOTION_FILES = ("base", "motion", "retargeting", "flat formats", "bvh format", "gltf format",
                "formats")
MODELS = ("engine", "checkpoint", "embedded checkpoints", "network", "training")
MEASURING = ("metrics", "baselines", "judge", "report")
SERVER = ("server common", "batching", "registry", "server metrics", "security",
          "server config", "service", "admin", "lifecycle")

LAYERS = (
    # The method, innermost first.
    Layer("base", "model/base", sees=()),
    Layer("messages", "model/messages", sees=("base",), libraries=("rpc",)),
    Layer("motion", "model/motion", sees=("base",)),
    Layer("retargeting", "model/retargeting", sees=("base", "motion")),
    Layer("flat formats", "model/formats/flat", sees=("base", "motion")),
    Layer("bvh format", "model/formats/bvh", sees=("base", "motion", "retargeting")),
    Layer("gltf format", "model/formats/gltf", sees=("base", "motion", "retargeting")),
    Layer("formats", "model/formats",
          sees=("base", "motion", "retargeting", "flat formats", "bvh format", "gltf format")),
    Layer("authoring", "model/authoring", sees=("base", "motion")),
    Layer("dataset", "model/dataset", sees=MOTION_FILES),
    Layer("body", "model/body", sees=("base", "motion")),
    Layer("solver", "model/solver", sees=("base", "motion", "body")),
    Layer("importing", "model/importing", sees=MOTION_FILES + ("dataset", "body", "solver")),
    Layer("engine", "model/engine", sees=("base", "motion", "body", "solver")),
    Layer("checkpoint", "model/checkpoint", sees=("base", "motion", "engine")),
    Layer("embedded checkpoints", "model/embedded", sees=()),
    Layer("cpu kernels", "model/cpu_engine/kernels", sees=(), libraries=("highway",)),
    Layer("cpu engine", "model/cpu_engine",
          sees=("base", "motion", "engine", "checkpoint", "embedded checkpoints", "cpu kernels")),
    Layer("network", "model/network", sees=("base", "motion", "engine", "checkpoint"),
          libraries=("torch",)),
    Layer("training", "model/training",
          sees=("base", "motion", "body", "retargeting", "dataset", "engine", "checkpoint",
                "network"),
          libraries=("torch",), source_libraries=("rpc",)),
    # Evaluation.
    Layer("metrics", "model/evaluation/metrics", sees=("base", "motion", "body", "dataset")),
    Layer("baselines", "model/evaluation/baselines",
          sees=("base", "motion", "dataset", "metrics")),
    Layer("judge", "model/evaluation/judge",
          sees=("base", "motion", "dataset", "engine", "checkpoint", "network",
                "training", "metrics"),
          source_libraries=("torch",)),
    Layer("report", "model/evaluation/report",
          sees=("base", "motion", "dataset", "metrics")),
    Layer("evaluation program", "model/evaluation/program",
          sees=MOTION_FILES + ("authoring", "body", "dataset", "solver", "engine", "checkpoint",
                                "cpu kernels", "cpu engine", "network", "training") + MEASURING),
    # The server, innermost first.
    Layer("server common", "server/common", sees=("base",), libraries=("rpc",)),
    Layer("batching", "server/batching", sees=("base", "motion", "engine", "server common")),
    Layer("registry", "server/registry", sees=("base", "motion", "engine", "server common")),
    Layer("server metrics", "server/metrics",
          sees=("base", "engine", "batching", "registry", "server common"),
          libraries=("prometheus",)),
    Layer("security", "server/security", sees=("base", "server common"), libraries=("rpc",)),
    Layer("server config", "server/config", sees=("base", "messages", "server common"),
          libraries=("rpc",)),
    Layer("service", "server/service",
          sees=("base", "motion", "body", "retargeting", "engine", "server common", "batching",
                "registry", "server metrics", "security"),
          libraries=("rpc", "prometheus")),
    Layer("admin", "server/admin",
          sees=("base", "engine", "server common", "batching", "registry", "server metrics",
                "security", "service"),
          libraries=("rpc", "prometheus")),
    Layer("lifecycle", "server/lifecycle", sees=("base", "motion", "engine") + SERVER,
          libraries=("rpc", "prometheus")),
    Layer("server program", "server/program",
          sees=("base", "motion", "engine", "checkpoint", "cpu kernels", "cpu engine") + SERVER,
          libraries=("rpc", "prometheus")),
    # The client.
    Layer("viewer", "client/viewer", sees=("base", "motion", "client")),
    Layer("batch flow", "client/batch/flow", sees=()),
    Layer("batch", "client/batch",
          sees=MOTION_FILES + ("messages", "body", "batch flow", "client"),
          libraries=("rpc",)),
    Layer("live", "client/live", sees=MOTION_FILES + ("client",)),
    Layer("client program", "client/cli",
          sees=MOTION_FILES + ("messages", "body", "viewer", "batch flow", "batch",
                                "live", "client"),
          source_libraries=("rpc",)),
    Layer("client", "client", sees=("base", "motion"), libraries=("rpc",)),
)

# Libraries that only some layers may use, by the start of the include path.
GUARDED_LIBRARIES = {
    "torch": ("torch/", "ATen/", "c10/", "caffe2/"),
    "highway": ("hwy/",),
    "rpc": ("grpc/", "grpcpp/", "grpc++/", "google/", "duet/v1/", "duet/rpc/",
            "duet/admin/"),
    "prometheus": ("prometheus/",),
}

SOURCE_FOLDERS = ("model", "server", "client")
# Folders outside of the layers.
CONTRIB = "contrib"
FREE_FOLDERS = ("tests", "benchmarks", CONTRIB)
# Folders whose namespace is not their path.
NAMESPACES = {"client/mocks": "duet::client"}
NAMESPACE = re.compile(r"^namespace (duet[\w:]*) \{")
INCLUDE = re.compile(r'^\s*#\s*include\s*["<]([^">]+)[">]')


def layer_of(path):
    for layer in LAYERS:
        if path.startswith(layer.folder + "/"):
            return layer
    return None


def library_of(include):
    for library, prefixes in GUARDED_LIBRARIES.items():
        if include.startswith(prefixes):
            return library
    return None


def read_includes(root):
    """Every C++ file, with its includes as (line number, path)."""
    includes = {}
    for folder in SOURCE_FOLDERS + FREE_FOLDERS:
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


def tool_of(path):
    """The folder of the tool that a file belongs to, such as contrib/load; None outside of contrib."""
    folders = path.split("/")
    return "/".join(folders[:2]) if folders[0] == CONTRIB else None


def check_tool(path, include):
    """The messages about a file that includes a tool of contrib."""
    if tool_of(include) not in (None, tool_of(path)):
        yield f"includes {include} of {tool_of(include)}; only this tool itself may"


def check_include(layer, path, include, includes):
    """The messages about an include of the file at `path` in `layer`."""
    if include.startswith(tuple(f"{folder}/" for folder in SOURCE_FOLDERS)):
        target = layer_of(include)
        if target and target is not layer and target.name not in layer.sees:
            sees = ", ".join(layer.sees) or "no other layer"
            yield (f'layer "{layer.name}" includes {include} of layer "{target.name}"; '
                   f"it sees {sees}")
    for library in GUARDED_LIBRARIES:
        libraries = layer.libraries + (layer.source_libraries if path.endswith(".cc") else ())
        if library not in libraries:
            way = way_to_library(include, library, includes, seen=set())
            if way:
                yield f'layer "{layer.name}" reaches {library} by ' + " -> ".join(way)


def namespace_of(path):
    """The namespace of a file's folder: duet::formats::bvh for model/formats/bvh."""
    folders = pathlib.PurePosixPath(path).parent.parts
    return "::".join(("duet",) + (folders[1:] if folders[0] == "model" else folders))


def check_namespaces(root, path):
    """The namespaces in a file other than its folder's, as (line, message). Tests choose theirs."""
    if "tests" in path.split("/") or path.startswith("benchmarks/"):
        return
    wanted = NAMESPACES.get(str(pathlib.PurePosixPath(path).parent)) or namespace_of(path)
    for number, line in enumerate((root / path).read_text(encoding="utf-8").splitlines(), start=1):
        opened = NAMESPACE.match(line)
        # Highway's macro is a namespace for each instruction set.
        if opened and opened[1].removesuffix("::HWY_NAMESPACE") != wanted:
            yield number, f"namespace: expected {wanted}, got {opened[1]}"


def check(root):
    """Every violation below `root`, as "path:line: message"."""
    includes = read_includes(root)
    for path, lines in includes.items():
        layer = layer_of(path)
        if layer is None and not path.startswith(tuple(f"{folder}/" for folder in FREE_FOLDERS)):
            yield f"{path}:1: expected a folder of a layer; add it to LAYERS in check_layers.py"
            continue
        for line, include in lines:
            for message in check_tool(path, include):
                yield f"{path}:{line}: {message}"
            for message in check_include(layer, path, include, includes) if layer else ():
                yield f"{path}:{line}: {message}"
        for line, message in check_namespaces(root, path):
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
