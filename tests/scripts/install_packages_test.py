"""Tests the package lists of each release: install_packages.sh --print and --lacks, with_training.sh,
configure.sh, format.sh."""

import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

SCRIPTS = pathlib.Path(__file__).resolve().parents[2] / "scripts"
PACKAGES = SCRIPTS.parent / "packages"


def table():
    """The rows of releases.tsv; the first one has the names of the releases."""
    lines = (PACKAGES / "releases.tsv").read_text(encoding="utf-8").splitlines()
    return [line.split("\t") for line in lines if line and not line.startswith("#")]


class InstallPackagesTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def run_script(self, release, *words, **environment):
        file = self.folder / "os-release"
        file.write_text(f'NAME="Some Linux"\nVERSION_CODENAME={release}\n', encoding="utf-8")
        inherited = {name: value for name, value in os.environ.items() if name != "DUET_TRAINING"}
        return subprocess.run([SCRIPTS / words[0], *words[1:]], capture_output=True, text=True, check=False,
                              env={**inherited, "OS_RELEASE": str(file), **environment})

    def names(self, release, *lists):
        return self.run_script(release, "install_packages.sh", "--print", *lists).stdout.split()

    def test_names_are_those_of_the_release(self):
        for release, library in (("bookworm", "libssl3"), ("trixie", "libssl3t64"), ("noble", "libssl3t64")):
            self.assertIn(library, self.names(release, "runtime"))
            self.assertIn("libgcc-s1", self.names(release, "runtime"))

        self.assertEqual(self.names("tara", "runtime"), self.names("bookworm", "runtime"), "an unknown release")
        self.assertNotIn("-", self.names("noble", "build", "build_training"))
        self.assertIn("libtorch-dev", self.names("trixie", "build_training"))
        self.assertNotIn("libtorch-dev", self.names("noble", "build_training"))

    def test_an_unknown_list_is_an_error(self):
        result = self.run_script("trixie", "install_packages.sh", "--print", "nonsense")
        self.assertNotEqual(result.returncode, 0)
        self.assertIn("no list 'nonsense'", result.stderr)

    def try_lists(self, release, lacking="none"):
        """The result of --try with an apt-get that lacks one package, and the arguments that it got."""
        tools = self.folder / "tools"
        tools.mkdir(exist_ok=True)
        record = self.folder / "arguments"
        (tools / "dpkg-query").write_text("#!/bin/sh\nexit 1\n", encoding="utf-8")
        (tools / "apt-get").write_text(f'#!/bin/sh\necho "$@" >{record}\nfor name in "$@"; do [ "$name" != {lacking} ] '
                                       '|| { echo "E: Unable to locate package $name" >&2; exit 100; }; done\n',
                                       encoding="utf-8")
        for tool in tools.iterdir():
            tool.chmod(0o755)
        result = self.run_script(release, "install_packages.sh", "--try", "runtime", "training",
                                 PATH=f"{tools}:{os.environ['PATH']}")
        return result, record.read_text(encoding="utf-8").split()

    def test_trying_lists_only_simulates_with_the_names_of_the_release(self):
        result, arguments = self.try_lists("noble")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("--simulate", arguments)
        names = self.names("noble", "runtime", "training")
        self.assertEqual(arguments[-len(names):], names)
        self.assertIn(f"{len(names)} packages of noble can be installed", result.stdout)

    def test_a_name_that_the_archive_lacks_is_an_error(self):
        result, _ = self.try_lists("trixie", lacking="libtorch2.6")
        self.assertEqual(result.returncode, 1)
        self.assertIn("Unable to locate package libtorch2.6", result.stderr)
        self.assertIn("expected packages of trixie's archive", result.stderr)

    def test_training_is_built_where_its_packages_are(self):
        for release, training, lists in (("bookworm", "ON", "build build_training"), ("noble", "OFF", "build")):
            self.assertEqual(self.run_script(release, "with_training.sh").stdout.strip(), training)
            self.assertEqual(self.run_script(release, "with_training.sh", "--lists").stdout.strip(), lists)

        result = self.run_script("bookworm", "with_training.sh", DUET_TRAINING="off")
        self.assertEqual(result.stdout.strip(), "OFF")
        result = self.run_script("bookworm", "with_training.sh", DUET_TRAINING="maybe")
        self.assertEqual(result.returncode, 2)
        self.assertIn("DUET_TRAINING: expected ON or OFF, got maybe", result.stderr)

    def test_every_build_is_configured_for_the_release(self):
        tools = self.folder / "tools"
        tools.mkdir()
        (tools / "cmake").write_text('#!/bin/sh\necho "$@"\n', encoding="utf-8")
        (tools / "cmake").chmod(0o755)
        path = f"{tools}:{os.environ['PATH']}"
        for release, training in (("bookworm", "ON"), ("noble", "OFF")):
            result = self.run_script(release, "configure.sh", "tsan", "-DA=B C", PATH=path)
            root = SCRIPTS.parent
            tools_off = [f"-DDUET_CONTRIB_{file.parent.name.upper()}=OFF"
                         for file in sorted(root.glob("contrib/*/CMakeLists.txt"))]
            self.assertEqual(result.stdout.split(),
                             ["--preset", "tsan", f"-DDUET_TRAINING={training}", *tools_off, "-DA=B", "C"])
        for file in (root / "Makefile", *SCRIPTS.glob("*.sh"), *SCRIPTS.glob("*.py")):
            if file.name not in ("configure.sh", "build_tree.py", pathlib.Path(__file__).name):
                self.assertNotIn("cmake --preset", file.read_text(encoding="utf-8"), file)

    def test_the_format_is_unchecked_only_where_the_release_lacks_the_formatter(self):
        tools = self.folder / "tools"
        tools.mkdir()
        for tool in ("awk", "basename", "bash", "dirname", "env", "grep", "sed", "tr"):
            (tools / tool).symlink_to(shutil.which(tool))
        for release, code in (("trixie", 0), ("bookworm", 1)):
            result = self.run_script(release, "format.sh", "--check", PATH=str(tools))
            self.assertEqual(result.returncode, code, result.stdout + result.stderr)
            self.assertIn("the format is not checked", result.stdout)

    def test_the_table_renames_only_packages_of_the_lists(self):
        rows = table()
        listed = {line.split("#")[0].strip() 
                  for file in (*PACKAGES.glob("*.txt"), *PACKAGES.parent.glob("contrib/**/packages.txt"))
                  for line in file.read_text(encoding="utf-8").splitlines()}
        self.assertEqual(rows[0], ["bookworm", "trixie", "noble"])
        for row in rows[1:]:
            self.assertEqual(len(row), len(rows[0]), row)
            self.assertIn(row[0], listed)


if __name__ == "__main__":
    unittest.main()
