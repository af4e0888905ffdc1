"""The installed client library, used by a project of its own; and the client built alone, each step of
which must be one that the whole build took.

    install_test.py <build folder> <cmake> <ninja> [cmake options...]
"""

import pathlib
import re
import shutil
import sys
import unittest

import tools

BUILD, CMAKE, NINJA, *OPTIONS = sys.argv[1:]
del sys.argv[1:]

WORK = pathlib.Path(BUILD) / "install_test"


def run(*command, timeout=tools.RUN_SECONDS):
    result = tools.run(*command, timeout=timeout)
    assert result.returncode == 0, f"{command} failed:\n{(result.stdout + result.stderr)[-6000:]}"
    return result.stdout


def fresh(name):
    folder = WORK / name
    shutil.rmtree(folder, ignore_errors=True)
    return folder


def commands(build):
    """Every command of a build, as if the build lay in BUILD."""
    text = run(NINJA, "-C", build, "-t", "commands", "all").replace(str(build), BUILD)
    # CMake names some files by a hash of paths.
    text = re.sub(r"/CMakeFiles/d/[0-9a-f]+\.d", "/CMakeFiles/d/HASH.d", text)
    return {line for line in text.splitlines() if not line.startswith("ninja: Entering")}


class InstallTest(unittest.TestCase):
    def test_installed_library_is_usable(self):
        prefix = fresh("whole")
        for component in ("client", "client-development"):
            run(CMAKE, "--install", BUILD, "--prefix", prefix, "--component", component)
        self.assertRegex(run(prefix / "bin/duet", "--version"), r"^duet \d+\.\d+\.\d+$")
        linked = run("ldd", prefix / "bin/duet")
        self.assertIn("libgrpc++", linked)
        self.assertNotIn("torch", linked)
        if shutil.which("help2man"):
            self.assertIn("--candidates", (prefix / "share/man/man1/duet-synthesize.1").read_text(
                encoding="utf-8").replace("\\-", "-"))
        # Nothing points back into the build or the sources.
        for file in prefix.glob("lib/**/*.cmake"):
            text = file.read_text(encoding="utf-8")
            self.assertNotIn(str(BUILD), text, file)
            self.assertNotIn(str(tools.SOURCE), text, file)

        build = fresh("consumer")
        run(CMAKE, "-S", tools.SOURCE / "tests/e2e/consumer", "-B", build, *OPTIONS,
            f"-DCMAKE_PREFIX_PATH={prefix}")
        run(CMAKE, "--build", build)
        with tools.running_server() as server:
            self.assertRegex(run(build / "consumer", server.address),
                             r"^everyday@\d+\nk3hi@\d+\nsalsa@\d+\n(sbu@\d+\n)+leader\.frame_count\n$")

    def test_the_client_builds_without_libtorch(self):
        # The same commands make the same files: compiling them a second time would show no more.
        alone = fresh("client-only-build")
        run(CMAKE, "-S", tools.SOURCE, "-B", alone, *OPTIONS, "-DDUET_CLIENT_ONLY=ON",
            "-DCMAKE_DISABLE_FIND_PACKAGE_Torch=ON",
            "-DCMAKE_DISABLE_FIND_PACKAGE_prometheus-cpp=ON")
        # Everything that a step reads is there or made by a step before.
        run(NINJA, "-C", alone, "-n")
        steps = commands(alone)
        self.assertGreater(len(steps), 100)
        self.assertEqual(steps - commands(BUILD), set())
        # What is installed has its rules in these two folders, as in the whole build.
        for folder in ("client", "proto"):
            for rules in (alone / folder).rglob("cmake_install.cmake"):
                whole = pathlib.Path(BUILD) / rules.relative_to(alone)
                self.assertEqual(rules.read_text().replace(str(alone), BUILD),
                                 whole.read_text(), rules)


if __name__ == "__main__":
    tools.main()
