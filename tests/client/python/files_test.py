"""Reading and writing motion files through the program `duet`."""

import os
import pathlib
import tempfile
import unittest
from unittest import mock

import support
import duet_motion as duet
import numpy as np

PROGRAM = support.PROGRAMS / "duet"
HUG = support.SOURCE / "samples" / "hug.bvh"


@unittest.skipUnless(PROGRAM.exists(), f"no program at {PROGRAM}; build it, or set DUET_BIN_DIR")
class FilesTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.enterContext(mock.patch.dict(os.environ, {"DUET_PROGRAM": str(PROGRAM)}))
        self.hug = duet.read_motion(HUG)
        self.other = self.hug.with_positions(self.hug.positions + np.float32([0, 0, 1]))

    def test_reads_metres_y_up(self):
        self.assertEqual((self.hug.frame_count, self.hug.joint_count), (91, 15))
        self.assertEqual((self.hug.frame_rate_hz, self.hug.unit, self.hug.up_axis),
                         (30, "metres", "y-up"))
        head, foot = self.hug.joint("head")[0], self.hug.joint("left_foot")[0]
        self.assertGreater(head[1] - foot[1], 1.3)
        self.assertLess(head[1] - foot[1], 1.7)

    def test_arguments_override_the_file(self):
        half = duet.read_motion(HUG, metres_per_unit=0.005, frame_rate_hz=60)
        tenth = duet.read_motion(HUG, unit="millimetres")
        np.testing.assert_allclose(half.positions, self.hug.positions / 2, atol=1e-5)
        np.testing.assert_allclose(tenth.positions, self.hug.positions / 10, atol=1e-5)
        self.assertEqual(half.frame_rate_hz, 60)
        self.assertEqual(duet.read_motion(HUG, resample_hz=15).frame_count, 46)
        swapped = duet.read_motion(HUG, joint_map={"left_hand": "right_hand"})
        np.testing.assert_array_equal(swapped.joint("left_hand"), self.hug.joint("right_hand"))

    def test_invalid_arguments_name_their_field(self):
        for arguments, message in (
                ({"side": "up"}, 'side: expected left or right, got "up"'),
                ({"unit": "feet"}, 'unit: expected metres, .*, got "feet"'),
                ({"up_axis": "up"}, 'up_axis: expected y-up, .*, got "up"'),
                ({"frame_rate_hz": 0}, 'frame_rate_hz: expected a number above 0, got "0"'),
                ({"metres_per_unit": -1}, "metres_per_unit: expected a number above 0"),
                ({"resample_hz": "fast"}, "resample_hz: expected a number above 0"),
                ({"joint_map": {"head": ""}}, "joint_map: expected MODEL_JOINT=FILE_JOINT")):
            with self.assertRaisesRegex(ValueError, f"^{message}"):
                duet.read_motion(HUG, **arguments)

    def test_json_and_csv_round_trip_is_exact(self):
        for name in ("pair.json", "pair.csv"):
            duet.write_motion(self.folder / name, self.hug, self.other)
            for read, written in zip(duet.read_pair(self.folder / name), (self.hug, self.other)):
                np.testing.assert_array_equal(read.positions, written.positions)
        right = duet.read_motion(self.folder / "pair.csv", side="right")
        np.testing.assert_array_equal(right.positions, self.other.positions)

    def test_a_page_shows_motions_side_by_side(self):
        duet.write_page(self.folder / "page.html", {"hug": self.hug,
                                                    "with a friend": (self.hug, self.other)},
                        title="Two of them")
        page = (self.folder / "page.html").read_text(encoding="utf-8")
        for words in ("Two of them", "with a friend"):
            self.assertIn(words, page)

    def test_errors_have_the_programs_message(self):
        with self.assertRaisesRegex(duet.MotionFileError, f"^{self.folder}/absent.bvh"):
            duet.read_motion(self.folder / "absent.bvh")
        duet.write_motion(self.folder / "one.json", self.hug)
        with self.assertRaisesRegex(duet.MotionFileError, "expected two people, got one"):
            duet.read_pair(self.folder / "one.json")
        with self.assertRaisesRegex(ValueError, "follower.frame_count: expected the leader's 91, got 90"):
            duet.write_motion(self.folder / "x.json", self.hug, self.other.frames(1))
        with self.assertRaisesRegex(duet.MotionFileError, "x.csv: there is no folder .*absent$"):
            duet.write_motion(self.folder / "absent" / "x.csv", self.hug)

    def test_errors_name_the_argument_that_helps(self):
        duet.write_motion(self.folder / "one.npy", self.hug)
        with self.assertRaisesRegex(duet.MotionFileError, r"one.npy: frame rate: expected one, got "
                                    r"none in the file\nSpecify it with frame_rate_hz\.$"):
            duet.read_motion(self.folder / "one.npy")
        (self.folder / "one.obj").touch()
        with self.assertRaisesRegex(duet.MotionFileError, r'one.obj: extension: .*, got "\.obj"$'):
            duet.read_motion(self.folder / "one.obj")
        with self.assertRaisesRegex(duet.MotionFileError, "^resample_hz: .* got 2000$"):
            duet.read_motion(HUG, resample_hz=2000)

    def test_missing_program_explains_what_to_install(self):
        with mock.patch.dict(os.environ, {"DUET_PROGRAM": "no-such-duet"}):
            for use in (lambda: duet.read_motion(HUG),
                        lambda: duet.write_motion(self.folder / "x.csv", self.hug)):
                with self.assertRaisesRegex(FileNotFoundError,
                                            "program 'no-such-duet'.*DUET_PROG"):
                    use()


if __name__ == "__main__":
    unittest.main()
