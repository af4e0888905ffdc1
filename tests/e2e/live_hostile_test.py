"""Live sessions of callers that mean no good, against the real server: it stays small, and answers
others."""

import pathlib
import re
import unittest

import live_clients as live
import tools
from live_clients import (Session, frames_message, grpc, label_message, live_pb2, lockstep, person,
                          start_message)

RATE = 30
MEGABYTE = 1_000_000
# What a server may need beyond its memory before.
BOUND = 150 * tools.MEMORY_FACTOR


def megabytes(server):
    status = pathlib.Path(f"/proc/{server.pid}/status").read_text(encoding="utf-8")
    return int(re.search(r"VmHWM:\s+(\d+)", status)[1]) * 1024 / MEGABYTE


class LiveHostileTest(unittest.TestCase):
    def setUp(self):
        self.server = tools.Server("--max-calls", "256")
        self.addCleanup(self.server.stop)
        self.leader = person(live.SBU_JOINTS, RATE, 60)
        self.good()
        self.before = megabytes(self.server)

    def connect(self):
        channel = grpc.insecure_channel(self.server.address,
                                        options=(("grpc.use_local_subchannel_pool", 1),))
        self.addCleanup(channel.close)
        return channel

    def good(self):
        """Another caller has a whole session."""
        session = lockstep(self.connect(), start_message(), self.leader[:20])
        self.assertEqual(session.summary.frame_count, 20)

    def check(self):
        self.good()
        self.assertLess(megabytes(self.server) - self.before, BOUND)
        self.assertTrue(self.server.is_alive())

    def open(self, channel, start=None):
        session = Session(channel, start or start_message())
        self.addCleanup(session.call.cancel)
        self.addCleanup(session.finish)
        return session

    def test_callers_that_never_send(self):
        channels = [self.connect() for _ in range(4)]
        sessions = [self.open(channels[i % 4]) for i in range(100)]
        for session in sessions:
            self.assertTrue(session.read())
            self.assertIsNotNone(session.header)
        self.check()

    def test_callers_that_never_read(self):
        channel = self.connect()
        sessions = [self.open(channel, start_message(plan_frames=30)) for _ in range(8)]
        many = person(live.SBU_JOINTS, RATE, 300)
        for session in sessions:
            for first in range(0, 9000, 300):
                session.send(frames_message(first, many))
        self.check()

    def test_callers_that_end_at_once(self):
        channel = self.connect()
        for _ in range(100):
            session = Session(channel, start_message())
            session.drain()
            self.assertEqual(session.summary.frame_count, 0)
        empty = Session(channel, live_pb2.SynthesizeLiveRequest())
        empty.finish()
        self.assertEqual(empty.error()[0], "INVALID_ARGUMENT")
        self.check()

    def test_many_tiny_messages(self):
        """Late frames, each of which asks for a notice, and label changes without frames."""
        session = self.open(self.connect())
        for frame in range(2):
            session.send(frames_message(frame, self.leader[:1]))
        late, change = frames_message(0, self.leader[:1]), label_message("kick")
        for _ in range(10_000):
            session.send(late)
            session.send(change)
        session.drain()
        self.assertEqual(session.summary.late_frames, 10_000)
        self.check()

    def test_label_changes_of_ever_later_frames(self):
        session = self.open(self.connect())
        for frame in range(5000):
            session.send(label_message("kick", frame=10 + 2 * frame))
        code, text, fields = session.error()
        self.assertEqual((code, fields), ("INVALID_ARGUMENT", ["label_change.frame"]), text)
        self.check()

    def test_impossible_indices_and_times(self):
        channel = self.connect()
        for first in (2**30 - 1, 2**30, 2**31 - 1, 2**31, 2**32 - 1):
            session = Session(channel, start_message())
            session.send(frames_message(first, self.leader[:1]))
            code, text, fields = session.error()
            self.assertEqual((code, fields), ("INVALID_ARGUMENT", ["frames.first_frame"]), text)
            session.finish()
        for seconds in (float("nan"), float("inf"), -1e308):
            session = Session(channel, start_message())
            session.send(frames_message(0, self.leader[:1], seconds))
            session.drain()
            self.assertEqual(repr(session.parts[0].capture_seconds), repr(seconds))
        self.check()

    def test_a_session_at_the_last_frames_that_there_are(self):
        start = start_message(history=live_pb2.LiveHistory(
            first_frame=2**30 - 2, follower_frame_count=1,
            follower_positions=self.leader[0]))
        start.start.leader.frame_count = 1
        start.start.leader.positions.extend(self.leader[0])
        session = Session(self.connect(), start)
        session.send(frames_message(2**30 - 1, [self.leader[1]]))
        session.wait_for(2**30 - 1)
        session.send(frames_message(2**30 - 1, self.leader[1:3]))
        self.assertEqual(session.error()[0], "INVALID_ARGUMENT")
        session.finish()
        self.check()

    def test_a_hundred_sessions_at_once(self):
        channels = [self.connect() for _ in range(4)]
        sessions = [self.open(channels[i % 4]) for i in range(100)]
        for first in range(0, 60, 5):
            for session in sessions:
                session.send(frames_message(first, self.leader[first:first + 5]))
        for session in sessions:
            session.finish()
            code, text, _ = session.error()
            self.assertEqual(code, "OK", text)
            self.assertEqual(session.summary.frame_count, 60)
        self.check()

    def test_first_messages_of_strangers(self):
        """What is no start, starts of many megabytes, and one that grows when it is parsed."""
        tiny = b"\x0a\x80\x80\x80\x01" + b"\x22\x02\x12\x00" * (1 << 19)  # label_keyframes
        for first, code in ((b"", "INVALID_ARGUMENT"), (b"GET / HTTP/1.1", "INVALID_ARGUMENT"),
                            (frames_message(0, self.leader[:1]), "INVALID_ARGUMENT"),
                            (label_message("kick"), "INVALID_ARGUMENT"),
                            (tiny, "INVALID_ARGUMENT"),
                            (bytes(5_000_000), "RESOURCE_EXHAUSTED"),
                            (bytes(20_000_000), "RESOURCE_EXHAUSTED")):
            bytes_of = first if isinstance(first, bytes) else first.SerializeToString()
            call = self.connect().stream_stream("/duet.v1.MotionSynthesis/SynthesizeLive")(
                iter([bytes_of]), timeout=tools.RUN_SECONDS)
            with self.assertRaises(grpc.RpcError) as caught:
                list(call)
            self.assertEqual(caught.exception.code().name, code, caught.exception.details())
        self.check()

    def test_starts_with_much_history(self):
        """Up to ten seconds are read, and of them only what an evaluation needs is kept."""
        channel = self.connect()
        for frames, code in ((300, "OK"), (301, "INVALID_ARGUMENT"), (5000, "INVALID_ARGUMENT"),
                             (60000, "RESOURCE_EXHAUSTED")):
            values = self.leader[0] * frames
            start = start_message(history=live_pb2.LiveHistory(
                follower_frame_count=frames, follower_positions=values))
            start.start.leader.frame_count = frames
            start.start.leader.positions.extend(values)
            session = Session(channel, start)
            session.finish()
            got, text, _ = session.error()
            self.assertEqual(got, code, text)
        self.check()


if __name__ == "__main__":
    tools.main()
