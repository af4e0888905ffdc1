"""A reply is checked message by message: tests/client/reply_assembler_test.cc for Python."""

import unittest

import support
import duet_motion as duet
import grpc
import numpy as np
from duet_motion._reply import ReplyAssembler
from duet_motion.errors import make_error
from duet_motion.v1 import synthesis_pb2


class ReplyTest(unittest.TestCase):
    def setUp(self):
        self.leader = support.leader()
        self.reply = ReplyAssembler(self.leader)

    def accept(self, *responses):
        return [self.reply.accept(response) for response in responses]

    def test_gathers_a_good_reply(self):
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
        self.assertEqual(result.timings, duet.Timings(0.1, 0.2, 0.25, 0.5))
        self.assertEqual((result.attempt_count, result.window_count), (2, 1))

    def test_refuses_what_breaks_the_contract(self):
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
                ([support.header(leader, frame_rate_hz=15)], "frame_rate_hz: 15.0, wanted"),
                ([support.header(leader, unit=2)], "unit and up_axis"),
                ([support.header(leader, up_axis=2)], "unit and up_axis"),
                ([support.header(leader, frame_count=5)], "frame_count: 5, wanted the leader's 6"),
                ([head, support.chunk(leader, 1, 2)], "first_frame: 1, wanted 0"),
                ([head, support.chunk(leader, 0, 0)], "frame_count: 0, wanted 1 to 6"),
                ([head, support.chunk(leader, 0, 7)], "frame_count: 7, wanted 1 to 6"),
                ([head, support.chunk(leader, 0, 2, positions=[0])], "1 values, wanted 18"),
                ([head, support.chunk(leader, 0, 6, positions=nan)], r"positions\[5\] is not fin"),
                ([head, support.chunk(leader, 0, 2), support.summary(leader, 1)],
                 "a summary after 2 of 6 frames"),
                ([*whole[:2], support.summary(leader, 1, frame_count=5)], "summary.frame_count: 5"),
                ([*whole[:2], support.summary(leader, 2)], "chunk_count: 2, but 1 chunks came"),
                ([*whole[:2], support.summary(leader, 1, unfamiliarity=-1)], "unfamiliarity: -1"),
                ([*whole, head], "a message after the summary")):
            with self.subTest(message=message):
                self.reply.start_stream()
                with self.assertRaisesRegex(duet.MalformedReplyError, message):
                    self.accept(*responses)

    def test_frames_of_a_second_stream_are_handed_out_once(self):
        self.accept(*support.good_reply(self.leader, size=4)[:2])
        self.reply.start_stream()
        chunks = self.accept(*support.good_reply(self.leader, size=3))
        self.assertEqual([c and (c.first_frame, len(c.positions)) for c in chunks],
                         [None, None, (4, 2), None])
        np.testing.assert_array_equal(chunks[2].positions, support.follower_of(self.leader)[4:])

    def test_an_early_end_may_be_tried_again(self):
        self.accept(support.header(self.leader), support.chunk(self.leader, 0, 2))
        ended = self.reply.end_stream(None)
        self.assertIsInstance(ended, duet.UnavailableError)
        self.assertIn("without a summary, after 2 of 6 frames", ended.message)
        reset = self.reply.end_stream(make_error(grpc.StatusCode.INTERNAL, "RST_STREAM"))
        self.assertIsInstance(reset, duet.UnavailableError)
        self.assertIn("RST_STREAM", reset.message)

    def test_what_the_service_itself_says_stands(self):
        self.accept(support.header(self.leader))
        failed = make_error(grpc.StatusCode.INTERNAL, "failed", reason="MODEL_FAILED")
        self.assertIs(self.reply.end_stream(failed), failed)

    def test_a_whole_reply_outlives_its_connection(self):
        self.accept(*support.good_reply(self.leader))
        self.assertIsNone(self.reply.end_stream(make_error(grpc.StatusCode.UNAVAILABLE, "reset")))


if __name__ == "__main__":
    unittest.main()
