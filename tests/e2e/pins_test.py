"""Pins against a real server: a joint of the follower is where the caller wants it."""

import json
import os
import pathlib
import sys
import tempfile

import tools

try:
    import grpc  # noqa: F401
    import numpy as np
except ImportError as error:
    tools.skip(f"{error}; install the packages python3-grpcio and python3-numpy")


os.environ["DUET_PROGRAM"] = str(tools.PROGRAMS / "duet")
os.environ["DUET_CONFIG"] = ""
sys.path.insert(0, str(tools.SOURCE / "client" / "python"))

import duet_motion as duet  # noqa: E402

REACHED = 0.01  # metres
FASTEST = 4.5   # metres per second that a pin may add to a joint


def upsampled(motion, times):
    """The motion at a multiple of its rate, interpolated linearly."""
    frames = np.arange((motion.frame_count - 1) * times + 1) / times
    low = np.floor(frames).astype(int)
    high = np.minimum(low + 1, motion.frame_count - 1)
    share = (frames - low)[:, None, None].astype(np.float32)
    positions = motion.positions[low] * (1 - share) + motion.positions[high] * share
    return duet.Motion(positions, motion.joint_names,
                       frame_rate_hz=motion.frame_rate_hz * times)


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


class PinsTest(tools.ServedTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.client = duet.Client(cls.server.address)
        cls.addClassCleanup(cls.client.close)
        cls.hug = one_window("hug")
        cls.salsa = duet.read_motion(tools.sample("salsa"))

    def ask(self, leader=None, labels=None, **fields):
        return self.client.synthesize(leader or self.hug, labels=labels or {"hug": 1}, **{"seed": 0, **fields})

    def check(self, result, pins):
        for pin, metres in zip(pins, result.constraint_metres, strict=True):
            distance = np.linalg.norm(result.follower.joint(pin.joint)[pin.frame] - pin.position)
            self.assertLess(distance, REACHED, f"{pin.joint} in frame {pin.frame}")
            self.assertAlmostEqual(distance, metres, delta=1e-4)

    def test_a_hand_is_there_and_nothing_jumps(self):
        for name in ("kick", "hug", "push"):
            leader = one_window("kick" if name == "kick" else "hug")
            free = self.ask(leader, {name: 1})
            pin = there(free.follower, "right_hand", 40, (0, 0.25, 0.05))
            pinned = self.ask(leader, {name: 1}, constraints=[pin])
            self.check(pinned, [pin])
            self.assertLess(speed(pinned.follower, "right_hand"),
                            speed(free.follower, "right_hand") + FASTEST)
            self.assertLessEqual(pinned.grade.skating, free.grade.skating + 0.1)
            self.assertLessEqual(pinned.grade.overlapping, free.grade.overlapping + 0.05)

    def test_a_hand_near_its_own_shoulder_is_not_thrown(self):
        for name in ("kick", "hug"):
            leader = duet.read_motion(tools.sample(name))
            free = self.ask(leader, {name: 1})
            for hand in ("left", "right"):
                for frame in (12, 40, 60):
                    place = free.follower.joint(f"{hand}_shoulder")[frame]
                    pinned = self.ask(leader, {name: 1}, constraints=[
                        duet.Constraint(f"{hand}_hand", frame, place)])
                    self.assertLess(speed(pinned.follower, f"{hand}_hand"),
                                    speed(free.follower, f"{hand}_hand") + FASTEST)

    def test_the_body_steps_to_a_mark(self):
        free = self.ask()
        pin = there(free.follower, "torso", 70, (0.25, 0, -0.15))
        pinned = self.ask(constraints=[pin])
        # Standing feet and the leader's body have priority.
        before = np.linalg.norm(free.follower.joint("torso")[70] - pin.position)
        self.assertLess(pinned.constraint_metres[0], before / 2)
        self.assertLessEqual(pinned.grade.skating, free.grade.skating + 0.2)
        self.assertLess(speed(pinned.follower, "torso"), speed(free.follower, "torso") + 2)

    def test_frames_long_before_do_not_change(self):
        free = self.ask()
        pin = there(free.follower, "left_hand", 80, (0, 0.2, 0))
        pinned = self.ask(constraints=[pin])
        np.testing.assert_allclose(pinned.follower.positions[:50], free.follower.positions[:50],
                                   atol=1e-6)  # metres
        again = self.ask(constraints=[pin])
        np.testing.assert_array_equal(pinned.follower.positions, again.follower.positions)
        self.assertEqual(free.constraint_metres, ())

    def test_any_rate_unit_and_axis(self):
        # Where clean-up may take a step at two equally good moments, rounding decides.
        leader = upsampled(self.hug, 2)
        free = self.ask(leader, clean_up=False)
        pins = [there(free.follower, "right_hand", 77, (0, 0.2, 0.05)),
                there(free.follower, "left_hand", 120, (0, 0.2, 0))]
        pinned = self.ask(leader, constraints=pins, clean_up=False)
        self.check(pinned, pins)

        def turned(points):  # metres, y up -> millimetres, z up
            x, y, z = np.moveaxis(np.asarray(points), -1, 0)
            return np.float32(1000) * np.stack([x, -z, y], axis=-1)
        foreign = duet.Motion(turned(leader.positions), leader.joint_names,
                              frame_rate_hz=leader.frame_rate_hz, unit="millimetres",
                              up_axis="z-up")
        answer = self.ask(foreign, clean_up=False, constraints=[
            duet.Constraint(pin.joint, pin.frame, turned(pin.position)) for pin in pins])
        np.testing.assert_allclose(answer.follower.positions, turned(pinned.follower.positions),
                                   atol=2)
        for metres in answer.constraint_metres:
            self.assertLess(metres, REACHED)

    def test_a_tilted_world(self):
        tilt = np.radians(12)
        rotation = np.float32([[1, 0, 0], [0, np.cos(tilt), -np.sin(tilt)],
                               [0, np.sin(tilt), np.cos(tilt)]])
        leader = duet.Motion(self.hug.positions @ rotation.T, self.hug.joint_names,
                             frame_rate_hz=self.hug.frame_rate_hz)
        up = rotation @ np.float32([0, 1, 0])
        free = self.ask(leader, up=up)
        pin = duet.Constraint("right_hand", 40, free.follower.joint("right_hand")[40] + 0.15 * up)
        self.check(self.ask(leader, up=up, constraints=[pin]), [pin])

    def test_every_window_of_a_long_clip(self):
        free = self.ask(self.salsa)
        self.assertGreater(free.window_count, 5)
        last = self.salsa.frame_count
        pins = [there(free.follower, "right_hand", frame, (0, 0.1, 0.05))
                for frame in range(11, last, last // 12)]
        for count in (1, 3):
            pinned = self.ask(self.salsa, constraints=pins, candidates=count)
            self.assertLess(np.median(pinned.constraint_metres), REACHED)
            self.assertLess(max(pinned.constraint_metres), 0.2)
            self.assertLess(speed(pinned.follower, "right_hand"),
                            speed(free.follower, "right_hand") + FASTEST)

    def test_candidates_that_are_near_win(self):
        others = [self.ask(seed=seed).follower.joint("right_hand")[45] for seed in range(6)]
        nearest = []
        for count in (1, 8):
            distances = [self.ask(candidates=count, constraints=[
                duet.Constraint("right_hand", 45, place, softness=1)]).constraint_metres[0]
                for place in others]
            nearest.append(np.mean(distances))
        self.assertLess(nearest[1], nearest[0])

    def test_out_of_reach_is_reported_and_an_unknown_joint_refused(self):
        free = self.ask()
        pin = there(free.follower, "right_hand", 40, (0, 3, 0))
        far = self.ask(constraints=[pin])
        self.assertGreater(far.constraint_metres[0], 1)
        hand, shoulder = (far.follower.joint(name)[40] for name in ("right_hand", "right_shoulder"))
        self.assertGreater(hand[1], shoulder[1])
        with self.assertRaises(duet.RequestMismatchError) as raised:
            self.ask(constraints=[duet.Constraint("left_wing", 4, (0, 1, 0))])
        self.assertRegex(str(raised.exception), r"constraints\[0\].joint_name: expected a joint of "
                                                "model sbu .*left_hand.*, got \"left_wing\"")

    def test_a_pin_far_above_does_not_lift_the_body(self):
        free = self.ask()
        pinned = self.ask(constraints=[duet.Constraint("head", 10, (0, 9, 0))])
        self.assertGreater(pinned.constraint_metres[0], 1)
        self.assertLess(pinned.follower.joint("head")[:, 1].max(),
                        free.follower.joint("head")[:, 1].max() + 0.35)

    def test_the_program_sends_pins_and_reports_what_remains(self):
        free = self.ask()
        place = there(free.follower, "right_hand", 40, (0, 0.25, 0.05)).position
        pins = "up { y: 1 }"
        for joint, frame, (x, y, z) in (("right_hand", 40, place), ("head", 10, (0, 9, 0))):
            pins += (f" constraints {{ joint_name: '{joint}' frame: {frame}"
                     f" position {{ x: {x:.5f} y: {y:.5f} z: {z:.5f} }} }}")
        with tempfile.TemporaryDirectory() as folder:
            out, request = pathlib.Path(folder) / "pair.json", pathlib.Path(folder) / "request"
            request.write_text(pins, encoding="utf-8")
            told = tools.duet("synthesize", "--server", self.server.address, "--leader",
                              tools.sample("hug"), "--label", "hug=1", "--seed", "0",
                              "--request", request, "--json", "--out", out)
            told.check_returncode()
            live = tools.duet("live", "--from", tools.sample("hug"), "--label", "hug=1",
                              "--server", self.server.address, "--request", request, "--to", out)
            leader, follower = duet.read_pair(out)
            self.assertLess(np.linalg.norm(follower.joint("right_hand")[40] - place), 2 * REACHED)
        hand, head = json.loads(told.stdout)["constraints"]
        self.assertEqual((hand["joint_name"], hand["frame"]), ("right_hand", 40))
        self.assertLess(hand["remaining_metres"], REACHED)
        self.assertGreater(head["remaining_metres"], 1)
        self.assertNotEqual(live.returncode, 0)
        self.assertIn("constraints", live.stderr)


if __name__ == "__main__":
    tools.main()
