"""Live sessions of a foreign client on the real server: what a frame depends on, resuming, sessions
that share batches, and the end of a server. live_fuzz_test.py plays what is refused."""

import threading
import time
import unittest

import http2_client as http2
import tools
from live_clients import (Session, frames_message, grpc, live_pb2, lockstep, motion_pb2, person, start_message,
                          synthesis_pb2, synthesis_pb2_grpc)

FRAMES = 150
RATE = 30
SKIPPED = live_pb2.LIVE_NOTICE_KIND_SKIPPED


def connect(test, server):
    channel = grpc.insecure_channel(server.address,
                                    options=(("grpc.use_local_subchannel_pool", 1),))
    test.addCleanup(channel.close)
    return channel


def batches(server):
    """Number of batches, and of the windows in them."""
    return [server.figure(f"duet_batch_size_{name}") for name in ("count", "sum")]


def rotations_from(session, first):
    """The rotations of every frame from `first` on; none without reply_rotations."""
    return [value for part in session.parts if part.frame_count and part.first_frame >= first
            for value in part.rotations]


class LiveTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        # With one worker, windows of sessions at the same time wait for one another, and share batches.
        cls.server = tools.Server("--workers", "1", metrics="127.0.0.1:0")
        cls.addClassCleanup(cls.server.stop)
        cls.leader = person(tools.JOINTS, RATE, FRAMES)

    def setUp(self):
        self.channel = connect(self, self.server)

    def lockstep(self, start=None, leader=None, **options):
        """A session of which no evaluation was skipped."""
        session = lockstep(self.channel, start or start_message(), leader or self.leader, **options)
        self.assertEqual(session.summary.skipped_frames, 0)
        self.assertEqual(session.summary.frame_count, len(session.frames))
        return session

    def test_each_frame_is_answered_before_the_next_is_sent(self):
        session = self.lockstep(start_message(plan_frames=5))
        self.assertEqual(session.header.model_name, "sbu")
        self.assertEqual(list(session.header.joint_names), tools.JOINTS)
        self.assertEqual(session.header.first_frame, 0)
        self.assertEqual(sorted(session.frames), list(range(FRAMES)))
        self.assertEqual([part.leader_frame for part in session.parts], list(range(FRAMES)))
        self.assertEqual([part.capture_seconds for part in session.parts], list(range(FRAMES)))
        self.assertTrue(all(len(part.plan_positions) == 5 * 45 for part in session.parts))
        self.assertGreater(session.summary.window_count, FRAMES / 10)
        self.assertEqual(list(session.notices), [])

    def test_the_same_session_has_the_same_frames(self):
        one, other = self.lockstep(), self.lockstep()
        self.assertEqual(one.frames, other.frames)
        self.assertNotEqual(one.frames, self.lockstep(start_message(seed=8)).frames)

    def test_no_frame_depends_on_what_the_leader_does_later(self):
        start, same = start_message(delay_frames=3), 80  # leader frames
        one = self.lockstep(start)
        other = self.lockstep(start, self.leader[:same] + [[value + 0.3 for value in pose] for pose in self.leader[same:]])
        self.assertEqual([one.frames[frame] for frame in range(same - 3)],
                         [other.frames[frame] for frame in range(same - 3)])
        self.assertNotEqual(one.frames[same + 5], other.frames[same + 5])

    def resume(self, whole, start, leader, at, unanswered=0):
        """The rest of a session of which `at` frames were received."""
        begin = max(0, at - whole.header.history_frames)
        resumed = live_pb2.SynthesizeLiveRequest()
        resumed.CopyFrom(start)
        delay = start.start.delay_frames
        known = leader[begin:at + delay + unanswered]
        motion = resumed.start.leader
        motion.frame_count = len(known)
        motion.positions.extend(value for pose in known for value in pose)
        resumed.start.ClearField("follower_start")
        history = resumed.start.history
        history.first_frame = begin
        history.follower_frame_count = at - begin
        history.follower_positions.extend(
            value for frame in range(begin, at) for value in whole.frames[frame])
        if start.start.reply_rotations:
            history.rig_leader_positions.extend(leader[0])
            history.rig_follower_positions.extend(whole.frames[0])
        rest = lockstep(self.channel, resumed, leader[begin + len(known):],
                        first=begin + len(known))
        self.assertEqual(rest.header.first_frame, at)
        return rest

    def check_resumes(self, start, leader, frames):
        whole = self.lockstep(start, leader)
        for at, unanswered in frames:
            with self.subTest(at=at, unanswered=unanswered):
                rest = self.resume(whole, start, leader, at, unanswered)
                self.assertEqual(sorted(rest.frames), list(range(at, len(leader))))
                different = [frame for frame in rest.frames
                             if rest.frames[frame] != whole.frames[frame]]
                self.assertEqual(different, [])
                self.assertEqual(list(rest.parts[0].rig), list(whole.parts[0].rig))
                self.assertEqual(rotations_from(rest, at), rotations_from(whole, at))

    def test_a_resumed_session_goes_on_with_the_same_frames(self):
        for delay in (0, 3):
            with self.subTest(delay=delay):
                self.check_resumes(start_message(delay_frames=delay), self.leader,
                                   ((1, 0), (37, 0), (64, 4), (120, 0)))

    def test_resumes_in_other_units_axes_and_models(self):
        """Salsa at 60 Hz in millimetres, z up, in a room that is not level."""
        stub = synthesis_pb2_grpc.MotionSynthesisStub(self.channel)
        selector = {"model": {"name": "salsa"}}
        model = stub.GetModel(synthesis_pb2.GetModelRequest(**selector),
                              timeout=tools.RUN_SECONDS).model
        self.assertTrue(model.answers_live)
        joints = list(model.joint_names)
        leader = []
        for pose in person(joints, 60, 240):
            points = zip(pose[0::3], pose[1::3], pose[2::3])
            leader.append([1000 * value for x, y, z in points
                           for value in (x, 0.05 * y - z, y + 0.05 * z)])
        start = start_message(joints, 60, "basic", up={"x": 0, "y": 0.05, "z": 1}, **selector)
        start.start.leader.unit = motion_pb2.LENGTH_UNIT_MILLIMETRES
        start.start.leader.up_axis = motion_pb2.UP_AXIS_Z_UP
        self.check_resumes(start, leader, ((7, 0), (101, 3), (200, 0)))
        start.start.reply_rotations = True
        self.check_resumes(start, leader, ((7, 0), (200, 0)))

    def test_sessions_at_the_same_time_have_the_frames_of_one_alone(self):
        seeds = range(8)
        alone = [self.lockstep(start_message(seed=seed)).frames for seed in seeds]
        channels = [connect(self, self.server) for _ in seeds]
        before = batches(self.server)
        sessions = tools.together(
            [lambda seed=seed: lockstep(channels[seed], start_message(seed=seed), self.leader)
             for seed in seeds])
        count, windows = (now - then for now, then in zip(batches(self.server), before))
        self.assertGreater(windows, 1.2 * count, "they shared batches")
        for seed, session in enumerate(sessions):
            self.assertEqual(sorted(session.frames), list(range(FRAMES)))
            different = [frame for frame in session.frames
                         if session.frames[frame] != alone[seed][frame]]
            self.assertEqual(different, [], f"seed {seed}")

    def test_a_paced_leader_may_come_at_once(self):
        """All frames in one burst: every frame is answered, from older plans where need be."""
        session = Session(self.channel, start_message())
        for first in range(0, FRAMES, 5):
            session.send(frames_message(first, self.leader[first:first + 5]))
        session.drain()
        self.assertEqual(sorted(session.frames), list(range(FRAMES)))
        skipped = sum(notice.frames.frame_count for notice in session.notices
                      if notice.kind == SKIPPED)
        self.assertEqual(session.summary.skipped_frames, skipped)

    def test_the_log_and_the_metrics_tell_of_a_session(self):
        session = Session(self.channel, start_message(), metadata=(("x-request-id", "mine"),))
        session.send(frames_message(0, self.leader[:20]))
        session.wait_for(0)
        self.assertRegex(self.server.page("/metrics")[1], "duet_places_in_use [1-9]")
        session.drain()
        self.assertEqual(session.header.request_id, "mine")

        def logged():
            return [entry for entry in self.server.events("call")
                    if entry.get("request_id") == "mine"]
        tools.wait_until(logged, "the call is logged")
        entry = logged()[0]
        self.assertEqual((entry["method"], entry["code"], entry["model"], entry["frames"]),
                         ("SynthesizeLive", "OK", "sbu", 20))
        self.assertEqual(entry["windows"], session.summary.window_count)
        page = self.server.page("/metrics")[1]
        self.assertRegex(page, r'grpc_server_handled_total\{grpc_code="OK",'
                               r'grpc_method="SynthesizeLive".*\} [1-9]')
        self.assertIn('duet_calls_in_flight{method="SynthesizeLive"} 0\n', page)


class StoppingTest(unittest.TestCase):
    def test_a_server_that_drains_says_so(self):
        """To one session that sends on, to one at rest and to one that has not sent a frame."""
        leader = person(tools.JOINTS, RATE, FRAMES)
        server = tools.Server("--grace-seconds", "10")
        self.addCleanup(server.stop)
        channel = connect(self, server)
        busy, quiet, unsent = (Session(channel, start_message()) for _ in range(3))
        for session in (busy, quiet):
            session.send(frames_message(0, leader[:1]))
            session.wait_for(0)
        self.assertTrue(unsent.read())
        stopping = threading.Thread(target=server.stop)
        stopping.start()
        self.addCleanup(stopping.join)
        tools.wait_until(lambda: server.events("draining"), "it drains")
        frame = 1
        while not busy.notices and frame < FRAMES:
            busy.send(frames_message(frame, [leader[frame]]))
            busy.wait_for(frame)
            frame += 1
            time.sleep(0.02)
        self.assertEqual([notice.kind for notice in busy.notices],
                         [live_pb2.LIVE_NOTICE_KIND_DRAINING])
        self.assertFalse(busy.notices[0].HasField("frames"))
        busy.drain()
        self.assertEqual(busy.summary.frame_count, frame)
        for session in (quiet, unsent):
            code, text, _ = session.error()
            self.assertEqual(code, "UNAVAILABLE", text)
            self.assertEqual([notice.kind for notice in session.notices],
                             [live_pb2.LIVE_NOTICE_KIND_DRAINING])
            session.finish()


class IdleTest(unittest.TestCase):
    def test_a_session_without_messages_ends(self):
        with tools.running_server("--live-idle-seconds", "1") as server:
            session = Session(connect(self, server), start_message())
            code, text, _ = session.error()
            session.finish()
            self.assertEqual(code, "DEADLINE_EXCEEDED", text)

    def test_frequent_pings_do_not_end_a_silent_session(self):
        """The pauses are what is tested. gRPC forgives two pings that come too early, and those right
        after a message."""
        with tools.running_server() as server:
            connection = http2.Connection(server.port)
            self.addCleanup(connection.close)
            connection.open("/duet.v1.MotionSynthesis/SynthesizeLive", end=False,
                            payload=start_message().SerializeToString())
            frames = connection.frames()
            self.assertTrue(any(kind == http2.DATA for kind, *_ in frames), "the header")
            for number, pause in enumerate((0, 0, 6, 6, 6, 0)):
                time.sleep(pause)
                ping = number.to_bytes(8, "big")
                connection.socket.sendall(http2.frame(http2.PING, 0, 0, ping))
                answered = False
                while not answered:
                    kind, flags, _, payload = next(frames, (http2.GOAWAY, 0, 0, b"closed"))
                    self.assertNotEqual(kind, http2.GOAWAY, f"ping {number}: {payload}")
                    answered = kind == http2.PING and flags & http2.ACK and payload == ping


if __name__ == "__main__":
    tools.main()
