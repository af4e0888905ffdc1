"""Builds wheel and sdist of the Python package, installs them and uses them."""

import importlib.util
import os
import re
import sys
import tarfile
import tempfile

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


class PythonPackageTest(tools.FolderTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        old = cls.folder / "dist" / "duet_motion-0.0.1-py3-none-any.whl"
        old.parent.mkdir()
        old.touch()  # a wheel of before, which pip must not find beside the new one
        tools.run(tools.SOURCE / "scripts" / "build_python.sh", cls.folder / "dist").check_returncode()

    def archive(self, ending, folder="dist"):
        found = list((self.folder / folder).glob(f"*{ending}"))
        self.assertEqual(len(found), 1, found)
        return found[0]

    def new_environment(self, name, archive):
        """A virtual environment with the package, and Debian's NumPy and grpcio. Returns its Python."""
        folder = self.folder / name
        tools.run(sys.executable, "-m", "venv", "--without-pip", "--system-site-packages",
                  folder).check_returncode()
        python = folder / "bin" / "python"
        installed = tools.run(sys.executable, "-m", "pip", "--python", python, "install", "--quiet",
                              "--no-deps", "--no-index", "--no-build-isolation", archive)
        self.assertEqual(installed.returncode, 0, installed.stderr)
        return python

    def use(self, python, *words, **environment):
        """Runs Python in an empty folder, without the programs of Duet."""
        with tempfile.TemporaryDirectory(dir=self.folder) as folder:
            return tools.run(python, *words, cwd=folder,
                             env={"PATH": str(python.parent), **environment})

    def test_names_state_version_and_platform(self):
        cmake = (tools.SOURCE / "CMakeLists.txt").read_text(encoding="utf-8")
        version = re.search(r"project\(duet VERSION ([\d.]+)", cmake)[1]
        self.assertEqual(self.archive(".whl").name, f"duet_motion-{version}-py3-none-any.whl")
        # Newer setuptools write an underscore.
        self.assertIn(self.archive(".tar.gz").name,
                      (f"duet-motion-{version}.tar.gz", f"duet_motion-{version}.tar.gz"))

    def test_sdist_is_complete(self):
        with tarfile.open(self.archive(".tar.gz")) as archive:
            names = {name.partition("/")[2] for name in archive.getnames()}
        self.assertLessEqual({"pyproject.toml", "README.md", "LICENSE", "duet_motion/py.typed",
                              "duet_motion/sets/__main__.py", "duet_motion/v1/synthesis_pb2.pyi"}, names)

    def test_same_files_give_the_same_wheel(self):
        tools.run(tools.SOURCE / "scripts" / "build_python.sh", self.folder / "again").check_returncode()
        self.assertEqual(self.archive(".whl").read_bytes(), self.archive(".whl", "again").read_bytes())

    def test_installed_wheel_makes_a_call(self):
        installed = self.folder / "installed"
        tools.run(sys.executable, "-m", "pip", "install", "--quiet", "--no-deps", "--no-index",
                  "--target", installed, self.archive(".whl")).check_returncode()
        self.assertEqual([path.name for path in installed.iterdir() if path.suffix == ""],
                         ["duet_motion"])
        environment = {**os.environ, "PYTHONPATH": str(installed),
                       "DUET_PROGRAM": str(tools.PROGRAMS / "duet")}
        with tools.running_server() as server:
            environment["DUET_SERVER"] = server.address
            used = tools.run(sys.executable, "-c", USE, tools.sample("hug"), cwd=self.folder,
                             env=environment)
        self.assertEqual(used.returncode, 0, used.stderr)
        self.assertEqual(used.stdout.strip(),
                         f"{installed / 'duet_motion'} Motion(91 frames at 30 Hz, 15 joints, metres, y-up)")

    def test_sdist_installs_without_a_compiler_and_needs_the_program(self):
        python = self.new_environment("sdist", self.archive(".tar.gz"))
        code = "import sys, duet_motion as duet; print(duet.read_motion(sys.argv[1]).frame_count)"
        used = self.use(python, "-c", code, tools.sample("hug"))
        self.assertRegex(used.stderr, "FileNotFoundError: program 'duet': expected .*Debian package duet")
        used = self.use(python, "-c", code, tools.sample("hug"),
                        DUET_PROGRAM=str(tools.PROGRAMS / "duet"))
        self.assertEqual(used.stdout, "91\n", used.stderr)


if __name__ == "__main__":
    tools.main()
