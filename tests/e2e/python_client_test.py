"""The Python package and its examples against a real server."""

import asyncio
import dataclasses
import os
import pathlib
import re
import sys
import tempfile
import threading
import unittest

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

    def test_a_tilted_leader_gets_the_level_answer_tilted(self):
        angle = np.radians(12)
        rotation = np.array([[1, 0, 0], [0, np.cos(angle), np.sin(angle)],
                             [0, -np.sin(angle), np.cos(angle)]])
        level = self.client.synthesize(self.hug, {"hug": 1}, seed=3).follower.positions
        tilted = self.client.synthesize(
            self.hug.with_positions(self.hug.positions @ rotation), {"hug": 1}, seed=3,
            up=(0, 1, 0) @ rotation).follower.positions
        np.testing.assert_allclose(tilted @ rotation.T, level, atol=2e-3)
        with self.assertRaisesRegex(duet.InvalidRequestError, "up: expected a direction of any"):
            self.client.synthesize(self.hug, {"hug": 1}, up=(1, 0, 0))

    def test_program_gives_the_same_answer(self):
        with tempfile.TemporaryDirectory() as folder:
            out = pathlib.Path(folder) / "pair.json"
            tools.duet("synthesize", "--server", self.server.address, "--leader",
                       tools.sample("hug"), "--label", "hug=1", "--seed", 3, "--out",
                       out).check_returncode()
            _, follower = duet.read_pair(out)
        result = self.client.synthesize(self.hug, {"hug": 1}, seed=3)
        np.testing.assert_array_equal(result.follower.positions, follower.positions)

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

    def test_300_gathered_calls_succeed(self):
        async def ask():
            async with duet.aio.Client(self.server.address) as client:
                return await asyncio.gather(*(
                    client.synthesize(self.hug, {"hug": 1}, seed=seed) for seed in range(300)))
        results = asyncio.run(ask())
        self.assertEqual([result.seed for result in results], list(range(300)))
        np.testing.assert_array_equal(
            results[3].follower.positions,
            self.client.synthesize(self.hug, {"hug": 1}, seed=3).follower.positions)

    def test_training_example_recognises_the_classes_of_a_leader_that_it_never_saw(self):
        with tempfile.TemporaryDirectory() as folder:
            out = pathlib.Path(folder) / "set"
            recipe = pathlib.Path(folder) / "recipe.textproto"
            recipe.write_text("seed: 7 reactions { each_class {} } samples: 8 "
                              "output { formats: FORMAT_NPY }",
                              encoding="utf-8")
            leaders = [tools.sample(name) for name in ("kick", "hug", "push", "punch")]
            tools.duet("batch", *leaders, "--recipe", recipe, "--out", out, "--server",
                       self.server.address, "--quiet").check_returncode()
            duet.sets.split(out, test=0.3)
            command = [sys.executable, "-B", PACKAGE / "examples" / "train_on_set.py", out]
            environment = {**os.environ, "PYTHONPATH": str(PACKAGE)}
            ran = tools.run(*command, env=environment)
            self.assertEqual(ran.returncode, 0, ran.stderr)
            share = int(re.search(r"\((\d+) %\)", ran.stdout)[1])
            self.assertGreater(share, 50, ran.stdout)  # chance is 17
            duet.sets.split(out)
            refused = tools.run(*command, env=environment)
            self.assertEqual(refused.returncode, 2)
            self.assertIn("split: expected train", refused.stderr)

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
