#!/usr/bin/env python3
"""Shows that check_version.py finds a file with another version, and writes versions and dates."""

import pathlib
import shutil
import tempfile
import unittest

import check_version


class CheckVersionTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        names = {"CMakeLists.txt", "CHANGELOG.md"}
        for pattern, _ in check_version.RULES:
            names |= {str(file.relative_to(check_version.ROOT))
                      for file in check_version.ROOT.glob(pattern)}
        names |= {str(file.relative_to(check_version.ROOT))
                  for file in check_version.ROOT.glob("docs/releases/*.md")}
        for name in names:
            (self.root / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(check_version.ROOT / name, self.root / name)

    def change(self, name, old, new):
        file = self.root / name
        text = file.read_text(encoding="utf-8")
        self.assertIn(old, text)
        file.write_text(text.replace(old, new), encoding="utf-8")

    def found(self):
        return list(check_version.problems(self.root))

    def test_the_repository_agrees(self):
        self.assertEqual(self.found(), [])

    def test_each_rule_finds_another_version(self):
        version = check_version.project_version(self.root)
        for file, _, match in list(check_version.statements(self.root)):
            name = str(file.relative_to(self.root))
            with self.subTest(name):
                stated = match[0]
                self.change(name, stated, stated.replace(match[1], match[1][:-1] + "7"))
                self.assertTrue(any(line.startswith(name) for line in self.found()), self.found())
                check_version.write(self.root)
                self.assertEqual(self.found(), [], version)

    def test_a_file_that_states_no_version_is_a_problem(self):
        self.change("client/python/duet_motion/__init__.py", "__version__", "_version")
        self.assertEqual(len(self.found()), 1)

    def test_a_new_version_needs_a_section_and_notes(self):
        version = check_version.project_version(self.root)
        self.change("CMakeLists.txt", f"duet VERSION {version}", "duet VERSION 8.1.0")
        check_version.write(self.root)
        self.assertEqual(self.found(), ["CHANGELOG.md: expected a section [8.1.0], got none",
                                        "docs/releases/8.1.0.md: expected release notes, got no file"])


if __name__ == "__main__":
    unittest.main()
