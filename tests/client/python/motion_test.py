"""duet.Motion."""

import pickle
import unittest

import support
import duet
import numpy as np


class MotionTest(unittest.TestCase):
    def test_tells_its_shape(self):
        motion = support.leader(7)
        self.assertEqual((motion.frame_count, motion.joint_count), (7, 3))
        self.assertAlmostEqual(motion.duration_seconds, 0.2)
        np.testing.assert_allclose(motion.times, np.arange(7) / 30)
        self.assertEqual(repr(motion), "Motion(7 frames at 30 Hz, 3 joints, metres, y-up)")

    def test_keeps_a_copy_that_nobody_writes_to(self):
        positions = np.zeros((2, 3, 3))
        motion = support.leader(positions=positions)
        positions[:] = 1
        self.assertEqual(motion.positions.dtype, np.float32)
        self.assertFalse(motion.positions.any())
        with self.assertRaises(ValueError):
            motion.positions[0] = 1

    def test_finds_joints_by_name(self):
        motion = support.leader()
        np.testing.assert_array_equal(motion.joint("left"), motion.positions[:, 1])
        with self.assertRaisesRegex(KeyError, "knee.*wanted one of root, left, right"):
            motion.joint("knee")

    def test_selects_and_reorders_joints(self):
        motion = support.leader()
        chosen = motion.select(["right", "root"])
        self.assertEqual(chosen.joint_names, ("right", "root"))
        np.testing.assert_array_equal(chosen.positions, motion.positions[:, [2, 0]])
        self.assertEqual(chosen.frame_rate_hz, 30)

    def test_cuts_frames(self):
        motion = support.leader()
        np.testing.assert_array_equal(motion.frames(2, 4).positions, motion.positions[2:4])
        np.testing.assert_array_equal(motion.frames(-2).positions, motion.positions[-2:])

    def test_refuses_what_makes_no_sense_by_field(self):
        for changes, message in (
                ({"positions": np.zeros((6, 9))}, r"positions: shape \(6, 9\), wanted \(frames"),
                ({"positions": np.zeros((6, 3, 2))}, r"positions: shape \(6, 3, 2\)"),
                ({"positions": np.zeros((6, 4, 3))}, "positions: 4 joints, wanted the 3"),
                ({"joint_names": ("a", "b", "a")}, "joint_names: a more than once"),
                ({"joint_names": "abc"}, "joint_names: 'abc', wanted a sequence"),
                ({"unit": "feet"}, "unit: 'feet', wanted one of metres, millimetres"),
                ({"up_axis": "up"}, "up_axis: 'up', wanted one of y-up, z-up, y-down")):
            with self.subTest(changes=list(changes)), self.assertRaisesRegex(ValueError, message):
                support.leader(**changes)

    def test_converts_units_and_axes_as_the_contract_has_them(self):
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

    def test_can_be_pickled_for_other_processes(self):
        motion = support.leader(unit="millimetres")
        copy = pickle.loads(pickle.dumps(motion))
        np.testing.assert_array_equal(copy.positions, motion.positions)
        self.assertEqual((copy.joint_names, copy.unit), (motion.joint_names, "millimetres"))


if __name__ == "__main__":
    unittest.main()
