"""Builds wheel and sdist of the Python package, installs them and uses them."""

import importlib.util
import json
import os
import pathlib
import re
import sys
import tarfile
import tempfile
import unittest
import zipfile

import tools

for module, package in (("grpc", "python3-grpcio"), ("numpy", "python3-numpy"),
                        ("build", "python3-build"), ("pip", "python3-pip")):
    if importlib.util.find_spec(module) is None:
        tools.skip(f"no Python module {module}; install the package {package}")

sys.path.insert(0, str(tools.SOURCE / "tests" / "client" / "python"))
import motion_samples  # noqa: E402

BUILD = tools.PROGRAMS.parent
EXTENSION = list((BUILD / "python" / "duet_motion").glob("_motion_files.*.so"))
PYTHON = f"cp{sys.version_info.major}{sys.version_info.minor}"

USE = """
import duet_motion as duet, importlib.metadata, pathlib, sys
leader = duet.read_motion(sys.argv[1])
with duet.Client() as client:
    print(pathlib.Path(duet.__file__).parent, client.synthesize(leader, {"hug": 1}).follower)
assert duet.__version__ == importlib.metadata.version("duet-motion")
"""

# Prints the shape, the sum of positions and the rate of each file. Writes and reads each again.
READ = """
import duet_motion as duet, json, pathlib, sys
read = {}
for path, options in json.loads(sys.argv[1]).items():
    motion = duet.read_motion(path, **options)
    read[path] = [motion.positions.shape, float(motion.positions.sum()), motion.frame_rate_hz]
    duet.write_motion("copy.csv", motion)
    assert (duet.read_motion("copy.csv").positions == motion.positions).all(), path
print(json.dumps(read))
"""


# Prints the files of abseil that the module loads.
LOAD = """
import sys
sys.path.insert(0, sys.argv[1])
import _motion_files
for line in open("/proc/self/maps"):
    if "libabsl_" in line:
        print(line.split()[-1])
"""


def needed_by(file):
    """The libraries that a module or a library loads by name."""
    listed = tools.run("readelf", "-d", file)
    listed.check_returncode()
    return re.findall(r"\(NEEDED\).*\[(.*)\]", listed.stdout)


class PythonPackageTest(tools.FolderTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        old = cls.folder / "dist" / "duet_motion-0.0.1-py3-none-any.whl"
        old.parent.mkdir()
        old.touch()  # a wheel of before, which pip must not find beside the new one
        for name in ("dist", "pure"):
            build = BUILD if name == "dist" else cls.folder / "no-build"
            tools.run(tools.SOURCE / "scripts" / "build_python.sh", cls.folder / name,
                      build).check_returncode()

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
                             env={"PATH": str(python.parent), "DUET_CONFIG": "", **environment})

    def test_names_state_version_and_platform(self):
        cmake = (tools.SOURCE / "CMakeLists.txt").read_text(encoding="utf-8")
        version = re.search(r"project\(duet VERSION ([\d.]+)", cmake)[1]
        platform = f"{PYTHON}-{PYTHON}-linux_{os.uname().machine}" if EXTENSION else "py3-none-any"
        self.assertEqual(self.archive(".whl").name, f"duet_motion-{version}-{platform}.whl")
        self.assertEqual(self.archive(".whl", "pure").name, f"duet_motion-{version}-py3-none-any.whl")
        # Newer setuptools write an underscore.
        self.assertIn(self.archive(".tar.gz").name,
                      (f"duet-motion-{version}.tar.gz", f"duet_motion-{version}.tar.gz"))

    def test_sdist_is_complete(self):
        with tarfile.open(self.archive(".tar.gz")) as archive:
            names = {name.partition("/")[2] for name in archive.getnames()}
        self.assertLessEqual({"pyproject.toml", "setup.py", "README.md", "LICENSE",
                              "duet_motion/py.typed", "duet_motion/_motion_files.pyi",
                              "duet_motion/v1/synthesis_pb2.pyi"}, names)
        self.assertEqual([name for name in names if name.endswith((".so", ".cc", ".h"))], [])

    def test_pure_wheel_contains_no_library(self):
        with zipfile.ZipFile(self.archive(".whl", "pure")) as wheel:
            self.assertEqual([name for name in wheel.namelist() if ".so" in name], [])
            self.assertIn("duet_motion/_motion_files.pyi", wheel.namelist())

    @unittest.skipUnless(EXTENSION, "no extension module; build duet_python_module")
    def test_wheel_contains_all_libraries_but_the_systems(self):
        folder = self.folder / "unpacked"
        with zipfile.ZipFile(self.archive(".whl")) as wheel:
            wheel.extractall(folder)
        package = folder / "duet_motion"
        module = package / EXTENSION[0].name
        libraries = sorted((package / "_libs").glob("*.so*"))
        needed = {name for file in (module, *libraries) for name in needed_by(file)}
        # Python itself needs zlib.
        self.assertLessEqual({name for name in needed if not name.startswith("ld-linux")}
                             - {library.name for library in libraries},
                             {"libc.so.6", "libgcc_s.so.1", "libm.so.6", "libstdc++.so.6",
                              "libz.so.1"})
        self.assertTrue(all(library.name.startswith("libabsl_") for library in libraries), libraries)
        notices = (package / "_libs" / "COPYRIGHT").read_text(encoding="utf-8")
        for name in ("libabsl-dev", "nlohmann-json3-dev", "pybind11-dev"):
            self.assertRegex(notices, rf"== {name} ==\n\nFormat: ")
        # The module loads its own copies, not those of the system.
        loaded = tools.run(sys.executable, "-c", LOAD, package)
        self.assertEqual(set(loaded.stdout.splitlines()),
                         {str(package / "_libs" / library.name) for library in libraries})

    def test_same_files_give_the_same_wheel(self):
        tools.run(tools.SOURCE / "scripts" / "build_python.sh", self.folder / "again",
                  BUILD).check_returncode()
        self.assertEqual(self.archive(".whl").read_bytes(), self.archive(".whl", "again").read_bytes())

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

    @unittest.skipUnless(EXTENSION, "no extension module; build duet_python_module")
    def test_wheel_reads_every_format_without_the_program(self):
        folder = self.folder / "samples"
        folder.mkdir()
        program = tools.PROGRAMS / "duet"
        files = {str(path): motion_samples.options_of(path)
                 for path in motion_samples.write_all(program, folder)}
        self.assertEqual(len({pathlib.Path(path).suffix for path in files}), 8)
        read = {}
        for name, distribution in (("wheel", "dist"), ("fallback", "pure")):
            python = self.new_environment(name, self.archive(".whl", distribution))
            environment = {} if name == "wheel" else {"DUET_PROGRAM": str(program)}
            used = self.use(python, "-c", READ, json.dumps(files), **environment)
            self.assertEqual(used.returncode, 0, used.stderr)
            read[name] = json.loads(used.stdout)
        self.assertEqual(read["wheel"], read["fallback"])
        self.assertEqual(set(read["wheel"]), set(files))

    def test_sdist_installs_without_a_compiler_and_needs_the_program(self):
        python = self.new_environment("sdist", self.archive(".tar.gz"))
        code = "import sys, duet_motion as duet; print(duet.read_motion(sys.argv[1]).frame_count)"
        used = self.use(python, "-c", code, tools.sample("hug"))
        self.assertRegex(used.stderr, "FileNotFoundError: program 'duet': expected .*Debian package "
                                      "duet.* no extension module: cannot import name '_motion_files'")
        used = self.use(python, "-c", code, tools.sample("hug"),
                        DUET_PROGRAM=str(tools.PROGRAMS / "duet"))
        self.assertEqual(used.stdout, "91\n", used.stderr)


if __name__ == "__main__":
    tools.main()
