#!/usr/bin/env python3
"""Shows that make_release.sh collects the parts of one version and rejects others, with stand-ins for the
programs that build them."""

import hashlib
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent
# Stand-ins by name: each leaves the file that the real program makes.
PROGRAMS = {
    "make": """case "$1" in
build) mkdir -p build/release ;;
python) mkdir -p build/python && echo wheel >"build/python/duet_motion-${MADE:-1.2.3}-py3-none-any.whl"
  echo sdist >"build/python/duet-motion-${MADE:-1.2.3}.tar.gz" ;;
esac""",
    "cpack": 'mkdir packages && echo deb >"packages/duet_${MADE:-1.2.3}-1_amd64.deb"',
    "dpkg-deb": 'name="${2##*/duet_}" && echo "${name%_amd64.deb}"',
    "podman": """if [[ "$1" == save ]]; then echo image >"${@: -2:1}"; else echo "${MADE:-1.2.3}"; fi""",
}


class MakeReleaseTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name, "clone")
        self.programs = pathlib.Path(folder.name, "programs")
        for name, text in (("CMakeLists.txt", "project(duet VERSION 1.2.3 LANGUAGES CXX)\n"),
                           (".gitignore", "build\n"), ("scripts/check_version.py", "#!/bin/true\n"),
                           ("deploy/image/build.sh", "#!/bin/true\n")):
            self.write(self.root / name, text)
        shutil.copy(ROOT / "scripts" / "make_release.sh", self.root / "scripts")
        for name, text in PROGRAMS.items():
            self.write(self.programs / name, f"#!/usr/bin/env bash\nset -eu\n{text}\n")
        self.git("init", "--quiet")
        self.commit()

    def write(self, file, text):
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")
        file.chmod(0o755)

    def git(self, *words):
        subprocess.run(["git", *words], cwd=self.root, check=True)

    def commit(self):
        self.git("add", ".")
        self.git("-c", "user.name=A", "-c", "user.email=a@example.com", "-c", "core.hooksPath=/dev/null",
                 "commit", "--quiet", "-m", "a")

    def make(self, *parts, **environment):
        return subprocess.run(
            [self.root / "scripts" / "make_release.sh", *parts], capture_output=True, text=True,
            check=False, env={**os.environ, "PATH": f"{self.programs}:{os.environ['PATH']}", **environment})

    @property
    def made(self):
        return self.root / "build" / "release_files" / "1.2.3"

    def test_everything_is_collected_with_its_digests(self):
        for _ in range(2):  # twice is harmless
            done = self.make()
            self.assertEqual(done.returncode, 0, done.stderr)
        names = {"duet_1.2.3-1_amd64.deb", "duet_motion-1.2.3-py3-none-any.whl", "duet-motion-1.2.3.tar.gz",
                 "duet-image_1.2.3.tar", "duet-free-image_1.2.3.tar"}
        self.assertEqual({file.name for file in self.made.iterdir()}, names | {"SHA256SUMS", "COMMIT"})
        sums = dict(line.split()[::-1] for line in (self.made / "SHA256SUMS").read_text().splitlines())
        self.assertLessEqual(names, set(sums))
        for name in names:
            self.assertEqual(hashlib.sha256((self.made / name).read_bytes()).hexdigest(), sums[name])

    def test_all_parts_come_from_one_commit(self):
        self.make("packages")
        self.make("python")
        self.assertTrue((self.made / "duet_1.2.3-1_amd64.deb").exists())
        self.write(self.root / "README.md", "changed\n")
        self.commit()
        done = self.make("python")
        self.assertIn("removing build/release_files/1.2.3", done.stdout)
        self.assertFalse((self.made / "duet_1.2.3-1_amd64.deb").exists())
        self.assertTrue((self.made / "duet-motion-1.2.3.tar.gz").exists())

    def test_each_part_of_another_version_is_rejected(self):
        for part in ("packages", "python", "images"):
            done = self.make(part, MADE="1.2.2")
            self.assertEqual(done.returncode, 1, part)
            self.assertRegex(done.stderr, r"expected the version 1\.2\.3, got 1\.2\.2")

    def test_unknown_parts_and_changed_files_are_rejected(self):
        self.assertIn("expected packages, python or images, got wheels", self.make("wheels").stderr)
        self.write(self.root / "CMakeLists.txt", "project(duet VERSION 1.2.3 LANGUAGES C)\n")
        self.assertIn("got changed files", self.make("python").stderr)
        self.assertFalse(self.made.exists())


if __name__ == "__main__":
    unittest.main()
