"""duet.SynthesisRequest, and how it goes over the wire."""

import unittest

import support
import duet
import numpy as np
from duet.request import to_proto, to_selector
from duet.v1 import motion_pb2, synthesis_pb2


class RequestTest(unittest.TestCase):
    def request(self, **fields):
        return duet.SynthesisRequest(support.leader(), {"hug": 1, "push": 0.5}, **fields)

    def test_carries_the_leader_as_it_is(self):
        leader = support.leader(unit="millimetres", up_axis="z-up", frame_rate_hz=24)
        wire = to_proto(duet.SynthesisRequest(leader, {"hug": 1})).leader
        self.assertEqual(list(wire.joint_names), ["root", "left", "right"])
        self.assertEqual((wire.frame_rate_hz, wire.frame_count), (24, 6))
        self.assertEqual((wire.unit, wire.up_axis),
                         (motion_pb2.LENGTH_UNIT_MILLIMETRES, motion_pb2.UP_AXIS_Z_UP))
        np.testing.assert_array_equal(np.reshape(wire.positions, (6, 3, 3)), leader.positions)

    def test_carries_every_field(self):
        wire = to_proto(self.request(
            seed=2**64 - 1, variety=0.5, model="sbu@2", clean_up=False, priority="bulk",
            chunk_frames=8, partner_direction=(0, 0, 1)))
        self.assertEqual([(w.interaction_class, w.weight) for w in wire.label_vector.weights],
                         [("hug", 1), ("push", 0.5)])
        self.assertEqual((wire.seed, wire.variety, wire.chunk_frames), (2**64 - 1, 0.5, 8))
        self.assertEqual((wire.model.name, wire.model.version), ("sbu", 2))
        self.assertEqual(wire.clean_up, synthesis_pb2.CLEAN_UP_OFF)
        self.assertEqual(wire.priority, synthesis_pb2.PRIORITY_BULK)
        self.assertEqual(wire.partner_direction.z, 1)
        self.assertFalse(wire.HasField("follower_start"))

    def test_what_is_absent_stays_absent(self):
        wire = to_proto(duet.SynthesisRequest(support.leader()))
        for field in ("label_vector", "follower_start", "partner_direction", "chunk_frames"):
            self.assertFalse(wire.HasField(field), field)
        self.assertEqual(wire.clean_up, synthesis_pb2.CLEAN_UP_UNSPECIFIED)

    def test_keyframes_go_in_the_order_of_their_frames(self):
        wire = to_proto(duet.SynthesisRequest(
            support.leader(), keyframes={4: {"push": 1}, 0: {"hug": 1}}))
        self.assertEqual([(k.frame, k.label_vector.weights[0].interaction_class)
                          for k in wire.label_keyframes], [(0, "hug"), (4, "push")])
        self.assertFalse(wire.HasField("label_vector"))

    def test_a_follower_starts_at_a_point_or_in_a_pose(self):
        point = to_proto(self.request(follower_start=(1, 2, 3))).follower_start
        self.assertEqual((point.root_position.x, point.root_position.z), (1, 3))
        pose = to_proto(self.request(follower_start=np.ones((3, 3)))).follower_start
        self.assertEqual(list(pose.pose.positions), [1] * 9)

    def test_refuses_what_makes_no_sense_by_field(self):
        for fields, message in (
                ({"priority": "high"}, "priority: 'high', wanted one of interactive, bulk"),
                ({"chunk_frames": 0}, "chunk_frames: 0, wanted 1 or more"),
                ({"seed": -1}, "seed: -1, wanted 0 to"),
                ({"seed": 2**64}, "seed: 18446744073709551616, wanted 0 to"),
                ({"keyframes": {-1: {}}}, "keyframes: frame -1, wanted 0 or more"),
                ({"model": "sbu@0"}, "model: 'sbu@0', wanted a version of 1 or more"),
                ({"model": "sbu@x"}, "model: 'sbu@x', wanted a version"),
                ({"model": "sbu:"}, "model: 'sbu:', wanted a label"),
                ({"follower_start": (1, 2)}, r"follower_start: shape \(2,\), wanted \(3,\) or"),
                ({"partner_direction": 1}, r"partner_direction: shape \(\), wanted \(3,\)")):
            with self.subTest(fields=fields), self.assertRaisesRegex(ValueError, message):
                self.request(**fields)

    def test_refuses_what_is_of_another_type_by_field(self):
        for arguments, message in (
                ((None,), "leader: None, wanted a duet.Motion"),
                ((support.leader(), ["hug"]), r"labels: \['hug'\], wanted weights by class"),
                ((support.leader(), {"hug": "1"}), r"labels\['hug'\]: '1', wanted a number"),
                ((support.leader(), {1: 1}), "labels: class 1, wanted a str"),
                ((support.leader(), None, [{"hug": 1}]), "keyframes: .*, wanted labels by frame"),
                ((support.leader(), None, {"0": {}}), "keyframes: frame '0', wanted 0 or more"),
                ((support.leader(), None, {4: "hug"}), r"keyframes\[4\]: 'hug', wanted weights")):
            with self.subTest(message=message), self.assertRaisesRegex(ValueError, message):
                duet.SynthesisRequest(*arguments)
        weights = {"hug": np.float32(1), "push": np.int64(0)}
        self.assertEqual(len(to_proto(duet.SynthesisRequest(
            support.leader(), keyframes={np.int64(3): weights})).label_keyframes), 1)

    def test_chooses_models_as_the_program_does(self):
        self.assertEqual(to_selector("sbu:stable").version_label, "stable")
        self.assertEqual(to_selector("").WhichOneof("version_choice"), None)


if __name__ == "__main__":
    unittest.main()
