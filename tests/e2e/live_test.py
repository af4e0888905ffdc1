"""Live sessions of a foreign client on the real server: what a frame depends on, resuming, sessions
that share batches, the end of a server, and refusals."""

import math
import re
import threading
import time
import unittest

import http2_client as http2
import live_clients as live
import tools
from live_clients import (Session, frames_message, grpc, label_message, live_pb2, lockstep,
                          motion_pb2, person, start_message, synthesis_pb2, synthesis_pb2_grpc)

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
    page = server.page("/metrics")[1]
    return [int(re.search(rf"^duet_batch_size_{name} (\d+)", page, re.MULTILINE)[1])
            for name in ("count", "sum")]


def frames_of(values, width):
    return [values[i:i + width] for i in range(0, len(values), width)]


def rotations_from(session, first):
    """The rotations of every frame from `first` on; none without reply_rotations."""
    return [value for part in session.parts if part.frame_count and part.first_frame >= first
            for value in part.rotations]


def rotate(q, v):
    """A vector by a quaternion x, y, z, w."""
    x, y, z, w = q
    c = [y * v[2] - z * v[1] + w * v[0], z * v[0] - x * v[2] + w * v[1],
         x * v[1] - y * v[0] + w * v[2]]
    return [v[0] + 2 * (y * c[2] - z * c[1]), v[1] + 2 * (z * c[0] - x * c[2]),
            v[2] + 2 * (x * c[1] - y * c[0])]


def multiply(p, q):
    """First q, then p."""
    return [*(p[3] * a + q[3] * b + c for a, b, c in zip(q[:3], p[:3], (
        p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]))),
        p[3] * q[3] - sum(a * b for a, b in zip(p[:3], q[:3]))]


def forward(rig, rotations, positions):
    """Where forward kinematics (docs/rotations.md) puts the joints of a rig in one frame."""
    at, world = [], []
    for joint, q in zip(rig, frames_of(rotations, 4)):
        if joint.parent < 0:
            at.append(positions[3 * joint.joint:3 * joint.joint + 3])
            world.append(q)
            continue
        offset = (joint.offset.x, joint.offset.y, joint.offset.z)
        turned = rotate(world[joint.parent], offset)
        at.append([a + b for a, b in zip(at[joint.parent], turned)])
        world.append(multiply(world[joint.parent], q))
    return at


class LiveTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        # With one worker, windows of sessions at the same time wait for one another, and share batches.
        cls.server = tools.Server("--workers", "1", metrics="127.0.0.1:0")
        cls.addClassCleanup(cls.server.stop)
        cls.leader = person(live.SBU_JOINTS, RATE, FRAMES)

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
        self.assertEqual(list(session.header.joint_names), live.SBU_JOINTS)
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
        for delay in (0, 3):
            with self.subTest(delay=delay):
                start = start_message(delay_frames=delay)
                one = self.lockstep(start)
                same = 80  # leader frames
                moved = [[value + 0.3 for value in pose] for pose in self.leader[same:]]
                other = self.lockstep(start, self.leader[:same] + moved)
                for frame in range(same - delay):
                    self.assertEqual(one.frames[frame], other.frames[frame], frame)
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

    def test_rotations_give_the_positions(self):
        session = self.lockstep(start_message(reply_rotations=True))
        rig = session.parts[0].rig
        self.assertGreater(len(rig), len(live.SBU_JOINTS))
        self.assertEqual([part.first_frame for part in session.parts if part.rig], [0])
        worst = 0
        for part in session.parts:
            for frame, rotations in enumerate(frames_of(part.rotations, 4 * len(rig))):
                positions = session.frames[part.first_frame + frame]
                for joint, at in zip(rig, forward(rig, rotations, positions)):
                    place = positions[3 * joint.joint:3 * joint.joint + 3]
                    worst = max(worst, math.dist(place, at))
        self.assertLess(worst, 1e-4)

    def test_a_resumed_session_goes_on_with_the_same_rotations(self):
        for delay in (0, 3):
            with self.subTest(delay=delay):
                self.check_resumes(start_message(delay_frames=delay, reply_rotations=True),
                                   self.leader, ((1, 0), (37, 0), (64, 4), (120, 0)))

    def test_a_resumed_session_needs_the_first_frames_for_its_rig(self):
        start = start_message(reply_rotations=True)
        whole = self.lockstep(start)
        begin, at = 40, 100
        start.start.leader.frame_count = at - begin
        start.start.leader.positions.extend(
            value for pose in self.leader[begin:at] for value in pose)
        start.start.history.first_frame = begin
        start.start.history.follower_frame_count = at - begin
        start.start.history.follower_positions.extend(
            value for frame in range(begin, at) for value in whole.frames[frame])
        code, _, fields = Session(self.channel, start).error()
        self.assertEqual(code, "INVALID_ARGUMENT")
        self.assertEqual(fields, ["start.history.rig_leader_positions",
                                  "start.history.rig_follower_positions"])

    def test_a_session_resumed_with_another_seed_goes_on_with_other_frames(self):
        start = start_message()
        whole = self.lockstep(start)
        start.start.seed += 1
        rest = self.resume(whole, start, self.leader, 64)
        self.assertNotEqual(rest.frames[100], whole.frames[100])

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

    def test_frames_do_not_depend_on_the_size_of_messages(self):
        """In units in which a position is rounded on its way to the caller."""
        leader = [[1000 * value for value in pose] for pose in person(live.SBU_JOINTS, 90, 2 * FRAMES)]
        start = start_message(rate=90, label="kick")
        start.start.leader.unit = motion_pb2.LENGTH_UNIT_MILLIMETRES
        one = self.lockstep(start, leader)
        other = Session(self.channel, start)
        for first in range(0, len(leader), 5):
            other.send(frames_message(first, leader[first:first + 5]))
            other.wait_for(first + 4)
        other.drain()
        self.assertEqual(other.summary.skipped_frames, 0)
        different = [frame for frame in one.frames if one.frames[frame] != other.frames[frame]]
        self.assertEqual(different, [])

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

    def test_sends_a_label_change_that_counts_from_its_frame(self):
        plain = self.lockstep()
        at = 60
        changed = self.lockstep(labels={at: label_message("kick")})
        self.assertTrue(all(plain.frames[frame] == changed.frames[frame] for frame in range(at)))
        self.assertNotEqual(plain.frames[at + 15], changed.frames[at + 15])
        # The same change, announced long before and eased, and a change of a later frame.
        announced = self.lockstep(labels={3: label_message("kick", frame=at)})
        self.assertTrue(all(plain.frames[frame] == announced.frames[frame]
                            for frame in range(at - 31)), "within a window before it")
        self.assertNotEqual(plain.frames[at + 15], announced.frames[at + 15])

    def test_gaps_are_filled_and_late_frames_dropped(self):
        session = Session(self.channel, start_message())
        session.send(frames_message(0, self.leader[:10]))
        session.send(frames_message(13, self.leader[13:20]))
        session.send(frames_message(5, self.leader[5:8]))
        session.drain()
        self.assertEqual(sorted(session.frames), list(range(20)))
        found = [(notice.kind, notice.frames.first_frame, notice.frames.frame_count)
                 for notice in session.notices if notice.kind != SKIPPED]
        self.assertEqual(found, [(live_pb2.LIVE_NOTICE_KIND_GAP_FILLED, 10, 3),
                                 (live_pb2.LIVE_NOTICE_KIND_LATE, 5, 3)])
        self.assertEqual((session.summary.gap_frames, session.summary.late_frames), (3, 3))

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

    def test_a_session_without_leader_frames_is_empty(self):
        session = Session(self.channel, start_message())
        session.drain()
        self.assertEqual(session.summary.frame_count, 0)

    # Refusals.

    def refused(self, *messages, code="INVALID_ARGUMENT"):
        session = Session(self.channel, messages[0])
        for message in messages[1:]:
            session.send(message)
        got, text, fields = session.error()
        session.finish()
        self.assertEqual(got, code, text)
        return text, fields

    def test_first_message_that_is_no_start(self):
        for first, got in ((frames_message(0, self.leader[:1]), "frames"),
                           (label_message("kick"), "label_change"),
                           (live_pb2.SynthesizeLiveRequest(), "none")):
            text, fields = self.refused(first)
            self.assertEqual(fields, ["payload"])
            self.assertIn(f"expected start in the first message, got {got}", text)

    def test_invalid_start(self):
        for changes, field in (({"delay_frames": 11}, "start.delay_frames"),
                               ({"plan_frames": 31}, "start.plan_frames"),
                               ({"candidates": 17}, "start.candidates"),
                               ({"rate": -1}, "start.leader.frame_rate_hz"),
                               ({"label": ""}, "start.label_vector"),
                               ({"history": live_pb2.LiveHistory(follower_frame_count=1)},
                                "start.leader.frame_count")):
            with self.subTest(field=field):
                self.assertEqual(self.refused(start_message(**changes))[1], [field])

    def test_model_that_does_not_answer_live(self):
        start = start_message(model={"name": "k3hi"}, label="kick")
        _, fields = self.refused(start, code="FAILED_PRECONDITION")
        self.assertEqual(fields, ["start.model"])
        self.refused(start_message(model={"name": "nobody"}), code="NOT_FOUND")

    def test_invalid_later_messages(self):
        good = frames_message(0, self.leader[:1])
        short = frames_message(1, self.leader[1:3])
        short.frames.positions.pop()
        broken = frames_message(1, self.leader[1:2])
        broken.frames.positions[4] = float("nan")
        for later, field in ((short, "frames.positions"),
                             (broken, "frames.positions[4]"),
                             (frames_message(1, []), "frames.frame_count"),
                             (frames_message(1000, self.leader[:1]), "frames.first_frame"),
                             (frames_message(2**32 - 1, self.leader[:1]), "frames.first_frame"),
                             (label_message("kick", ease_frames=10**6),
                              "label_change.ease_frames"),
                             (label_message("kick", frame=0), "label_change.frame"),
                             (label_message("tango"),
                              "label_change.label_vector.weights[0].interaction_class"),
                             (start_message(), "payload"),
                             (live_pb2.SynthesizeLiveRequest(), "payload")):
            with self.subTest(field=field):
                self.assertEqual(self.refused(start_message(), good, later)[1], [field])

    def test_frames_before_an_invalid_message_are_answered(self):
        session = Session(self.channel, start_message())
        session.send(frames_message(0, self.leader[:1]))
        session.wait_for(0)
        session.send(frames_message(1, []))
        self.assertEqual(session.error()[0], "INVALID_ARGUMENT")
        self.assertEqual(sorted(session.frames), [0])
        session.finish()

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
        leader = person(live.SBU_JOINTS, RATE, FRAMES)
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
