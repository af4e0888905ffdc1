"""The tour and the cookbook do what they say: their commands and their Python run as they are
printed, against a real server that they find by DUET_SERVER, as both say."""

import importlib.util
import os
import pathlib
import re
import sys
import tempfile
import unittest

import tools

for module, package in (("grpc", "python3-grpcio"), ("numpy", "python3-numpy")):
    if importlib.util.find_spec(module) is None:
        tools.skip(f"no Python module {module}; install the package {package}")

BLOCK = re.compile(r"^```(sh|python)\n(.*?)^```$", re.MULTILINE | re.DOTALL)


class DocumentsTest(unittest.TestCase):
    def run_blocks(self, name):
        text = (tools.SOURCE / "docs" / "guides" / name).read_text(encoding="utf-8")
        blocks = BLOCK.findall(text)
        with tempfile.TemporaryDirectory() as folder, tools.running_server() as server:
            for shared in ("samples", "recipes"):
                pathlib.Path(folder, shared).symlink_to(tools.SOURCE / shared)
            environment = {
                **os.environ, "DUET_SERVER": server.address, "DUET_CONFIG": "",
                "PATH": f"{tools.PROGRAMS}:{os.environ['PATH']}",
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
        self.assertGreaterEqual(self.run_blocks("tour.md"), 7)

    def test_the_cookbook(self):
        self.assertGreaterEqual(self.run_blocks("cookbook.md"), 17)


if __name__ == "__main__":
    tools.main()
