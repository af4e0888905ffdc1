"""Builds wheel and sdist of the Python package, installs the wheel and uses it."""

import importlib.util
import os
import pathlib
import re
import sys
import tarfile
import tempfile
import unittest

import tools

for module, package in (("grpc", "python3-grpcio"), ("numpy", "python3-numpy"),
                        ("build", "python3-build"), ("pip", "python3-pip")):
    if importlib.util.find_spec(module) is None:
        tools.skip(f"no Python module {module}; install the package {package}")

USE = """
import duet_motion as duet, importlib.metadata, pathlib, sys
leader = duet.read_motion(sys.argv[1])
with duet.Client() as client:
    print(pathlib.Path(duet.__file__).parent, client.synthesize(leader, {"hug": 1}).follower)
assert duet.__version__ == importlib.metadata.version("duet-motion")
"""


class PythonPackageTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        tools.run(tools.SOURCE / "scripts" / "build_python.sh",
                  cls.folder / "dist").check_returncode()

    def archive(self, ending):
        found = list((self.folder / "dist").glob(f"*{ending}"))
        self.assertEqual(len(found), 1, found)
        return found[0]

    def test_version_is_the_projects(self):
        cmake = (tools.SOURCE / "CMakeLists.txt").read_text(encoding="utf-8")
        version = re.search(r"project\(duet VERSION ([\d.]+)", cmake)[1]
        self.assertEqual(self.archive(".whl").name, f"duet_motion-{version}-py3-none-any.whl")
        self.assertEqual(self.archive(".tar.gz").name, f"duet-motion-{version}.tar.gz")

    def test_sdist_is_complete(self):
        with tarfile.open(self.archive(".tar.gz")) as archive:
            names = {name.partition("/")[2] for name in archive.getnames()}
        self.assertLessEqual({"pyproject.toml", "README.md", "LICENSE", "duet_motion/py.typed",
                              "duet_motion/v1/synthesis_pb2.pyi"}, names)

    def test_installed_wheel_makes_a_call(self):
        installed = self.folder / "installed"
        tools.run(sys.executable, "-m", "pip", "install", "--quiet", "--no-deps", "--no-index",
                  "--target", installed, self.archive(".whl")).check_returncode()
        self.assertEqual([path.name for path in installed.iterdir() if path.suffix == ""],
                         ["duet_motion"])
        environment = {**os.environ, "PYTHONPATH": str(installed), "DUET_CONFIG": "",
                       "DUET_PROGRAM": str(tools.PROGRAMS / "duet")}
        with tools.running_server() as server:
            environment["DUET_SERVER"] = server.address
            used = tools.run(sys.executable, "-c", USE, tools.sample("hug"), cwd=self.folder,
                             env=environment)
        self.assertEqual(used.returncode, 0, used.stderr)
        self.assertEqual(used.stdout.strip(),
                         f"{installed / 'duet_motion'} Motion(91 frames at 30 Hz, 15 joints, metres, y-up)")


if __name__ == "__main__":
    tools.main()
