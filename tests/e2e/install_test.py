"""The installed client library, used by a project of its own; and the client built alone.

    install_test.py <build folder> <cmake> [cmake options...]
"""

import pathlib
import shutil
import sys
import unittest

import tools

BUILD, CMAKE, *OPTIONS = sys.argv[1:]
del sys.argv[1:]

WORK = pathlib.Path(BUILD) / "install_test"
BUILD_SECONDS = 800  # the whole client, on a busy machine


def run(*command, timeout=tools.RUN_SECONDS):
    result = tools.run(*command, timeout=timeout)
    assert result.returncode == 0, f"{command} failed:\n{(result.stdout + result.stderr)[-6000:]}"
    return result.stdout


def fresh(name):
    folder = WORK / name
    shutil.rmtree(folder, ignore_errors=True)
    return folder


class InstallTest(unittest.TestCase):
    def check_consumer(self, prefix):
        """Builds a program against the installation and runs it."""
        build = fresh(f"{prefix.name}-consumer")
        run(CMAKE, "-S", tools.SOURCE / "tests/e2e/consumer", "-B", build, *OPTIONS,
            f"-DCMAKE_PREFIX_PATH={prefix}")
        run(CMAKE, "--build", build, timeout=BUILD_SECONDS)
        with tools.running_server() as server:
            self.assertRegex(run(build / "consumer", server.address),
                             r"^k3hi@\d+\n(sbu@\d+\n)+leader\.frame_count\n$")

    def test_the_library_is_usable_where_it_is_installed(self):
        prefix = fresh("whole")
        for component in ("client", "client-development"):
            run(CMAKE, "--install", BUILD, "--prefix", prefix, "--component", component)
        self.assertIn("duet 0.", run(prefix / "bin/duet", "--version"))
        for document in ("man/man1/duet.1", "man/man1/duet-inspect.1",
                         "bash-completion/completions/duet", "zsh/site-functions/_duet",
                         "fish/vendor_completions.d/duet.fish", "man/man1/duet-load.1"):
            self.assertGreater((prefix / "share" / document).stat().st_size, 100, document)
        self.check_consumer(prefix)
        # Nothing points back into the build or the sources.
        for file in prefix.glob("lib/**/*.cmake"):
            text = file.read_text(encoding="utf-8")
            self.assertNotIn(str(BUILD), text, file)
            self.assertNotIn(str(tools.SOURCE), text, file)

    def test_the_client_builds_without_libtorch(self):
        build = WORK / "client-only-build"  # kept, so that a second run is quick
        run(CMAKE, "-S", tools.SOURCE, "-B", build, *OPTIONS, "-DDUET_CLIENT_ONLY=ON",
            "-DCMAKE_DISABLE_FIND_PACKAGE_Torch=ON",
            "-DCMAKE_DISABLE_FIND_PACKAGE_prometheus-cpp=ON")
        run(CMAKE, "--build", build, timeout=BUILD_SECONDS)
        prefix = fresh("client-only")
        run(CMAKE, "--install", build, "--prefix", prefix)
        linked = run("ldd", prefix / "bin/duet")
        self.assertIn("libgrpc++", linked)
        self.assertNotIn("torch", linked)
        self.check_consumer(prefix)


if __name__ == "__main__":
    tools.main()
