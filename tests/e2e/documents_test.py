"""The tour, the cookbook, the guides to batches, to training, to FBX and to the layouts of research, and
the page on rotations do what they say: their commands and their Python run as they are printed, against
a real server that they find by DUET_SERVER, as they say."""

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

BLOCK = re.compile(r"^```(sh|python)\n(.*?)^```$", re.MULTILINE | re.DOTALL)


class DocumentsTest(unittest.TestCase):
    def run_blocks(self, name, leaders=(), files=None):
        """Runs a document's blocks one after the other, in a folder with the sample leaders of these
        names in `walks`, and with copies of `files`, {name: path}."""
        text = (tools.SOURCE / "docs" / name).read_text(encoding="utf-8")
        blocks = BLOCK.findall(text)
        with tempfile.TemporaryDirectory() as folder, tools.running_server() as server:
            for shared in ("samples", "recipes", "client"):
                pathlib.Path(folder, shared).symlink_to(tools.SOURCE / shared)
            pathlib.Path(folder, "walks").mkdir()
            for leader in leaders:
                shutil.copy(tools.sample(leader), pathlib.Path(folder, "walks"))
            for copied, path in (files or {}).items():
                shutil.copy(path, pathlib.Path(folder, copied))
            environment = {
                **os.environ, "DUET_SERVER": server.address, "DUET_CONFIG": "",
                # `python3` is the one that runs this test and has the modules.
                "PATH": os.pathsep.join((str(tools.PROGRAMS), str(pathlib.Path(sys.executable).parent),
                                         os.environ["PATH"])),
                "PYTHONPATH": str(tools.SOURCE / "client" / "python")}
            for language, block in blocks:
                with self.subTest(block=block.splitlines()[0]):
                    ran = self.run_block(language, block, cwd=folder, env=environment)
                    self.assertEqual(ran.returncode, 0, f"{block}\n{ran.stdout}\n{ran.stderr}")
        return len(blocks)

    def run_block(self, language, block, **options):
        if language == "sh":
            return tools.run("bash", "-e", "-u", "-o", "pipefail", "-c", block, **options)
        return tools.run(sys.executable, "-B", "-c", block, **options)

    def test_the_tour(self):
        self.assertGreaterEqual(self.run_blocks("guides/tour.md"), 7)

    def test_the_cookbook(self):
        self.assertGreaterEqual(self.run_blocks("guides/cookbook.md"), 17)

    def test_the_forward_kinematics_of_rotations(self):
        self.assertEqual(self.run_blocks("rotations.md"), 2)

    def test_the_layouts_of_research(self):
        self.assertEqual(self.run_blocks("guides/research_layouts.md"), 7)

    @unittest.skipUnless(shutil.which("blender") and (tools.PROGRAMS / "duet-fbx").exists(),
                         "no blender, or duet was built without libassimp-dev")
    def test_fbx(self):
        files = tools.SOURCE / "tests/formats/fbx/files"
        self.assertEqual(self.run_blocks("guides/fbx.md", files={
            "kick.fbx": files / "two_takes_30.fbx", "character.fbx": files / "still_skin.fbx"}), 3)

    def test_from_a_data_set_to_training(self):
        if importlib.util.find_spec("pandas") is None:
            tools.skip("no Python module pandas; install the package python3-pandas")
        self.assertGreaterEqual(self.run_blocks("guides/data_set_to_training.md"), 5)

    def test_from_leaders_to_a_training_set(self):
        self.assertGreaterEqual(self.run_blocks("batch.md", leaders=("hug", "kick", "push")), 3)


if __name__ == "__main__":
    tools.main()
