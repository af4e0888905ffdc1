"""The calls of the first page and of the release notes, the tour, the cookbook, the guides to batches, to
training, to FBX, to Blender, to the layouts of research and to reading in Python, and the page on rotations do what
they say: their commands and their Python run as they are printed, against a real server that they find by
DUET_SERVER, as they say."""

import contextlib
import importlib.util
import os
import pathlib
import re
import shutil
import sys
import tempfile
import unittest

import tools

for module, package in (("grpc", "python3-grpcio"), ("numpy", "python3-numpy")):
    if importlib.util.find_spec(module) is None:
        tools.skip(f"no Python module {module}; install the package {package}")

# A call of the client, as the first page and the release notes print it.
CALL = re.compile(r"^ *(build/release/bin/duet .*)$", re.MULTILINE)
BLOCK = re.compile(r"^```(sh|python)\n(.*?)^```$", re.MULTILINE | re.DOTALL)


class DocumentsTest(unittest.TestCase):
    @contextlib.contextmanager
    def a_users_folder(self, leaders=(), files=None, source_package=True):
        """A folder with the samples, those of `leaders` also in `walks`, and copies of `files`,
        {name: path}; and the environment of a user who has the programs, a server, and with
        `source_package` the Python package of the source tree."""
        with tempfile.TemporaryDirectory() as folder, tools.running_server() as server:
            for shared in ("samples", "recipes", "client"):
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
                **os.environ, "DUET_SERVER": server.address, "DUET_CONFIG": "",
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
        return self.run_all(BLOCK.findall((tools.SOURCE / "docs" / name).read_text(encoding="utf-8")), **place)

    def run_block(self, language, block, **options):
        if language == "sh":
            return tools.run("bash", "-e", "-u", "-o", "pipefail", "-c", block, **options)
        return tools.run(sys.executable, "-B", "-c", block, **options)

    def test_the_first_page_and_the_release_notes(self):
        for name in ("README.md", "docs/releases/1.0.0.md"):
            calls = CALL.findall((tools.SOURCE / name).read_text(encoding="utf-8"))
            with self.subTest(name=name):
                self.assertGreaterEqual(self.run_all([("sh", call) for call in calls]), 1)

    def test_the_tour(self):
        self.assertGreaterEqual(self.run_blocks("guides/tour.md"), 7)

    def test_the_cookbook(self):
        self.assertGreaterEqual(self.run_blocks("guides/cookbook.md"), 17)

    def test_rotations(self):
        self.assertEqual(self.run_blocks("rotations.md"), 4)

    def test_the_layouts_of_research(self):
        self.assertEqual(self.run_blocks("guides/research_layouts.md"), 5)

    @unittest.skipUnless(shutil.which("blender") and (tools.PROGRAMS / "duet-fbx").exists(),
                         "no blender, or duet was built without libassimp-dev")
    def test_fbx(self):
        files = tools.SOURCE / "tests/formats/fbx/files"
        self.assertEqual(self.run_blocks("guides/fbx.md", files={
            "kick.fbx": files / "two_takes_30.fbx", "character.fbx": files / "still_skin.fbx"}), 3)

    @unittest.skipUnless(shutil.which("blender"), "no blender; install the package blender")
    def test_the_first_ten_minutes_in_blender(self):
        self.assertEqual(self.run_blocks("guides/blender.md"), 3)

    def test_reading_in_python(self):
        for module, package in (("build", "python3-build"), ("ensurepip", "python3-venv")):
            if importlib.util.find_spec(module) is None:
                self.skipTest(f"no Python module {module}; install the package {package}")
        build = tools.PROGRAMS.parent
        if not list((build / "python" / "duet_motion").glob("_motion_files.*.so")):
            self.skipTest("no extension module; build duet_python_module")
        with tempfile.TemporaryDirectory() as folder:
            tools.run(tools.SOURCE / "scripts" / "build_python.sh", folder, build).check_returncode()
            wheel, = pathlib.Path(folder).glob("*.whl")
            self.assertEqual(self.run_blocks("guides/python_reading.md", source_package=False,
                                             files={f"build/python/{wheel.name}": wheel}), 4)

    def test_from_a_data_set_to_training(self):
        if importlib.util.find_spec("pandas") is None:
            tools.skip("no Python module pandas; install the package python3-pandas")
        self.assertGreaterEqual(self.run_blocks("guides/data_set_to_training.md"), 5)

    def test_from_leaders_to_a_training_set(self):
        self.assertGreaterEqual(self.run_blocks("batch.md", leaders=("hug", "kick", "push")), 3)


if __name__ == "__main__":
    tools.main()
