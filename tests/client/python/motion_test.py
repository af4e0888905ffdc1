"""duet.Motion."""

import unittest

import support
import numpy as np


class MotionTest(unittest.TestCase):
    def test_has_shape_and_duration(self):
        motion = support.leader(7)
        self.assertEqual((motion.frame_count, motion.joint_count), (7, 3))
        self.assertEqual(repr(motion), "Motion(7 frames at 30 Hz, 3 joints, metres, y-up)")

    def test_keeps_a_read_only_copy(self):
        positions = np.zeros((2, 3, 3))
        motion = support.leader(positions=positions)
        positions[:] = 1
        self.assertEqual(motion.positions.dtype, np.float32)
        self.assertFalse(motion.positions.any())
        with self.assertRaises(ValueError):
            motion.positions[0] = 1

    def test_selects_and_reorders_joints(self):
        motion = support.leader()
        chosen = motion.select(["right", "root"])
        self.assertEqual(chosen.joint_names, ("right", "root"))
        np.testing.assert_array_equal(chosen.positions, motion.positions[:, [2, 0]])
        self.assertEqual(chosen.frame_rate_hz, 30)

    def test_invalid_arguments_name_their_field(self):
        for changes, message in (
                ({"positions": np.zeros((6, 9))}, r"positions: expected the shape \(frames.*\(6, 9\)"),
                ({"positions": []}, r"positions: expected the shape .* got \(0,\)"),
                ({"positions": np.zeros((6, 4, 3))}, "positions: expected the 3 joints .* got 4"),
                ({"positions": [[[1, 2, 3]] * 3, [[1, 2]] * 3]}, "positions: expected an array of num"),
                ({"positions": np.full((6, 3, 3), "a")}, "positions: expected real numbers, got .*U1"),
                ({"positions": np.full((6, 3, 3), None)}, "positions: .*, got .*object"),
                ({"joint_names": ("a", "b", "a")}, "joint_names: .*, got duplicates of a"),
                ({"joint_names": "abc"}, "joint_names: expected a sequence of names, got 'abc'"),
                ({"joint_names": None}, "joint_names: expected a sequence of names, got None"),
                ({"joint_names": ("a", 2, "c")}, "joint_names: expected a name for each joint, got 2"),
                ({"frame_rate_hz": 0}, "frame_rate_hz: expected a finite number above 0, got 0"),
                ({"frame_rate_hz": np.nan}, "frame_rate_hz: .* got nan"),
                ({"frame_rate_hz": 10**400}, "frame_rate_hz: expected a finite"),
                ({"frame_rate_hz": "30"}, "frame_rate_hz: .* got '30'"),
                ({"frame_rate_hz": True}, "frame_rate_hz: .* got True"),
                ({"unit": "feet"}, "unit: expected one of metres, millimetres, .* got 'feet'"),
                ({"up_axis": "up"}, "up_axis: expected one of y-up, z-up, y-down, got 'up'")):
            with self.subTest(changes=list(changes)), self.assertRaisesRegex(ValueError, message):
                support.leader(**changes)

    def test_value_that_is_not_finite_names_frame_joint_and_axis(self):
        for value, told in ((np.nan, "nan"), (-np.inf, "-inf"), (1e300, r"1e\+300")):
            positions = np.zeros((6, 3, 3))
            positions[4, 1, 2] = value
            with self.subTest(value=value), self.assertRaisesRegex(
                    ValueError, rf"positions\[4, 1, 2\]: expected a finite float32, got {told} at "
                                "frame 4, joint 'left', z$"):
                support.leader(positions=positions)

    def test_resamples_as_the_program_does(self):
        # The rule of ResampledFrameCount (tests/motion/resample_test.cc): the end is never cut off.
        motion = support.leader(7)
        for rate, frames in ((30, 7), (15, 4), (20, 5), (60, 13), (7, 3), (0.1, 2)):
            self.assertEqual(motion.resampled(rate).frame_count, frames, rate)
        half = motion.resampled(60)
        np.testing.assert_allclose(half.positions[1], motion.positions[:2].mean(axis=0))
        np.testing.assert_array_equal(half.positions[::2], motion.positions)
        self.assertEqual(half.frame_rate_hz, 60)
        np.testing.assert_array_equal(motion.resampled(20).positions[-1], motion.positions[-1])
        with self.assertRaisesRegex(ValueError, "frame_rate_hz: .* got -1"):
            motion.resampled(-1)

    def test_converts_units_and_axes_as_the_api_defines(self):
        # One metre right, two up, three towards the viewer.
        inner = support.leader(positions=np.tile(np.float32([1, 2, 3]), (2, 3, 1)))
        for unit, up_axis, wanted in (("metres", "y-up", [1, 2, 3]),
                                      ("metres", "z-up", [1, -3, 2]),
                                      ("metres", "y-down", [1, -2, -3]),
                                      ("millimetres", "z-up", [1000, -3000, 2000])):
            with self.subTest(unit=unit, up_axis=up_axis):
                outer = inner.converted(unit, up_axis)
                np.testing.assert_allclose(outer.positions[0, 0], wanted)
                self.assertEqual((outer.unit, outer.up_axis), (unit, up_axis))
                np.testing.assert_allclose(outer.converted().positions, inner.positions, rtol=1e-6)
        with self.assertRaisesRegex(ValueError, "sbu-normalised"):
            inner.converted("sbu-normalised")


if __name__ == "__main__":
    unittest.main()
