"""The calls of the first page and of the release notes, the tour, the cookbook, the guides to batches, to
training, to the layouts of research and to reading in Python, and the page on rotations do what
they say: their commands and their Python run as they are printed, against a real server that they find by
DUET_SERVER, as they say."""

import importlib.util
import pathlib
import re
import tempfile

import guides
import tools

for module, package in (("grpc", "python3-grpcio"), ("numpy", "python3-numpy")):
    if importlib.util.find_spec(module) is None:
        tools.skip(f"no Python module {module}; install the package {package}")

# A call of the client, as the first page and the release notes print it.
CALL = re.compile(r"^ *(build/release/bin/duet .*)$", re.MULTILINE)


class DocumentsTest(guides.GuideTest):
    def test_the_first_page_and_the_release_notes(self):
        for name in ("README.md", "docs/releases/1.0.0.md"):
            calls = CALL.findall((tools.SOURCE / name).read_text(encoding="utf-8"))
            with self.subTest(name=name):
                self.assertGreaterEqual(self.run_all([("sh", call) for call in calls]), 1)

    def test_the_tour(self):
        self.assertGreaterEqual(self.run_blocks("docs/guides/tour.md"), 7)

    def test_the_cookbook(self):
        self.assertGreaterEqual(self.run_blocks("docs/guides/cookbook.md"), 17)

    def test_rotations(self):
        self.assertEqual(self.run_blocks("docs/rotations.md"), 2)

    def test_the_layouts_of_research(self):
        self.assertEqual(self.run_blocks("docs/guides/research_layouts.md"), 3)

    def test_reading_in_python(self):
        for module, package in (("build", "python3-build"), ("ensurepip", "python3-venv")):
            if importlib.util.find_spec(module) is None:
                self.skipTest(f"no Python module {module}; install the package {package}")
        with tempfile.TemporaryDirectory() as folder:
            tools.run(tools.SOURCE / "scripts" / "build_python.sh", folder).check_returncode()
            wheel, = pathlib.Path(folder).glob("*.whl")
            self.assertEqual(self.run_blocks("docs/guides/python_reading.md", source_package=False,
                                             files={f"build/python/{wheel.name}": wheel}), 3)

    def test_from_a_data_set_to_training(self):
        self.assertGreaterEqual(self.run_blocks("docs/guides/data_set_to_training.md"), 4)

    def test_from_leaders_to_a_training_set(self):
        self.assertGreaterEqual(self.run_blocks("docs/batch.md", leaders=("hug", "kick", "push")), 2)


if __name__ == "__main__":
    tools.main()
