"""Checks of each message of a reply; the Python version of tests/client/reply_assembler_test.cc."""

import unittest

import support
import duet_motion as duet
import grpc
import numpy as np
from duet_motion._reply import ReplyAssembler
from duet_motion.errors import make_error
from duet_motion.v1 import motion_pb2, reaction_pb2, synthesis_pb2


class ReplyTest(unittest.TestCase):
    def setUp(self):
        self.leader = support.leader()
        self.reply = ReplyAssembler(self.leader)

    def accept(self, *responses):
        return [self.reply.accept(response) for response in responses]

    def test_valid_reply_gives_the_result(self):
        chunks = self.accept(*support.good_reply(self.leader, size=4))
        self.assertEqual([c and (c.first_frame, len(c.positions)) for c in chunks],
                         [None, (0, 4), (4, 2), None])
        self.assertIsNone(self.reply.end_stream(None))
        result = self.reply.result(2, 0.1, 0.2)
        np.testing.assert_array_equal(result.follower.positions, support.follower_of(self.leader))
        self.assertEqual((result.model_name, result.model_version, result.seed, result.variety),
                         ("m", 1, 3, 0.5))
        self.assertEqual((result.cleaned_up, result.unfamiliarity, result.request_id),
                         (True, 0.75, "r"))
        self.assertEqual((result.candidates, result.grade), (4, None))
        self.assertEqual(result.timings, duet.Timings(0.1, 0.2, 0.25, 0.5))
        self.assertEqual((result.attempt_count, result.window_count), (2, 1))

    def test_grade_is_returned(self):
        runs = [reaction_pb2.FrameRun(first_frame=1, frame_count=2)]
        grade = reaction_pb2.MotionGrade(twisted=0.25, skating=0.5, leader_skating=0.75,
                                          overlapping=1, bad_runs=runs)
        whole = support.good_reply(self.leader, size=6)
        self.accept(*whole[:2], support.summary(self.leader, 1, grade=grade))
        self.assertEqual(self.reply.result(1, 0, 0).grade,
                         duet.MotionGrade(0.25, 0.5, 0.75, 1, (duet.FrameRun(1, 2),)))

    def test_what_remains_at_the_constraints_is_returned(self):
        whole = support.good_reply(self.leader, size=6)
        for metres, message in (([], "expected 2 values.*got 0; does the server know constraints"),
                                ([0.5], "got 1")):
            self.reply = ReplyAssembler(self.leader, constraints=2)
            self.accept(*whole[:2])
            with self.assertRaisesRegex(duet.MalformedReplyError, message):
                self.accept(support.summary(self.leader, 1, constraint_metres=metres))
        self.accept(support.summary(self.leader, 1, constraint_metres=[0.5, 0]))
        self.assertEqual(self.reply.result(1, 0, 0).constraint_metres, (0.5, 0))

    def test_malformed_messages_are_rejected(self):
        leader, head = self.leader, support.header(self.leader)
        whole = support.good_reply(leader, size=6)
        follower = support.follower_of(leader).ravel().tolist()
        nan = [*follower[:5], float("nan"), *follower[6:]]
        empty = synthesis_pb2.SynthesizeResponse()
        for responses, message in (
                ([empty], "without a payload"),
                ([support.chunk(leader, 0, 2)], "a chunk before the header"),
                ([support.summary(leader, 0)], "a summary before the header"),
                ([head, head], "a second header"),
                ([support.header(leader, joint_names=["root", "right", "left"])], "joint_names"),
                ([support.header(leader, frame_rate_hz=15)], "frame_rate_hz: .*30.0, got 15.0"),
                ([support.header(leader, unit=2)], "unit and up_axis"),
                ([support.header(leader, up_axis=2)], "unit and up_axis"),
                ([support.header(leader, frame_count=5)], "frame_count: .* leader's 6, got 5"),
                ([head, support.chunk(leader, 1, 2)], "first_frame: expected 0, got 1"),
                ([head, support.chunk(leader, 0, 0)], "frame_count: expected 1 to 6, got 0"),
                ([head, support.chunk(leader, 0, 7)], "frame_count: expected 1 to 6, got 7"),
                ([head, support.chunk(leader, 0, 2, positions=[0])], "expected 18 val.* got 1$"),
                ([head, support.chunk(leader, 0, 6, positions=nan)], r"positions\[5\]: .* got nan"),
                ([head, support.chunk(leader, 0, 2), support.summary(leader, 1)],
                 "a summary after 2 of 6 frames"),
                ([*whole[:2], support.summary(leader, 1, frame_count=5)],
                 "summary.frame_count: expected 6, got 5"),
                ([*whole[:2], support.summary(leader, 2)], "chunk_count: expected 1, got 2"),
                ([*whole, head], "a message after the summary")):
            with self.subTest(message=message):
                self.reply.start_stream()
                with self.assertRaisesRegex(duet.MalformedReplyError, message):
                    self.accept(*responses)

    def with_rotations(self, rig=None, rotations=None):
        """A good reply with a rig of two joints; a quaternion of frame f is a turn by f / 10."""
        responses = support.good_reply(self.leader, size=4)
        responses[0].header.rig.extend(rig or [
            motion_pb2.RigJoint(name="root", parent=-1),
            motion_pb2.RigJoint(name="left", parent=0, joint=1, offset={"y": 0.5})])
        for response in responses:
            if response.WhichOneof("payload") == "chunk":
                first, count = response.chunk.first_frame, response.chunk.frame_count
                angles = np.repeat(np.arange(first, first + count) / 20, 2)
                zeros = np.zeros_like(angles)
                quaternions = np.stack([np.sin(angles), zeros, zeros, np.cos(angles)], axis=-1)
                response.chunk.rotations.extend(
                    quaternions.ravel() if rotations is None else rotations)
        return responses

    def test_rotations_are_arrays(self):
        self.reply = ReplyAssembler(self.leader, rotations=True)
        chunks = self.accept(*self.with_rotations())
        self.assertEqual(chunks[2].rotations.rotations.shape, (2, 2, 4))
        self.assertIsNone(self.reply.end_stream(None))
        rotations = self.reply.result(1, 0.1, 0.2).rotations
        self.assertEqual(rotations.rig, (duet.RigJoint("root", -1, (0, 0, 0), 0),
                                         duet.RigJoint("left", 0, (0, 0.5, 0), 1)))
        self.assertEqual(rotations.rotations.shape, (6, 2, 4))
        np.testing.assert_allclose(rotations.rotations[5, 1], (np.sin(0.25), 0, 0, np.cos(0.25)),
                                   rtol=1e-6)

    def test_rotations_have_the_columns_of_their_matrices(self):
        quarter = np.sqrt(0.5)
        quaternions = np.float32([[[0, 0, 0, 1], [0, 0, quarter, quarter]]])
        six = duet.JointRotations((), quaternions).rotations_6d
        np.testing.assert_allclose(six, [[[1, 0, 0, 0, 1, 0], [0, 1, 0, -1, 0, 0]]], atol=1e-6)

    def test_malformed_rotations_are_rejected(self):
        def rig(**second):
            return [motion_pb2.RigJoint(name="root", parent=-1),
                    motion_pb2.RigJoint(**{"name": "left", "joint": 1, **second})]
        nan = [float("nan")] * 32
        for asked, responses, message in (
                (True, support.good_reply(self.leader), "header.rig: expected joints"),
                (False, self.with_rotations(), "none without reply_rotations"),
                (True, self.with_rotations(rig()[1:]), r"rig\[0\].parent: expected -1, got 0"),
                (True, self.with_rotations(rig(parent=1)), r"\[1\].parent: expected 0 to 0, got 1"),
                (True, self.with_rotations(rig(joint=3)), "joint: expected 0 to 2, got 3"),
                (True, self.with_rotations(rig(name="root")), "name: .* got 'root' again"),
                (True, self.with_rotations(rig(offset={"x": float("inf")})), "offset: expected fin"),
                (True, self.with_rotations(rotations=[1]),
                 "expected 32 values for 4 frames, got 1, in the chunk of frame 0"),
                (True, self.with_rotations(rotations=[1] * 32), r"\[0..3\]: .* got norm 2.0"),
                (True, self.with_rotations(rotations=nan), "a unit quaternion, got norm nan")):
            with self.subTest(message=message):
                self.reply = ReplyAssembler(self.leader, asked)
                with self.assertRaisesRegex(duet.MalformedReplyError, message):
                    self.accept(*responses)

    def test_error_with_a_reason_is_kept(self):
        self.accept(support.header(self.leader))
        failed = make_error(grpc.StatusCode.INTERNAL, "failed", reason="MODEL_FAILED")
        self.assertIs(self.reply.end_stream(failed), failed)


if __name__ == "__main__":
    unittest.main()
