"""The project's C++ files and their includes."""

import functools
import pathlib
import re

SOURCE_FOLDERS = ("model", "server", "client", "tests", "benchmarks", "contrib")
INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^">]+)[">]')


class SourceTree:
    """Paths are relative to `root`, with slashes."""

    def __init__(self, root):
        self.root = pathlib.Path(root)

    def files(self, suffix):
        """Every file below the source folders that ends in `suffix`."""
        return [file.relative_to(self.root).as_posix() for folder in SOURCE_FOLDERS
                for file in sorted((self.root / folder).rglob("*" + suffix))]

    def exists(self, path):
        return (self.root / path).is_file()

    @functools.lru_cache(maxsize=None)
    def includes(self, path):
        """The includes of a file in order: the project's files by path, others as written."""
        if not self.exists(path):
            return ()
        lines = (self.root / path).read_text(encoding="utf-8").splitlines()
        return tuple(self._resolve(path, match[1]) for match in map(INCLUDE.match, lines) if match)

    def _resolve(self, path, include):
        sibling = (pathlib.PurePosixPath(path).parent / include).as_posix()
        return sibling if not self.exists(include) and self.exists(sibling) else include

    @functools.lru_cache(maxsize=None)
    def reach(self, path):
        """All includes of a file, directly or through the project's headers."""
        found, waiting = set(), [path]
        while waiting:
            for include in self.includes(waiting.pop()):
                if include not in found:
                    found.add(include)
                    waiting.append(include)
        return frozenset(found)
