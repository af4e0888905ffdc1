"""The Python package's notebook runs top to bottom, and its pictures are not empty."""

import base64
import importlib.util
import json
import os
import pathlib
import shutil
import sys
import tempfile
import unittest

import tools

for module, package in (("grpc", "python3-grpcio"), ("matplotlib", "python3-matplotlib")):
    if importlib.util.find_spec(module) is None:
        tools.skip(f"no Python module {module}; install the package {package}")

EXAMPLES = pathlib.Path("client") / "python" / "examples"
NAME = "mixing_reactions.ipynb"


def pictures(notebook):
    cells = json.loads(notebook.read_text(encoding="utf-8"))["cells"]
    outputs = [output for cell in cells for output in cell.get("outputs", ())]
    return [tools.Picture(base64.b64decode(output["data"]["image/png"]))
            for output in outputs if output["output_type"] == "display_data"]


class NotebookTest(unittest.TestCase):
    def test_notebook_runs_top_to_bottom(self):
        with tempfile.TemporaryDirectory() as folder, tools.running_server() as server:
            root = pathlib.Path(folder)
            (root / EXAMPLES).mkdir(parents=True)
            (root / "samples").symlink_to(tools.SOURCE / "samples")
            notebook = root / EXAMPLES / NAME
            shutil.copy(tools.SOURCE / EXAMPLES / NAME, notebook)
            ran = tools.run(
                sys.executable, "-B", tools.SOURCE / "tests/e2e/run_notebook.py", notebook,
                "--write", timeout=600, env={
                    **os.environ, "DUET_SERVER": server.address, "MPLCONFIGDIR": folder,
                    "DUET_PROGRAM": str(tools.PROGRAMS / "duet"),
                    "PYTHONPATH": str(tools.SOURCE / "client" / "python")})
            self.assertEqual(ran.returncode, 0, ran.stderr)
            drawn = pictures(notebook)
        self.assertEqual(len(drawn), 4)
        for picture in drawn:
            blue = picture.count(lambda red, green, blue: blue > 1.4 * red and blue > 100, 0, 1, 0, 1)
            self.assertGreater(blue, 100)

    def test_stored_outputs_are_from_a_complete_run(self):
        kept = json.loads((tools.SOURCE / EXAMPLES / NAME).read_text(encoding="utf-8"))
        counts = [cell["execution_count"] for cell in kept["cells"] if cell["cell_type"] == "code"]
        self.assertEqual(counts, list(range(1, len(counts) + 1)))
        self.assertEqual(len(pictures(tools.SOURCE / EXAMPLES / NAME)), 4)


if __name__ == "__main__":
    tools.main()
