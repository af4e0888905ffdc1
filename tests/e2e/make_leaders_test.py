"""scripts/make_leaders.py makes motions that Duet reads without a complaint."""

import pathlib
import sys
import tempfile
import unittest

import tools

SCRIPT = tools.SOURCE / "scripts/make_leaders.py"
KINDS = ("circles", "crouches", "dances", "gestures", "idles", "paces", "sits", "turns")


def make(out, *flags):
    return tools.run(sys.executable, "-B", SCRIPT, "--out", out, "--duet-keyframe",
                     tools.PROGRAMS / "duet-keyframe", "--each", 1, *flags)


class MakeLeadersTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.out = pathlib.Path(folder.name) / "leaders"

    def test_every_motion_is_a_person_on_the_floor(self):
        made = make(self.out, "--seconds", "8")
        self.assertEqual(made.returncode, 0, made.stderr)
        files = sorted(self.out.iterdir())
        self.assertEqual([file.name for file in files], [f"{kind}_1.bvh" for kind in KINDS])
        for file in files:
            report = tools.duet("inspect", file).stdout
            self.assertIn("8.", report, file)
            for check in ("finite", "size", "limb lengths", "symmetry", "floor", "jumps", "sides"):
                self.assertRegex(report, rf"ok +{check} ", (file, report))

    def test_bad_arguments_are_named(self):
        for flags, message in ((("--seconds", "61"), "--seconds: expected 5 to 60, got 61"),
                               (("--each", "0"), "--each: expected at least 1, got 0")):
            made = make(self.out, *flags)
            self.assertEqual(made.returncode, 1)
            self.assertIn(message, made.stderr)
            self.assertFalse(self.out.exists())


if __name__ == "__main__":
    tools.main()
