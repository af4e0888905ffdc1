"""Live sessions of callers that mean no good, against the real server: it stays small, and answers
others."""

import unittest

import tools
from live_clients import Session, frames_message, grpc, label_message, lockstep, person, start_message

RATE = 30
# What a server may need beyond its memory before.
BOUND = 150_000_000 * tools.MEMORY_FACTOR


class LiveHostileTest(unittest.TestCase):
    def setUp(self):
        self.server = tools.Server("--max-calls", "256")
        self.addCleanup(self.server.stop)
        self.leader = person(tools.JOINTS, RATE, 60)
        self.good()
        self.before = tools.peak_memory(self.server)

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
        self.assertLess(tools.peak_memory(self.server) - self.before, BOUND)
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
        many = person(tools.JOINTS, RATE, 300)
        for session in sessions:
            for first in range(0, 9000, 300):
                session.send(frames_message(first, many))
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


if __name__ == "__main__":
    tools.main()
