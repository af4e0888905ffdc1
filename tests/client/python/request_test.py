"""duet.SynthesisRequest and its wire format."""

import unittest

import support
import duet_motion as duet
import numpy as np
from duet_motion.request import to_proto
from duet_motion.v1 import motion_pb2, reaction_pb2, synthesis_pb2


class RequestTest(unittest.TestCase):
    def request(self, **fields):
        return duet.SynthesisRequest(support.leader(), {"hug": 1, "push": 0.5}, **fields)

    def test_leader_is_sent_unchanged(self):
        leader = support.leader(unit="millimetres", up_axis="z-up", frame_rate_hz=24)
        wire = to_proto(duet.SynthesisRequest(leader, {"hug": 1})).leader
        self.assertEqual(list(wire.joint_names), ["root", "left", "right"])
        self.assertEqual((wire.frame_rate_hz, wire.frame_count), (24, 6))
        self.assertEqual((wire.unit, wire.up_axis),
                         (motion_pb2.LENGTH_UNIT_MILLIMETRES, motion_pb2.UP_AXIS_Z_UP))
        np.testing.assert_array_equal(np.reshape(wire.positions, (6, 3, 3)), leader.positions)

    def test_every_field_is_sent(self):
        wire = to_proto(self.request(
            seed=2**64 - 1, variety=0.5, reaction=1.5, model="sbu@2", clean_up=False, priority="bulk",
            chunk_frames=8, partner_direction=(0, 0, 1), candidates=4, rotations=True,
            up=(0.25, 0, 1)))
        self.assertEqual([(w.interaction_class, w.weight) for w in wire.label_vector.weights],
                         [("hug", 1), ("push", 0.5)])
        self.assertEqual((wire.seed, wire.variety, wire.reaction, wire.chunk_frames),
                         (2**64 - 1, 0.5, 1.5, 8))
        self.assertEqual(wire.candidates, 4)
        self.assertEqual((wire.model.name, wire.model.version), ("sbu", 2))
        self.assertEqual(wire.clean_up, reaction_pb2.CLEAN_UP_OFF)
        self.assertEqual(wire.priority, synthesis_pb2.PRIORITY_BULK)
        self.assertEqual(wire.partner_direction.z, 1)
        self.assertTrue(wire.reply_rotations)
        self.assertEqual((wire.up.x, wire.up.y, wire.up.z), (0.25, 0, 1))
        self.assertFalse(wire.HasField("follower_start"))

    def test_unset_fields_stay_absent(self):
        wire = to_proto(duet.SynthesisRequest(support.leader()))
        for field in ("label_vector", "follower_start", "partner_direction", "up", "chunk_frames"):
            self.assertFalse(wire.HasField(field), field)
        self.assertEqual(wire.clean_up, reaction_pb2.CLEAN_UP_UNSPECIFIED)
        self.assertEqual(wire.candidates, 1)
        self.assertFalse(wire.reply_rotations)

    def test_constraints_are_sent_in_order(self):
        self.assertEqual(len(to_proto(self.request()).constraints), 0)
        wire = to_proto(self.request(constraints=[
            duet.Constraint("left", 4, (1, 2, 3), softness=0.5),
            duet.Constraint("right", 0, np.float32([0, 1, 0]))])).constraints
        self.assertEqual([(c.joint_name, c.frame, c.softness) for c in wire],
                         [("left", 4, 0.5), ("right", 0, 0)])
        self.assertEqual((wire[0].position.x, wire[0].position.y, wire[0].position.z), (1, 2, 3))

    def test_invalid_constraints_are_named(self):
        for arguments, message in (
                ((3, 0, (0, 1, 0)), "joint: expected a str, got 3"),
                (("left", -1, (0, 1, 0)), "frame: expected an integer from 0 to .*, got -1"),
                (("left", 1.5, (0, 1, 0)), "frame: expected an integer"),
                (("left", 0, (0, 1)), r"position: expected the shape \(3,\), got \(2,\)"),
                (("left", 0, None), r"position: expected the shape \(3,\), got None"),
                (("left", 0, (0, np.nan, 0)), r"position\[1\]: expected a finite float32, got nan"),
                (("left", 0, (0, 1, 0), 1.5), "softness: expected a number from 0 to 1, got 1.5"),
                (("left", 0, (0, 1, 0), "a"), "softness: expected a number from 0 to 1, got 'a'")):
            with self.assertRaisesRegex(ValueError, message):
                duet.Constraint(*arguments)
        with self.assertRaisesRegex(ValueError, "constraints: expected a list of "
                                                "duet_motion.Constraint, got 'left'"):
            self.request(constraints="left")
        with self.assertRaisesRegex(ValueError, r"constraints\[0\]: expected a "
                                                r"duet_motion.Constraint, got \('left', 0\)"):
            self.request(constraints=[("left", 0)])

    def test_keyframes_are_sorted_by_frame(self):
        wire = to_proto(duet.SynthesisRequest(
            support.leader(), keyframes={4: {"push": 1}, 0: {"hug": 1}}))
        self.assertEqual([(k.frame, k.label_vector.weights[0].interaction_class)
                          for k in wire.label_keyframes], [(0, "hug"), (4, "push")])
        self.assertFalse(wire.HasField("label_vector"))

    def test_follower_start_is_a_point_or_a_pose(self):
        point = to_proto(self.request(follower_start=(1, 2, 3))).follower_start
        self.assertEqual((point.root_position.x, point.root_position.z), (1, 3))
        pose = to_proto(self.request(follower_start=np.ones((3, 3)))).follower_start
        self.assertEqual(list(pose.pose.positions), [1] * 9)

    def test_invalid_values_name_their_field(self):
        pose = np.ones((3, 3))
        pose[1, 2] = np.nan
        for fields, message in (
                ({"priority": "high"}, "priority: expected one of interactive, bulk, got 'high'"),
                ({"chunk_frames": 0}, "chunk_frames: expected an integer from 1 to .*, got 0"),
                ({"seed": -1}, "seed: expected an integer from 0 to .*, got -1"),
                ({"seed": 2**64}, "seed: .* got 18446744073709551616"),
                ({"seed": True}, "seed: .* got True"),
                ({"variety": float("nan")}, "variety: expected a number, got nan"),
                ({"reaction": "much"}, "reaction: expected a number, got 'much'"),
                ({"candidates": 17}, "candidates: expected an integer from 1 to 16, got 17"),
                ({"clean_up": "auto"}, "clean_up: expected True, False or None, got 'auto'"),
                ({"request_id": 7}, "request_id: expected a str, got 7"),
                ({"request_id": "caf\u00e9"}, "request_id: expected 1 to 128 printable ASCII characters "
                                               "without spaces, got 'caf\u00e9'"),
                ({"request_id": "x" * 129}, "request_id: expected 1 to 128"),
                ({"timeout": 0}, "timeout: expected a finite number above 0, got 0"),
                ({"keyframes": {-1: {}}}, "keyframes: frame: expected an integer .* got -1"),
                ({"model": 2}, "model: expected a str, got 2"),
                ({"model": "sbu@x"}, "model: expected a version .*, got 'sbu@x'"),
                ({"model": "sbu:"}, "model: expected a label .*, got 'sbu:'"),
                ({"follower_start": (1, 2)},
                 r"follower_start: expected the shape \(3,\) or \(3, 3\), got \(2,\)"),
                ({"follower_start": pose},
                 r"follower_start\[1, 2\]: expected a finite float32, got nan at joint 'left'"),
                ({"follower_start": (0, 1e300, 0)}, r"follower_start\[1\]: .* got 1e\+300$"),
                ({"partner_direction": ("a", "b", "c")}, "partner_direction: expected real numbers"),
                ({"rotations": 1}, "rotations: expected True or False, got 1"),
                ({"up": (0, 1)}, r"up: expected the shape \(3,\), got \(2,\)"),
                ({"up": (0, np.nan, 0)}, r"up\[1\]: expected a finite float32, got nan"),
                ({"partner_direction": 1},
                 r"partner_direction: expected the shape \(3,\), got \(\)")):
            with self.subTest(fields=fields), self.assertRaisesRegex(ValueError, message):
                self.request(**fields)

    def test_wrong_types_name_their_field(self):
        for arguments, message in (
                ((None,), "leader: expected a duet_motion.Motion, got None"),
                ((support.leader(), ["hug"]), r"labels: expected weights by class, .* got \['hug'\]"),
                ((support.leader(), {"hug": "1"}), r"labels\['hug'\]: expected a finite number, got '1'"),
                ((support.leader(), {"hug": 10**400}), r"labels\['hug'\]: expected a finite"),
                ((support.leader(), {1: 1}), "labels: expected classes of type str, got 1"),
                ((support.leader(), None, [{"hug": 1}]), "keyframes: expected labels by frame"),
                ((support.leader(), None, {"0": {}}), "keyframes: frame: expected an integer .* got '0'"),
                ((support.leader(), None, {4: "hug"}), r"keyframes\[4\]: expected weights by class, .*'hug'")):
            with self.subTest(message=message), self.assertRaisesRegex(ValueError, message):
                duet.SynthesisRequest(*arguments)
        weights = {"hug": np.float32(1), "push": np.int64(0)}
        self.assertEqual(len(to_proto(duet.SynthesisRequest(
            support.leader(), keyframes={np.int64(3): weights})).label_keyframes), 1)


if __name__ == "__main__":
    unittest.main()
