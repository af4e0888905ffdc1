"""Runs the commands and the Python that a guide prints, as its reader does."""

import contextlib
import os
import pathlib
import re
import shutil
import sys
import tempfile
import unittest

import tools

BLOCK = re.compile(r"^```(sh|python)\n(.*?)^```$", re.MULTILINE | re.DOTALL)


class GuideTest(unittest.TestCase):
    @contextlib.contextmanager
    def a_users_folder(self, leaders=(), files=None, source_package=True):
        """A folder with the samples, those of `leaders` also in `walks`, and copies of `files`,
        {name: path}; and the environment of a user who has the programs, a server, and with
        `source_package` the Python package of the source tree."""
        with tempfile.TemporaryDirectory() as folder, tools.running_server() as server:
            for shared in ("samples", "recipes", "client", "contrib"):
                pathlib.Path(folder, shared).symlink_to(tools.SOURCE / shared)
            for made in ("walks", "blender", "build/release"):
                pathlib.Path(folder, made).mkdir(parents=True)
            pathlib.Path(folder, "build/release/bin").symlink_to(tools.PROGRAMS)
            for leader in leaders:
                shutil.copy(tools.sample(leader), pathlib.Path(folder, "walks"))
            for copied, path in (files or {}).items():
                pathlib.Path(folder, copied).parent.mkdir(parents=True, exist_ok=True)
                shutil.copy(path, pathlib.Path(folder, copied))
            yield folder, {
                **os.environ, "DUET_SERVER": server.address,
                # In place of the preferences and add-ons of whoever runs this test.
                "BLENDER_USER_CONFIG": f"{folder}/blender", "BLENDER_USER_SCRIPTS": f"{folder}/blender",
                # `python3` is the one that runs this test and has the modules.
                "PATH": os.pathsep.join((str(tools.PROGRAMS), str(pathlib.Path(sys.executable).parent),
                                         os.environ["PATH"])),
                "PYTHONPATH": str(tools.SOURCE / "client" / "python") if source_package else "",
                "PIP_NO_INDEX": "1"}

    def run_all(self, blocks, **place):
        """Runs blocks, (language, text), one after the other in a user's folder. Returns their number."""
        with self.a_users_folder(**place) as (folder, environment):
            for language, block in blocks:
                with self.subTest(block=block.splitlines()[0]):
                    ran = self.run_block(language, block, cwd=folder, env=environment)
                    self.assertEqual(ran.returncode, 0, f"{block}\n{ran.stdout}\n{ran.stderr}")
        return len(blocks)

    def run_blocks(self, name, **place):
        """Runs a document's blocks."""
        return self.run_all(BLOCK.findall((tools.SOURCE / name).read_text(encoding="utf-8")), **place)

    def run_block(self, language, block, **options):
        if language == "sh":
            return tools.run("bash", "-e", "-u", "-o", "pipefail", "-c", block, **options)
        return tools.run(sys.executable, "-B", "-c", block, **options)
