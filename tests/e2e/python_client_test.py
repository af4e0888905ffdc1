"""The Python package and its examples against a real server."""

import asyncio
import dataclasses
import os
import sys
import threading

import tools

try:
    import grpc  # noqa: F401
    import numpy as np
except ImportError as error:
    tools.skip(f"{error}; install the packages python3-grpcio and python3-numpy")

PACKAGE = tools.SOURCE / "client" / "python"
os.environ["DUET_PROGRAM"] = str(tools.PROGRAMS / "duet")
sys.path.insert(0, str(PACKAGE))

import duet_motion as duet  # noqa: E402
import duet_motion.aio  # noqa: E402


REACHED = 0.01  # metres
FASTEST = 4.5   # metres per second that a pin may add to a joint


def speed(motion, joint):
    """The largest speed of a joint, in units per second."""
    steps = np.linalg.norm(np.diff(motion.joint(joint), axis=0), axis=-1)
    return steps.max() * motion.frame_rate_hz


def there(follower, joint, frame, way):
    """A pin at the joint's place in this answer, moved by `way` in the body's directions: to its
    left, up, and forwards."""
    left = follower.joint("left_hip")[frame] - follower.joint("right_hip")[frame]
    left[1] = 0
    left /= np.linalg.norm(left)
    forwards = np.cross(left, [0, 1, 0])
    axes = np.stack([left, [0, 1, 0], forwards])
    return duet.Constraint(joint, frame, follower.joint(joint)[frame] + np.float32(way) @ axes)


def one_window(name):
    """The sample, cut to a window of the model. Longer answers differ with pins, whose windows settle more."""
    whole = duet.read_motion(tools.sample(name))
    return duet.Motion(whole.positions[:88], whole.joint_names, frame_rate_hz=whole.frame_rate_hz)


class PythonClientTest(tools.ServedTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.client = duet.Client(cls.server.address)
        cls.addClassCleanup(cls.client.close)
        cls.hug = duet.read_motion(tools.sample("hug"))

    def test_synthesize_takes_and_returns_arrays(self):
        result = self.client.synthesize(self.hug, labels={"hug": 1}, seed=3)
        self.assertEqual(result.follower.positions.shape, (91, 15, 3))
        self.assertEqual(result.follower.joint_names, self.hug.joint_names)
        self.assertEqual((result.model_name, result.seed), ("sbu", 3))
        height = result.follower.joint("head")[:, 1] - result.follower.joint("left_foot")[:, 1]
        self.assertGreater(height.mean(), 1)
        self.assertGreater(result.unfamiliarity, 0)

    def test_rotations_are_in_the_leaders_unit_and_axes(self):
        def turned(q, v):
            return v + 2 * np.cross(q[:3], np.cross(q[:3], v) + q[3] * v)

        def product(p, q):
            return np.append(p[3] * q[:3] + q[3] * p[:3] + np.cross(p[:3], q[:3]),
                             p[3] * q[3] - p[:3] @ q[:3])
        for unit, up_axis, scale in (("metres", "y-up", 1), ("millimetres", "z-up", 1000),
                                     ("metres", "y-down", 1)):
            leader = self.hug.converted(unit, up_axis)
            result = self.client.synthesize(leader, {"hug": 1}, rotations=True)
            rig, rotations = result.rotations.rig, result.rotations.rotations
            self.assertEqual(rotations.shape, (91, len(rig), 4))
            for frame in (0, 40, 90):
                at, world = [], []
                for joint, q in zip(rig, rotations[frame]):
                    place = result.follower.positions[frame, joint.joint]
                    at.append(place if joint.parent < 0 else at[joint.parent] +
                              turned(world[joint.parent], np.array(joint.offset)))
                    world.append(q if joint.parent < 0 else product(world[joint.parent], q))
                    with self.subTest(unit=unit, up_axis=up_axis, joint=joint.name, frame=frame):
                        np.testing.assert_allclose(at[-1], place, atol=1e-4 * scale)
        plain = self.client.synthesize(self.hug, {"hug": 1})
        self.assertIsNone(plain.rotations)
        unequal = dataclasses.replace(self.hug, unit="sbu-normalised", up_axis="y-down")
        with self.assertRaisesRegex(duet.InvalidRequestError, "reply_rotations: expected LENGTH_"):
            self.client.synthesize(unequal, {"hug": 1}, rotations=True)

    def test_error_lists_every_violation(self):
        with self.assertRaises(duet.InvalidRequestError) as caught:
            self.client.synthesize(dataclasses.replace(self.hug, frame_rate_hz=500),
                                   {"hug": 1, "dance": 1}, variety=3)
        error = caught.exception
        self.assertEqual(error.reason, "INVALID_REQUEST")
        fields = {violation.field for violation in error.violations}
        self.assertLessEqual({"leader.frame_rate_hz", "variety"}, fields)
        self.assertIn("dance", str(error))
        with self.assertRaises(duet.ModelNotFoundError):
            self.client.synthesize(self.hug, {"hug": 1}, model="nobody")
        with self.assertRaises(duet.RequestMismatchError):
            self.client.synthesize(self.hug.select(["head", "neck"]), {"hug": 1})

    def test_call_survives_a_server_restart(self):
        server = tools.Server()
        patient = duet.RetryOptions(max_attempts=10_000, initial_backoff=0.05, max_backoff=0.1)
        with duet.Client(server.address, retry=patient, timeout=tools.RUN_SECONDS,
                         wait=tools.RUN_SECONDS) as client:
            before = client.synthesize(self.hug, {"hug": 1}, seed=3)
            server.kill()
            answers = []
            caller = threading.Thread(target=lambda: answers.append(
                client.synthesize(self.hug, {"hug": 1}, seed=3)))
            caller.start()
            server = tools.Server(port=server.port)
            self.addCleanup(server.stop)
            caller.join(tools.RUN_SECONDS)
        np.testing.assert_array_equal(answers[0].follower.positions, before.follower.positions)

    def pinned(self, leader=None, labels=None, **fields):
        return self.client.synthesize(leader or one_window("hug"), labels=labels or {"hug": 1}, **{"seed": 0, **fields})

    def check_pins(self, result, pins):
        for pin, metres in zip(pins, result.constraint_metres, strict=True):
            distance = np.linalg.norm(result.follower.joint(pin.joint)[pin.frame] - pin.position)
            self.assertLess(distance, REACHED, f"{pin.joint} in frame {pin.frame}")
            self.assertAlmostEqual(distance, metres, delta=1e-4)

    def test_a_pinned_hand_is_there_and_nothing_jumps(self):
        for name in ("kick", "hug", "push"):
            leader = one_window("kick" if name == "kick" else "hug")
            free = self.pinned(leader, {name: 1})
            pin = there(free.follower, "right_hand", 40, (0, 0.25, 0.05))
            pinned = self.pinned(leader, {name: 1}, constraints=[pin])
            self.check_pins(pinned, [pin])
            self.assertLess(speed(pinned.follower, "right_hand"),
                            speed(free.follower, "right_hand") + FASTEST)
            self.assertLessEqual(pinned.grade.skating, free.grade.skating + 0.1)
            self.assertLessEqual(pinned.grade.overlapping, free.grade.overlapping + 0.05)

    def test_every_window_of_a_long_clip_has_its_pins(self):
        salsa = duet.read_motion(tools.sample("salsa"))
        free = self.pinned(salsa)
        self.assertGreater(free.window_count, 5)
        pins = [there(free.follower, "right_hand", frame, (0, 0.1, 0.05))
                for frame in range(11, salsa.frame_count, salsa.frame_count // 12)]
        for count in (1, 3):
            pinned = self.pinned(salsa, constraints=pins, candidates=count)
            self.assertLess(np.median(pinned.constraint_metres), REACHED)
            self.assertLess(max(pinned.constraint_metres), 0.2)
            self.assertLess(speed(pinned.follower, "right_hand"),
                            speed(free.follower, "right_hand") + FASTEST)

    def test_a_pin_out_of_reach_is_reported_and_an_unknown_joint_refused(self):
        free = self.pinned()
        pin = there(free.follower, "right_hand", 40, (0, 3, 0))
        far = self.pinned(constraints=[pin])
        self.assertGreater(far.constraint_metres[0], 1)
        hand, shoulder = (far.follower.joint(name)[40] for name in ("right_hand", "right_shoulder"))
        self.assertGreater(hand[1], shoulder[1])
        with self.assertRaises(duet.RequestMismatchError) as raised:
            self.pinned(constraints=[duet.Constraint("left_wing", 4, (0, 1, 0))])
        self.assertRegex(str(raised.exception), r"constraints\[0\].joint_name: expected a joint of "
                                                "model sbu .*left_hand.*, got \"left_wing\"")

    def example(self, name, *arguments):
        ran = tools.run(sys.executable, "-B", PACKAGE / "examples" / name, *arguments, "--server",
                        self.server.address, env={**os.environ, "PYTHONPATH": str(PACKAGE)})
        self.assertEqual(ran.returncode, 0, ran.stderr)
        return ran.stdout

    def test_the_examples_run(self):
        self.assertIn("done: 91 frames", self.example("live.py", tools.sample("hug"), "hug"))

    def live(self, address, between=lambda frame: None):
        """A live session that sends a frame when the one before it is answered. Calls `between`
        before each frame. Returns the follower and the session."""
        async def run():
            async with duet.aio.Client(address, wait=tools.RUN_SECONDS) as client:
                session = client.live(self.hug.joint_names, self.hug.frame_rate_hz, {"hug": 1},
                                      seed=3)
                found = []
                async with session:
                    for index, frame in enumerate(self.hug.positions):
                        between(index)
                        await session.send(frame)
                        part = await session.__anext__()
                        self.assertEqual(part.first_frame, index)
                        found.append(part.positions)
                    await session.finish()
                    self.assertEqual([part async for part in session], [])
                return np.concatenate(found), session

        return asyncio.run(run())

    def test_live_session_goes_on_with_the_same_frames_after_a_restart(self):
        wanted, session = self.live(self.server.address)
        self.assertEqual(wanted.shape, self.hug.positions.shape)
        self.assertEqual((session.summary.frame_count, session.summary.resume_count), (91, 0))
        servers = [tools.Server(port=tools.free_port())]
        self.addCleanup(lambda: servers[-1].stop())

        def restart(frame):
            if frame == 60:
                servers[-1].kill()
                servers.append(tools.Server(port=servers[-1].port))

        found, session = self.live(servers[0].address, restart)
        self.assertEqual(session.summary.resume_count, 1)
        np.testing.assert_array_equal(found, wanted)


if __name__ == "__main__":
    tools.main()
