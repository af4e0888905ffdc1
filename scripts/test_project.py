"""A small project in a temporary folder for the self-tests of the checks."""

import json
import os
import pathlib
import tempfile
import unittest
import unittest.mock

import build_tree


class ProjectTestCase(unittest.TestCase):
    """Each test gets an empty project at self.root with a configured build folder."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name).resolve()
        self.build_dir = self.root / "build/release"
        self.build_dir.mkdir(parents=True)
        self.targets, self.commands = [], []
        for patch in (unittest.mock.patch.object(build_tree, "ROOT", self.root),
                      unittest.mock.patch.dict(os.environ, JOBS="1")):
            patch.start()
            self.addCleanup(patch.stop)

    def write(self, path, *includes, text=""):
        file = self.root / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text("".join(f"#include <{i}>\n" for i in includes) + text, encoding="utf-8")

    def compile_command(self, path, *flags):
        """Enters a source file in the compile commands."""
        command = f"ccache /usr/bin/c++ -I{self.root} {' '.join(flags)} -O3 -std=c++17 -o x.o -c"
        self.commands.append({"directory": str(self.build_dir), "file": str(self.root / path),
                              "command": f"{command} {self.root / path}"})
        self.save()

    def target(self, name, sources, public=(), private=(), kind="STATIC_LIBRARY",
               runs=()):
        """Enters a target in the table."""
        self.targets.append({"name": name, "type": kind, "sources": list(sources),
                             "public": list(public), "private": list(private),
                             "runs": list(runs)})
        self.save()

    def save(self):
        (self.build_dir / "targets.json").write_text(json.dumps(self.targets))
        (self.build_dir / "compile_commands.json").write_text(json.dumps(self.commands))
