"""The vertical of a tilted camera: estimates, and requests and results with `level`."""

import math
import os
import unittest
from unittest import mock

import support
import duet_motion as duet
import numpy as np
from duet_motion.request import to_proto

PROGRAM = support.PROGRAMS / "duet"
SAMPLES = support.SOURCE / "samples"
LABELS = {"hug": 1}


def tilted(motion, degrees):
    """The motion as a camera captures it that looks down by an angle."""
    angle = math.radians(degrees)
    turn = np.array([[1, 0, 0], [0, math.cos(angle), -math.sin(angle)],
                     [0, math.sin(angle), math.cos(angle)]])
    return motion.with_positions(motion.positions @ turn.T)


@unittest.skipUnless(PROGRAM.exists(), f"no program at {PROGRAM}; build it, or set DUET_BIN_DIR")
class LevellingTest(unittest.TestCase):
    def setUp(self):
        self.enterContext(mock.patch.dict(os.environ, {"DUET_PROGRAM": str(PROGRAM)}))
        self.dance = duet.read_motion(SAMPLES / "salsa.bvh")  # turns, so its vertical is certain
        self.hug = duet.read_motion(SAMPLES / "hug.bvh")      # faces one way

    def test_a_tilted_camera_is_found(self):
        found = duet.estimate_vertical(tilted(self.dance, 15))
        self.assertEqual(found.verdict, "tilted")
        self.assertRegex(str(found), r"^tilted by \d+\.\d degrees \(.* towards x, .* towards z; \+- ")
        np.testing.assert_allclose(np.linalg.norm(found.up), 1, atol=1e-6)
        expected = (0, math.cos(math.radians(15)), math.sin(math.radians(15)))
        self.assertGreater(np.dot(found.up, expected), math.cos(math.radians(6)))
        self.assertGreater(found.places, 1)

    def test_the_estimate_is_in_the_axes_of_the_motion(self):
        people = tilted(self.dance, 15)
        x, y, z = duet.estimate_vertical(people).up
        turned = duet.estimate_vertical(people.converted("millimetres", "z-up"))
        np.testing.assert_allclose(turned.up, (x, -z, y), atol=1e-4)
        down = duet.estimate_vertical(people.converted("metres", "y-down"))
        np.testing.assert_allclose(down.up, (x, -y, -z), atol=1e-4)

    def test_auto_levels_only_on_strong_evidence(self):
        strong = duet.SynthesisRequest(tilted(self.dance, 15), LABELS, level="auto")
        self.assertEqual(strong.vertical, duet.estimate_vertical(strong.leader))
        up = to_proto(strong).up
        np.testing.assert_allclose((up.x, up.y, up.z), strong.vertical.up, atol=1e-6)
        self.assertIsNone(strong.up)
        weak = duet.SynthesisRequest(tilted(self.hug, 15), LABELS, level="auto")
        self.assertEqual(weak.vertical.verdict, "unknown")
        self.assertFalse(to_proto(weak).HasField("up"))

    def test_the_result_reports_what_was_found(self):
        leader = tilted(self.dance, 15)
        reply = support.good_reply(leader, size=leader.frame_count)
        script = support.Script(reply, reply)
        with support.serving(script) as address, duet.Client(address) as client:
            found = client.synthesize(leader, LABELS, level="auto").vertical
            self.assertEqual(found.verdict, "tilted")
            self.assertIsNone(client.synthesize(leader, LABELS).vertical)
        self.assertEqual([request.HasField("up") for request in script.requests], [True, False])

    def test_errors_name_the_field(self):
        for arguments, message in (
                ({"level": "on"}, "level: expected auto or off, or a duet_motion.VerticalEstimate, got "
                                  "'on'"),
                ({"level": None}, "level: expected auto or off, .*, got None"),
                ({"level": (0, 1, 0)}, r"level: expected auto or off, .*, got \(0, 1, 0\)"),
                ({"level": "auto", "up": (0, 1, 0)}, "level: expected 'off' beside up, got 'auto'")):
            with self.assertRaisesRegex(ValueError, f"^{message}"):
                duet.SynthesisRequest(self.hug, LABELS, **arguments)
        with self.assertRaisesRegex(ValueError, "^level: motion: joints: expected joints for head"):
            duet.SynthesisRequest(support.leader(), LABELS, level="auto")
        with self.assertRaisesRegex(ValueError, "^leader: expected a duet_motion.Motion, got 'hug'"):
            duet.estimate_vertical("hug")


if __name__ == "__main__":
    unittest.main()
