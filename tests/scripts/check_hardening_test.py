"""Tests check_hardening.sh on programs of a few lines, built with each protection and without it."""

import pathlib
import shutil
import subprocess
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "scripts/check_hardening.sh"
SOURCE = """
#include <cstdio>
#include <cstring>
#include <vector>
int main(int count, char** words) {
  std::vector<int> numbers(static_cast<unsigned>(count));
  char text[16];
  std::strcpy(text, words[0]);
  std::printf("%s %d", text, numbers[static_cast<unsigned>(count) / 2]);
}
"""
FLAGS = ("-O2", "-fPIE", "-pie", "-fstack-protector-strong", "-U_FORTIFY_SOURCE",
         "-D_FORTIFY_SOURCE=2", "-D_GLIBCXX_ASSERTIONS", "-Wl,-z,relro", "-Wl,-z,now")


@unittest.skipUnless(shutil.which("c++") and shutil.which("readelf"), "no compiler")
class CheckHardeningTest(unittest.TestCase):
    def check(self, *more, text=SOURCE):
        """Builds with FLAGS and `more`, which override them; exit status and what was printed."""
        with tempfile.TemporaryDirectory() as folder:
            source = pathlib.Path(folder, "duet.cc")
            source.write_text(text, encoding="utf-8")
            subprocess.run(["c++", *FLAGS, *more, source, "-o", source.with_suffix("")], check=True)
            source.unlink()
            done = subprocess.run([SCRIPT, folder], capture_output=True, check=False, text=True)
            return done.returncode, done.stdout + done.stderr

    def test_a_program_with_every_protection(self):
        self.assertEqual(self.check(), (0, "1 programs are hardened: duet.\n"))

    def test_a_program_that_calls_nothing_to_fortify(self):
        text = SOURCE.replace("std::strcpy(text, words[0]);", "std::memcpy(text, words[0], sizeof text);")
        text = text.replace('std::printf("%s %d", text, ', "return std::memchr(text, 0, 9) != nullptr ? 1 : (")
        self.assertEqual(self.check(text=text), (0, "1 programs are hardened: duet.\n"))

    def test_each_protection_that_is_absent_is_named(self):
        for flags, name in (
                (("-fno-PIE", "-no-pie"), "PIE"), (("-Wl,-z,norelro",), "RELRO"),
                (("-Wl,-z,lazy",), "BIND_NOW"), (("-Wl,-z,execstack",), "not executable"),
                (("-fno-stack-protector",), "stack protectors"),
                (("-U_FORTIFY_SOURCE",), "_FORTIFY_SOURCE"),
                (("-U_GLIBCXX_ASSERTIONS",), "_GLIBCXX_ASSERTIONS")):
            status, printed = self.check(*flags)
            self.assertEqual(status, 1, flags)
            self.assertIn(name, printed)
            self.assertEqual(printed.count("\n"), 1, printed)


if __name__ == "__main__":
    unittest.main()
