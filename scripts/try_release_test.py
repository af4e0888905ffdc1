#!/usr/bin/env python3
"""Shows what try_release.sh makes and runs, with stand-ins for debootstrap, for the mounts and for the root."""

import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent
PROGRAMS = {
    "id": 'echo "${USER_ID:-0}"',
    "apt-get": "echo Debian Debian http://archive.example/debian",
    "debootstrap": 'echo "$@" >>"${RECORD}" && mkdir -p "${@: -3:1}/usr/bin" && cd "${@: -3:1}/usr/bin" && '
                   'touch make git && chmod +x make git && exit "${BOOTSTRAP_CODE:-0}"',
    "unshare": 'while [[ "$1" == --* ]]; do shift; done; exec "$@"',
    "mount": "true",
    # What would run in the root, after its environment and the shell that enters the clone.
    "chroot": 'while [[ "$1" != /src/duet ]]; do shift; done; shift; echo "$*" >>"${RECORD}"; exit "${CODE:-0}"',
}


class TryReleaseTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.source, self.programs = pathlib.Path(folder.name, "source"), pathlib.Path(folder.name, "programs")
        self.record = pathlib.Path(folder.name, "record")
        self.write(self.source / ".gitignore", "build\n")
        (self.source / "scripts").mkdir()
        shutil.copy(ROOT / "scripts" / "try_release.sh", self.source / "scripts")
        for name, text in PROGRAMS.items():
            self.write(self.programs / name, f"#!/usr/bin/env bash\n{text}\n").chmod(0o755)
        self.git("init", "--quiet")
        self.commit("first")

    def write(self, file, text):
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")
        return file

    def git(self, *words):
        subprocess.run(["git", *words], cwd=self.source, check=True)

    def commit(self, text):
        self.write(self.source / "file", text)
        self.git("add", ".")
        self.git("-c", "user.name=A", "-c", "user.email=a@example.com", "-c", "core.hooksPath=/dev/null",
                 "commit", "--quiet", "-m", "a")

    def attempt(self, *words, **environment):
        self.record.write_text("", encoding="utf-8")
        done = subprocess.run(
            [self.source / "scripts/try_release.sh", *words], capture_output=True, text=True, check=False,
            env={**os.environ, "PATH": f"{self.programs}:{os.environ['PATH']}", "RECORD": str(self.record),
                 **environment})
        self.ran = self.record.read_text(encoding="utf-8").splitlines()
        return done

    @property
    def clone(self):
        return self.source / "build/roots/trixie/src/duet"

    def test_a_root_is_made_once_and_the_command_runs_there(self):
        done = self.attempt("trixie", "demo")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("http://archive.example/debian", self.ran[0])
        self.assertEqual(self.ran[1:], ["make demo"])
        self.assertEqual((self.clone / "file").read_text(encoding="utf-8"), "first")
        self.attempt("trixie", "make", "python")
        self.assertEqual(self.ran, ["make python"])

    def test_again_brings_the_new_commit_and_keeps_the_build(self):
        self.attempt("trixie", "test")
        self.write(self.clone / "build/made", "")
        self.write(self.clone / "left", "")
        self.commit("second")
        self.attempt("--again", "trixie", "test")
        self.assertEqual((self.clone / "file").read_text(encoding="utf-8"), "second")
        self.assertTrue((self.clone / "build/made").exists())
        self.assertFalse((self.clone / "left").exists())
        self.attempt("trixie", "test")
        self.assertFalse((self.clone / "build/made").exists())

    def test_the_result_of_the_command_is_returned(self):
        self.assertEqual(self.attempt("trixie", "test", CODE="7").returncode, 7)

    def test_a_root_that_could_not_be_made_is_not_used(self):
        done = self.attempt("trixie", "demo", BOOTSTRAP_CODE="1")
        self.assertEqual(done.returncode, 1)
        self.assertIn("debootstrap failed", done.stderr)
        self.assertFalse(self.clone.exists())

    def test_packages_have_a_root_without_what_builds_install(self):
        self.attempt("trixie", "demo")
        self.write(self.source / "build/release/packages/duet.deb", "")
        done = self.attempt("trixie", "packages")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("trixie.packages.new http", self.ran[0])  # made anew
        self.assertTrue((self.source / "build/roots/trixie.packages/packages/duet.deb").exists())
        self.assertFalse((self.source / "build/roots/trixie/packages").exists())

    def test_calls_without_what_they_need_are_rejected(self):
        for words, environment, message in (
                (["trixie"], {}, "usage"), (["trixie", "demo"], {"USER_ID": "1000"}, "expected root"),
                (["trixie", "packages"], {}, "expected packages, got none")):
            with self.subTest(words=words):
                done = self.attempt(*words, **environment)
                self.assertEqual(done.returncode, 1)
                self.assertIn(message, done.stderr)
        self.assertNotIn("make", " ".join(self.ran))


if __name__ == "__main__":
    unittest.main()
