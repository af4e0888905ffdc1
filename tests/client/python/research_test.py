"""The layouts of research."""

import pathlib
import tempfile
import unittest

import support
import duet_motion as duet
import numpy as np
from duet_motion import research

HUG = support.SOURCE / "samples" / "hug.bvh"


class ResearchTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        # Two clouds of joints that drift.
        self.pair = np.random.default_rng(1).normal(0, 0.01, (2, 240, 22, 3)).cumsum(axis=1).astype(np.float32)

    def test_positions_come_from_humanml3d_features(self):
        at = self.pair[0] - self.pair[0, 0, 0] * [1, 0, 1]
        angle = 0.03 * np.arange(len(at))  # of the heading: any will do
        c, s, zero = np.cos(angle), np.sin(angle), np.zeros(len(at))
        turns = np.stack([c, zero, s, zero, 1 + zero, zero, -s, zero, c], axis=-1).reshape(-1, 3, 3)
        local = (at - at[:, :1] * [1, 0, 1]) @ turns.transpose(0, 2, 1)
        way = ((at[1:, :1] - at[:-1, :1]) @ turns[1:].transpose(0, 2, 1))[:, 0]
        features = np.concatenate([np.diff(angle)[:, None] / 2, way[:, [0, 2]], at[:-1, 0, 1:2],
                                   local[:-1, 1:].reshape(-1, 63), np.zeros((len(at) - 1, 196))], axis=1)
        [person] = research.read(features)
        self.assertEqual((person.frame_rate_hz, person.joint_names), (20, research.JOINTS))
        np.testing.assert_allclose(person.positions, at[:-1], atol=1e-4)

    def test_positions_are_read_from_every_shape(self):
        one = self.pair[0]
        wide = np.concatenate([one, np.zeros((240, 33, 3), np.float32)], axis=1)
        for array, layout, people in ((one, "inter-x", 1), (one.reshape(240, 66), "humanml3d", 1),
                                      (wide, "humanml3d", 1), (self.pair, "intergen", 2)):
            motions = research.read(array, layout)
            self.assertEqual(len(motions), people)
            np.testing.assert_array_equal(motions[0].positions, one)
            self.assertEqual(motions[0].frame_rate_hz, research.LAYOUTS[layout])
        features = np.concatenate([one.reshape(240, 66), np.zeros((240, 196))], axis=1)  # InterGen's
        for array, people in ((features, 1), (np.stack([features] * 2), 2),
                              (np.concatenate([features] * 2, axis=1), 2)):  # one after the other, or in a row
            motions = research.read(array)
            self.assertEqual(len(motions), people)
            np.testing.assert_array_equal(motions[-1].positions, one)
        interhuman, = research.read(np.concatenate([one.reshape(240, 66), np.zeros((240, 426))], axis=1))
        self.assertEqual((interhuman.up_axis, interhuman.frame_rate_hz), ("z-up", 30))
        self.assertEqual(research.read(one, "inter-x", 120)[0].frame_rate_hz, 120)

    def test_files_round_trip_at_the_rate_of_the_layout(self):
        person = duet.Motion(self.pair[0], research.JOINTS, 60)
        research.write(self.folder / "one.npy", [person], "humanml3d")
        [again] = research.read(self.folder / "one.npy", "humanml3d")
        self.assertEqual((again.frame_count, again.frame_rate_hz), (81, 20))
        np.testing.assert_allclose(again.positions[1], self.pair[0][3], atol=1e-6)

    def test_the_joints_of_duet_become_body_joints_and_back(self):
        try:
            hug = duet.read_motion(HUG)
        except FileNotFoundError as missing:
            self.skipTest(str(missing))
        [body] = research.read(research.to_array([hug], "intergen"), "intergen")
        duet.write_motion(self.folder / "body.json", body)
        again = duet.read_motion(self.folder / "body.json")
        for joint in ("left_hand", "right_knee", "left_hip", "neck"):
            np.testing.assert_allclose(again.joint(joint), hug.joint(joint), atol=1e-5)

    def test_errors_name_what_is_wrong(self):
        one = duet.Motion(self.pair[0], research.JOINTS, 20)
        hands = duet.Motion(np.zeros((5, 1, 3)), ["left_hand"], 20)
        for call, error in (
                (lambda: research.read(self.pair[0]), "layout: expected one of humanml3d"),
                (lambda: research.read(self.pair[0], "humanml3d-263"), "a shape of layout humanml3d-263"),
                (lambda: research.read(np.full((4, 22, 3), np.nan), "inter-x"), "finite positions"),
                (lambda: research.read(np.zeros((3, 4, 22, 3)), "inter-x"), "one person or two"),
                (lambda: research.to_array([one], "humanml3d-263"), "layout: expected one of humanml3d, intergen"),
                (lambda: research.to_array([one] * 3, "intergen"), "people: expected one or two, got 3"),
                (lambda: research.to_array([hands], "humanml3d"), "joints: expected neck, left_shoulder")):
            with self.assertRaisesRegex(ValueError, error):
                call()


if __name__ == "__main__":
    unittest.main()
