"""Live sessions of the asyncio client against a server that mirrors the leader."""

import asyncio
import unittest

import support
import duet_motion as duet
import duet_motion.aio
import grpc
import numpy as np
from duet_motion.v1 import live_pb2
from support import Failure, Mirror

FRAMES = 12
RESET = Failure(grpc.StatusCode.UNAVAILABLE, "gone")


def run(test, servicer, **options):
    """Runs `test(client)` against a server."""
    async def all_of_it(address):
        async with duet.aio.Client(address, **{"retry": support.QUICK, "wait": 5, **options}) as client:
            return await asyncio.wait_for(test(client), support.LONGEST_CALL)

    with support.serving(servicer) as address:
        return asyncio.run(all_of_it(address))


async def feed(session, leader, together=False):
    if together:
        await session.send(leader.positions)
    else:
        for index, frame in enumerate(leader.positions):
            await session.send(frame, capture_seconds=100 + index)
            await asyncio.sleep(0.002)
    await session.finish()


async def answered(client, leader=None, together=False, **request):
    """The parts and the summary of a session that sends a leader."""
    leader = leader or support.leader(FRAMES)
    session = client.live(leader.joint_names, 30, {"hug": 1}, **request)
    async with session:
        feeding = asyncio.create_task(feed(session, leader, together))
        parts = [part async for part in session]
        await feeding
    return parts, session


class LiveTest(unittest.TestCase):
    def assert_whole(self, parts, frames=FRAMES):
        """Every frame arrives once, in order, and is the mirrored leader's."""
        leader = support.leader(frames)
        self.assertEqual([part.first_frame for part in parts],
                         np.cumsum([0, *(len(part.positions) for part in parts)])[:-1].tolist())
        np.testing.assert_array_equal(np.concatenate([part.positions for part in parts]),
                                      support.follower_of(leader))

    def test_frames_are_answered_with_plan_and_summary(self):
        mirror = Mirror()
        parts, session = run(lambda client: answered(client, plan=2, seed=3, request_id="mine"), mirror)
        self.assert_whole(parts)
        self.assertEqual(parts[4].plan.shape, (2, 3, 3))
        self.assertEqual((parts[4].leader_frame, parts[4].capture_seconds), (4, 104))
        self.assertEqual(parts[4].server_seconds, 0.125)
        self.assertEqual(session.summary, duet.LiveSummary(FRAMES, 0, 0, 0, 0, 3, 0.25, 0.5))
        self.assertEqual((session.header.seed, session.header.candidates), (3, 4))
        self.assertEqual(mirror.metadata[0]["x-request-id"], "mine")
        self.assertEqual(mirror.streams[0][0].start.leader.frame_count, 0)

    def test_delay_holds_frames_back_until_the_end(self):
        parts, _ = run(lambda client: answered(client, delay=3), Mirror())
        self.assert_whole(parts)
        self.assertEqual(parts[0].leader_frame, 3)

    def test_broken_stream_resumes_with_the_history_of_both(self):
        for failure in (RESET, Failure(grpc.StatusCode.INTERNAL, "RST_STREAM"),
                        Failure(grpc.StatusCode.CANCELLED), "end", "drain"):
            for delay in (0, 2):
                with self.subTest(failure=failure, delay=delay):
                    mirror = Mirror({"after": 7, "act": failure})
                    notices = []
                    parts, session = run(lambda client: answered(
                        client, delay=delay, seed=5, on_notice=notices.append), mirror)
                    self.assert_whole(parts)
                    self.assertEqual(session.summary.resume_count, 1)
                    self.assertIn(duet.LiveNotice("resumed"), notices)
                    start = mirror.streams[1][0].start
                    begin = start.history.first_frame
                    self.assertEqual(start.history.follower_frame_count, Mirror.HISTORY)
                    self.assertGreaterEqual(start.leader.frame_count, Mirror.HISTORY + delay)
                    leader = support.leader(FRAMES)
                    np.testing.assert_array_equal(
                        start.leader.positions,
                        leader.positions[begin:begin + start.leader.frame_count].ravel())
                    np.testing.assert_array_equal(
                        start.history.follower_positions,
                        support.follower_of(leader)[begin:begin + Mirror.HISTORY].ravel())
                    self.assertEqual((start.seed, start.model.name, start.model.version), (5, "m", 1))

    def test_frames_without_an_answer_are_in_the_start_of_the_next_stream(self):
        mirror = Mirror({"after": 7, "act": RESET})
        parts, _ = run(lambda client: answered(client, together=True), mirror)
        self.assert_whole(parts)
        start = mirror.streams[1][0].start
        self.assertFalse(mirror.streams[0][0].start.HasField("seed"))
        self.assertTrue(start.HasField("seed"))  # the one that the server chose
        self.assertEqual(start.history.first_frame + start.history.follower_frame_count, 7)
        self.assertEqual(start.leader.frame_count, FRAMES - start.history.first_frame)
        self.assertFalse(mirror.streams[1][1:])

    def test_rotations_keep_their_signs_over_an_interruption(self):
        mirror = Mirror({"after": 9, "act": RESET})
        parts, _ = run(lambda client: answered(client, support.leader(40), rotations=True), mirror)
        self.assert_whole(parts, 40)
        self.assertEqual([joint.name for joint in parts[0].rotations.rig], ["root", "left"])
        self.assertTrue(all(part.rotations.rig == parts[0].rotations.rig for part in parts))
        turned = np.concatenate([part.rotations.rotations for part in parts])[:, 1]
        half = 0.25 * np.arange(40)
        np.testing.assert_allclose(turned[:, 3], np.cos(half), atol=1e-6)
        np.testing.assert_allclose(turned[:, 0], np.sin(half), atol=1e-6)
        history = mirror.streams[1][0].start.history
        self.assertGreater(history.first_frame, 0)
        leader = support.leader(40)
        np.testing.assert_array_equal(history.rig_leader_positions, leader.positions[0].ravel())
        np.testing.assert_array_equal(history.rig_follower_positions,
                                      support.follower_of(leader)[0].ravel())

    def test_stream_that_breaks_repeatedly_loses_nothing(self):
        mirror = Mirror(*({"after": 1, "act": RESET} for _ in range(FRAMES - 2)))
        parts, session = run(lambda client: answered(client, delay=1), mirror)
        self.assert_whole(parts)
        self.assertGreaterEqual(session.summary.resume_count, FRAMES - 3)

    def test_stream_that_breaks_after_the_leaders_end_is_completed(self):
        # The last two frames are final only because the leader has ended.
        class Abrupt(Mirror):
            def SynthesizeLive(self, requests, context):
                is_first = not self.streams
                for response in super().SynthesizeLive(requests, context):
                    if is_first and response.HasField("summary"):
                        return
                    yield response

        mirror = Abrupt()
        parts, session = run(lambda client: answered(client, delay=2), mirror)
        self.assert_whole(parts)
        history = mirror.streams[1][0].start.history
        self.assertEqual(history.first_frame + history.follower_frame_count, FRAMES - 2)

    def test_silent_server_is_given_up(self):
        mirror = Mirror({"after": 5, "act": "hang"})
        parts, session = run(lambda client: answered(client), mirror, wait=3)
        self.assert_whole(parts)
        self.assertGreaterEqual(session.summary.resume_count, 1)

    def test_model_that_is_gone_ends_the_session(self):
        mirror = Mirror({"after": 3, "act": RESET},
                        {"after": 0, "act": Failure(grpc.StatusCode.NOT_FOUND, "none")})
        with self.assertRaisesRegex(duet.DuetError, "cannot be resumed: m@1 is no longer served"):
            run(answered, mirror)

    def test_malformed_responses_are_rejected(self):
        def frames(**changes):
            values = {"first_frame": 0, "frame_count": 1, "positions": [0.0] * 9}
            return {"after": 0, "act": live_pb2.SynthesizeLiveResponse(
                frames=live_pb2.FollowerFrames(**{**values, **changes}))}

        for words, script in (
                ("joint_names", {"header": {"joint_names": ["x"]}}),
                ("frame_rate_hz", {"header": {"frame_rate_hz": 60}}),
                ("unit", {"header": {"unit": 2}}),
                ("first_frame", {"header": {"first_frame": 1}}),
                ("without a payload", {"extra": [live_pb2.SynthesizeLiveResponse()]}),
                ("second header", {"extra": [support.live_header(live_pb2.LiveStart(), 0)]}),
                ("first_frame: expected 0, got 2", frames(first_frame=2)),
                ("frame_count: expected 1", frames(frame_count=0)),
                ("expected 1 to", frames(frame_count=99)),
                ("leader_frame: ", frames(leader_frame=99)),
                ("finite", frames(positions=[float("nan")] * 9)),
                ("expected 3 joints", frames(positions=[0.0] * 8)),
                ("expected 1 frames", frames(positions=[0.0] * 18)),
                ("plan_positions: ", frames(plan_positions=[0.0] * 8)),
                ("summary.frame_count", {"after": 0, "act": live_pb2.SynthesizeLiveResponse(
                    summary=live_pb2.LiveSummary(frame_count=7))})):
            with self.subTest(words), self.assertRaisesRegex(duet.MalformedReplyError, words):
                run(answered, Mirror(script))

    def test_notices_are_passed_on_and_counted(self):
        notices = []
        mirror = Mirror({"extra": [support.live_notice(kind, 2, 3) for kind in (1, 2, 3, 99)]})
        _, session = run(lambda client: answered(client, on_notice=notices.append), mirror)
        run_of = duet.FrameRun(2, 3)
        self.assertEqual(notices, [duet.LiveNotice("gap_filled", run_of),
                                   duet.LiveNotice("late", run_of),
                                   duet.LiveNotice("skipped", run_of)])
        summary = session.summary
        self.assertEqual((summary.gap_frames, summary.late_frames, summary.skipped_frames), (3, 3, 3))

    def test_labels_change_at_the_next_frame_and_survive_an_interruption(self):
        async def change(client):
            leader = support.leader(FRAMES)
            async with client.live(leader.joint_names, 30, {"hug": 1}, delay=1) as session:
                for frame in leader.positions[:6]:
                    await session.send(frame)
                while (await session.__anext__()).first_frame < 4:
                    pass
                self.assertEqual(await session.change_labels({"push": 1}, ease_seconds=0.2), 5)
                for frame in leader.positions[6:]:
                    await session.send(frame)
                await session.finish()
                async for _ in session:
                    pass

        mirror = Mirror({"after": 7, "act": RESET})
        run(change, mirror)
        [message] = [message.label_change for message in mirror.streams[0]
                     if message.HasField("label_change")]
        self.assertEqual((message.frame, message.ease_frames), (5, 6))
        keys = {key.frame: {one.interaction_class: one.weight for one in key.label_vector.weights}
                for key in mirror.streams[1][0].start.label_keyframes}
        self.assertEqual(keys, {0: {"hug": 1}, 5: {"hug": 1}, 11: {"push": 1}})

    def test_send_waits_for_a_reader(self):
        async def never_taken(client):
            async with client.live(support.JOINTS, 30, {"hug": 1}) as session:
                frame = support.leader(1).positions[0]
                with self.assertRaises(asyncio.TimeoutError):
                    for _ in range(10000):
                        await asyncio.wait_for(session.send(frame), 1)
                self.assertEqual(session.frames_sent, 300)
                await session.__anext__()
                await asyncio.wait_for(session.send(frame), support.LONGEST_CALL)

        run(never_taken, Mirror())

    def test_leaving_ends_the_stream(self):
        async def leave(client):
            async with client.live(support.JOINTS, 30, {"hug": 1}) as session:
                await session.send(support.leader(1).positions)
                await session.__anext__()
            with self.assertRaises(duet.CancelledError):
                await session.send(support.leader(1).positions)
            self.assertEqual([part async for part in session], [])

        run(leave, Mirror())

    def test_invalid_arguments_name_the_field(self):
        async def wrong(client):
            for field, arguments in (("delay", {"delay": 11}), ("plan", {"plan": 31}),
                                     ("seed", {"seed": -1}), ("labels", {"labels": {"hug": "x"}}),
                                     ("rotations", {"rotations": 1}),
                                     ("joint_names", {"joint_names": "abc"}),
                                     ("frame_rate_hz", {"frame_rate_hz": 0})):
                with self.subTest(field), self.assertRaisesRegex(ValueError, f"^{field}"):
                    client.live(**{"joint_names": support.JOINTS, "frame_rate_hz": 30, **arguments})
            session = client.live(support.JOINTS, 30, {"hug": 1})
            with self.assertRaisesRegex(RuntimeError, "async with"):
                await session.send(np.zeros((3, 3)))
            async with session:
                for frames in (np.zeros((2, 3)), np.full((3, 3), np.nan), np.zeros((1, 1, 3, 3))):
                    with self.assertRaisesRegex(ValueError, "^positions"):
                        await session.send(frames)
                with self.assertRaisesRegex(ValueError, "^capture_seconds"):
                    await session.send(np.zeros((3, 3)), capture_seconds=float("nan"))
                with self.assertRaisesRegex(ValueError, "^ease_seconds"):
                    await session.change_labels({"hug": 1}, ease_seconds=11)
                with self.assertRaisesRegex(ValueError, "^labels"):
                    await session.change_labels({})

        run(wrong, Mirror())


if __name__ == "__main__":
    unittest.main()
