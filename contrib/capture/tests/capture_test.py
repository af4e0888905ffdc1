"""The readers, the clock, the writer and the joint map, without a server. The datagrams are those of the
published layouts (senders.py)."""

import json
import math
import pathlib
import random
import struct
import sys
import unittest

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import clock  # noqa: E402
import frames  # noqa: E402
import osc  # noqa: E402
import senders  # noqa: E402
from body import BodyMap  # noqa: E402
from frames import BONE_NAMES, BONES, Frame, find_bone  # noqa: E402
from rokoko import RokokoReader, lz4  # noqa: E402
from vmc import VmcReader, VmcWriter  # noqa: E402
from xsens import XsensReader  # noqa: E402

RATE, PERIOD = 50, 1 / 50
SBU = ["head", "neck", "torso", "left_shoulder", "left_elbow", "left_hand", "right_shoulder", "right_elbow",
       "right_hand", "left_hip", "left_knee", "left_foot", "right_hip", "right_knee", "right_foot"]
# Made by `lz4 -9 --no-frame-crc` 1.9.4 of 200 times "duet" and "end".
LZ4 = bytes.fromhex("04224d18604082110000004f647565740400ffffff0a506574656e6400000000")


def rest():
    """The built-in person in the T pose, right-handed."""
    at = []
    for (_, _, offset), parent in zip(BONES, frames.PARENTS):
        at.append(np.array(offset, float) + (at[parent] if parent >= 0 else 0))
    return np.array(at)


REST = rest()


def vmc(seconds=None, bones=(), **changes):
    """A bundle of bones {name: (position, rotation)} in Unity's axes."""
    elements = [] if seconds is None else [osc.message("/VMC/Ext/T", "f", seconds)]
    for name in bones:
        position, rotation = changes.get(name) or ((-1, 1, 1) * frames.OFFSETS[find_bone(name)], (0, 0, 0, 1))
        elements.append(osc.message("/VMC/Ext/Bone/Pos", "sfffffff", name, *position, *rotation))
    return osc.bundle(elements)


def read_all(reader, *datagrams):
    return [frame for datagram in datagrams for frame in reader.read(datagram)]


class VmcReaderTest(unittest.TestCase):
    def read_one(self, datagram, reader=None):
        [frame] = read_all(reader or VmcReader(), datagram, vmc(9))
        return frame.positions

    def test_adds_up_the_bones_of_a_frame(self):
        reader = VmcReader()
        [frame] = read_all(reader, vmc(1, BONE_NAMES), vmc(2))
        self.assertEqual(frame.seconds, 1)
        np.testing.assert_allclose(frame.positions, REST, atol=1e-3)

    def test_accepts_the_names_of_vrm_and_of_files(self):
        for other, bone in {"LeftArm": "LeftUpperArm", "LeftForeArm": "LeftLowerArm", "l_wrist": "LeftHand",
                            "RightUpLeg": "RightUpperLeg", "RightLeg": "RightLowerLeg",
                            "ankle.R": "RightFoot", "RightToeBase": "RightToes", "pelvis": "Hips",
                            "hip": "Hips", "head": "Head", "LEFT_HIP": "LeftUpperLeg",
                            "LeftShoulder": "LeftShoulder"}.items():
            self.assertEqual(BONE_NAMES[find_bone(other)], bone, other)
        for bone in BONE_NAMES:
            self.assertEqual(BONE_NAMES[find_bone(bone[0].lower() + bone[1:])], bone)
        for other in ("LeftEye", "Jaw", "LeftThumbProximal", "leftIndexDistal", "", "left"):
            self.assertEqual(find_bone(other), -1, other)

    def test_turns_children_with_their_parents_in_right_handed_axes(self):
        half = math.sqrt(0.5)  # the hips, 90 degrees about y: in Unity, from z towards x
        at = self.read_one(vmc(1, BONE_NAMES, Hips=((0, 0.95, 0), (0, half, 0, half))))
        hand = at[find_bone("LeftHand")]
        np.testing.assert_allclose((hand[0], hand[2]), (0, REST[find_bone("LeftHand")][0]), atol=1e-3)
        self.assertLess(at[find_bone("LeftToes")][0], at[find_bone("LeftFoot")][0] - 0.1)

    def test_a_frame_spans_datagrams_and_survives_a_lost_one(self):
        upper, legs = BONE_NAMES[:14], vmc(None, BONE_NAMES[14:])
        got = read_all(VmcReader(), vmc(1, upper), legs, vmc(2, upper), legs, vmc(3, upper), vmc(4, upper), legs,
                       vmc(5, upper), legs)
        self.assertEqual([frame.seconds for frame in got], [1, 2, 3, 4, 5])

    def test_a_repeated_bone_ends_a_frame_and_a_time_is_that_of_one_frame(self):
        got = read_all(VmcReader(), vmc(1, BONE_NAMES), vmc(None, BONE_NAMES), vmc(None, BONE_NAMES))
        self.assertEqual([frame.seconds for frame in got], [1, None, None])

    def test_what_a_sender_leaves_out_is_that_of_the_built_in_person(self):
        zero = {name: ((0, 0, 0), (0, 0, 0, 1)) for name in BONE_NAMES}
        rest_of = {"positions of zero": vmc(1, BONE_NAMES, **zero), "no legs": vmc(1, BONE_NAMES[:14])}
        # The sender's chest is the parent of neck and shoulders.
        chained = {name: ((-1, 1, 1) * frames.OFFSETS[find_bone(name)] + (0, 0.12, 0), (0, 0, 0, 1))
                   for name in ("Neck", "LeftShoulder", "RightShoulder")}
        rest_of["no upper chest"] = vmc(1, [name for name in BONE_NAMES if name != "UpperChest"], **chained)
        for what, datagram in rest_of.items():
            with self.subTest(what):
                np.testing.assert_allclose(self.read_one(datagram), REST, atol=1e-3)

    def test_a_lost_bone_keeps_its_transform_and_one_that_never_came_is_named(self):
        some = [name for name in BONE_NAMES if name != "Chest"]
        first, second = read_all(VmcReader(), vmc(1, BONE_NAMES), vmc(2, some), vmc(3))
        np.testing.assert_allclose(second.positions, first.positions)
        reader = VmcReader()
        read_all(reader, *(vmc(i, some) for i in range(40)))
        self.assertEqual(len(reader.notes), 1)
        self.assertIn("leaves out Chest;", reader.notes[0])

    def test_rejects_transforms_that_are_none(self):
        for value in (math.nan, math.inf, 2000.0):
            with self.assertRaisesRegex(ValueError, "a position within 1000 m"):
                VmcReader().read(vmc(1, ["Hips"], Hips=((0, value, 0), (0, 0, 0, 1))))

    def test_repeated_bones_are_a_bounded_number_of_frames(self):
        self.assertLessEqual(len(VmcReader().read(vmc(None, ["Hips"] * 700))), 8)


class OtherReadersTest(unittest.TestCase):
    def xsens(self, positions, sample=0, time_code=0, character=0, first=1, identity=b"MXTP02"):
        items = b"".join(struct.pack(">I7f", first + i, *position, 1, 0, 0, 0)
                         for i, position in enumerate(positions))
        return identity + struct.pack(">IBBIBBBBHH", sample, 0x80, len(positions), time_code, character, 23, 0, 0,
                                      0, len(items)) + items

    def test_xsens_segments_have_y_up(self):
        positions = [(i, 0.5, -i / 8) for i in range(23)]
        positions[2] = (1, 2, 3)
        datagram = self.xsens(positions, time_code=1250)
        self.assertEqual(len(datagram), 760)  # as the specification says
        [frame] = XsensReader().read(datagram)
        self.assertEqual(frame.seconds, 1.25)
        np.testing.assert_allclose(frame.positions[2], (1, 3, -2))
        self.assertEqual(frame.positions.shape, (len(XsensReader.joint_names), 3))

    def test_an_xsens_sample_may_span_datagrams(self):
        reader = XsensReader()
        half, rest_of = [(0, 0, 0)] * 10, [(0, 0, 0)] * 13
        self.assertEqual(reader.read(self.xsens(rest_of, 7, first=11)), [])
        self.assertEqual(len(reader.read(self.xsens(half, 7))), 1)
        self.assertEqual(reader.read(self.xsens(half, 8)), [])
        self.assertEqual(reader.read(self.xsens(rest_of, 9, first=11)), [])

    def test_an_xsens_time_code_that_stands_still_is_no_time(self):
        reader = XsensReader()
        got = [reader.read(self.xsens([(0, 0, 0)] * 23, sample))[0].seconds for sample in range(3)]
        self.assertEqual(got, [0, None, None])

    def test_the_first_xsens_character_leads(self):
        reader = XsensReader()
        body = [(0, 0, 0)] * 23
        self.assertEqual([len(reader.read(self.xsens(body, i, character=c))) for i, c in enumerate((3, 4, 3))],
                         [1, 0, 1])
        self.assertIn("character 3 leads", reader.notes[0])

    def test_xsens_rejects_other_datagrams(self):
        whole = self.xsens([(0, 0, 0)] * 23)
        with self.assertRaisesRegex(ValueError, r"select Position \+ Orientation"):
            XsensReader().read(self.xsens([(0, 0, 0)] * 23, identity=b"MXTP01"))
        for size in range(0, len(whole), 5):
            with self.assertRaisesRegex(ValueError, "expected"):
                XsensReader().read(whole[:size])
        with self.assertRaisesRegex(ValueError, "segment 5"):
            XsensReader().read(self.xsens([(0, 0, 0)] * 4 + [(0, math.nan, 0)] + [(0, 0, 0)] * 18))

    def rokoko(self, seconds=1.0, actor="Ann", **changes):
        scene = json.loads(senders.rokoko(0, seconds)[0])
        scene["scene"]["actors"][0]["name"] = actor
        scene["scene"]["actors"][0]["body"].update(changes)
        return scene

    def test_rokoko_positions_are_right_handed(self):
        hip = {"position": {"x": 1, "y": 2, "z": 3}}
        [frame] = RokokoReader().read(json.dumps(self.rokoko(2.5, hip=hip)).encode())
        self.assertEqual(frame.seconds, 2.5)
        np.testing.assert_allclose(frame.positions[0], (-1, 2, 3))

    def test_the_first_rokoko_actor_with_a_body_leads(self):
        reader = RokokoReader()
        bodiless = self.rokoko(actor="Cid")
        bodiless["scene"]["actors"][0]["meta"]["hasBody"] = False
        got = [len(reader.read(json.dumps(scene).encode()))
               for scene in (bodiless, self.rokoko(), self.rokoko(actor="Bob"), self.rokoko())]
        self.assertEqual(got, [0, 1, 0, 1])
        self.assertIn("'Ann' leads", reader.notes[0])

    def test_rokoko_toes_that_are_missing_are_at_the_feet(self):
        scene = self.rokoko()
        for toe in ("leftToe", "rightToe"):
            del scene["scene"]["actors"][0]["body"][toe]
        reader = RokokoReader()
        [frame] = reader.read(json.dumps(scene).encode())
        joints = reader.joint_names
        for side in ("Left", "Right"):
            np.testing.assert_array_equal(frame.positions[joints.index(side + "Toes")],
                                          frame.positions[joints.index(side + "Foot")])
        self.assertIn("no toes", reader.notes[0])

    def test_rokoko_names_what_is_wrong(self):
        no_leg = self.rokoko(leftLeg={})
        for datagram, error in ((b"no JSON", "select the format JSON v3"), (b"\xff\xfe", "expected JSON"),
                                (b'{"version":"3","trackers":[]}', "scene.actors: expected a list, got none"),
                                (json.dumps(no_leg).encode(), "body.leftLeg.position.x: expected a number"),
                                (json.dumps(self.rokoko(hip={"position": {"x": 0, "y": 1e9, "z": 0}})).encode(),
                                 "body.hip.position.y")):
            with self.assertRaisesRegex(ValueError, error):
                RokokoReader().read(datagram)

    def test_a_rokoko_timestamp_that_is_no_number_is_no_time(self):
        scene = self.rokoko()
        scene["scene"]["timestamp"] = ""
        [frame] = RokokoReader().read(json.dumps(scene).encode())
        self.assertIsNone(frame.seconds)

    @unittest.skipIf(lz4 is None, "needs python3-lz4")
    def test_rokoko_reads_lz4_frames_within_the_limit(self):
        text = json.dumps(self.rokoko()).encode()
        self.assertEqual(len(RokokoReader().read(lz4.frame.compress(text))), 1)
        bad = (lz4.frame.compress(bytes(600_000)), lz4.frame.compress(text)[:-9], LZ4)
        for datagram, error in zip(bad, ("at most", "LZ4", "expected JSON")):
            with self.assertRaisesRegex(ValueError, error):
                RokokoReader().read(datagram)

    def test_arbitrary_bytes_are_errors_at_worst(self):
        chance = random.Random(1)
        for make, reader in ((senders.vmc, VmcReader), (senders.xsens, XsensReader),
                             (senders.rokoko, RokokoReader)):
            stream = clock.CaptureStream(reader, 30)
            for i in range(300):
                datagram = bytearray(make(i, i / 30)[0])
                for _ in range(chance.randrange(6)):
                    datagram[chance.randrange(len(datagram))] = chance.randrange(256)
                stream.receive(bytes(datagram[:chance.randrange(1, 2 * len(datagram))]), "a", i / 30)
                while (frame := stream.next(i / 30)) is not None:
                    self.assertTrue(np.isfinite(frame.positions).all())


class FrameClockTest(unittest.TestCase):
    def setUp(self):
        self.clock = clock.FrameClock(RATE)
        self.frames = []

    def arrive(self, seconds, now, claimed=None):
        """A joint that moves 1 m in a second, so that its position is the time of a frame."""
        self.clock.receive(Frame(100 + seconds if claimed is None else claimed, np.array([[seconds, 0, 0]])), now)
        self.take(now)

    def arrive_in_time(self, *numbers):
        for i in numbers:
            self.arrive(i * PERIOD, i * PERIOD + 0.005)

    def take(self, now):
        while (frame := self.clock.next(now)) is not None:
            self.assertEqual(frame.index, len(self.frames))
            self.frames.append(frame)

    def at(self, frame):
        return self.frames[frame].positions[0, 0]

    def check_times(self, tolerance=1e-4):
        for i in range(len(self.frames)):
            self.assertAlmostEqual(self.at(i), i * PERIOD, delta=tolerance)

    def test_passes_frames_on_as_they_arrive(self):
        for i in range(100):
            self.arrive_in_time(i)
            self.assertEqual(len(self.frames), i + 1)
            self.assertAlmostEqual(self.frames[-1].capture_seconds, i * PERIOD + 0.005, delta=1e-6)
        self.check_times()
        self.assertEqual(+self.clock.counts, {})

    def test_drops_duplicates(self):
        self.arrive_in_time(*range(6))
        self.arrive(5 * PERIOD, 5 * PERIOD + 0.016)
        self.arrive_in_time(6, 7)
        self.assertEqual((len(self.frames), self.clock.counts["duplicates"]), (8, 1))

    def test_puts_frames_back_into_order(self):
        self.arrive_in_time(*range(6))
        self.arrive(7 * PERIOD, 0.145)
        self.assertEqual(len(self.frames), 6)
        self.arrive(6 * PERIOD, 0.150)
        self.assertEqual((len(self.frames), self.frames[6].source), (8, "captured"))
        self.assertEqual(self.clock.counts["put back into order"], 1)
        self.check_times()

    def test_interpolates_a_lost_frame_after_the_time_for_reordering(self):
        self.arrive_in_time(*range(6))
        self.arrive(7 * PERIOD, 0.145)
        self.assertAlmostEqual(self.clock.next_due(), 0.175)
        self.take(0.174)
        self.assertEqual(len(self.frames), 6)
        self.take(0.1751)
        self.assertEqual((len(self.frames), self.frames[6].source), (8, "interpolated"))
        self.arrive(6 * PERIOD, 0.1755)
        self.assertEqual((len(self.frames), self.clock.counts["too late"]), (8, 1))
        self.check_times()

    def test_interpolates_gaps_up_to_a_quarter_of_a_second(self):
        self.arrive_in_time(*range(6), 17)
        self.take(17 * PERIOD + 0.036)
        self.assertEqual((len(self.frames), self.clock.counts["interpolated"]), (18, 11))
        self.check_times()

    def test_holds_the_pose_in_longer_gaps_at_the_rate(self):
        self.arrive_in_time(*range(6))
        self.take(0.105 + 0.27)
        self.assertEqual(len(self.frames), 6)
        for step in range(39, 211):
            self.take(step / 100 + 0.005)
        self.assertAlmostEqual(len(self.frames), 2.1 * RATE, delta=2)
        self.assertEqual((self.frames[-1].source, self.at(-1)), ("held", 5 * PERIOD))
        self.arrive_in_time(110, 111)
        self.assertAlmostEqual(self.at(-1), 111 * PERIOD, delta=1e-4)
        self.assertEqual([note.split()[0] for note in self.clock.notes], ["nothing", "frames"])

    def test_jitter_of_the_network_does_not_reach_the_frames(self):
        chance = random.Random(3)
        arrivals = sorted((i * PERIOD + 0.005 + chance.randrange(30) / 1000, i * PERIOD) for i in range(500))
        for now, captured in arrivals:
            while self.clock.next_due() < now:
                before = len(self.frames)
                self.take(self.clock.next_due() + 1e-9)
                if len(self.frames) == before:
                    break
            self.arrive(captured, now)
        self.take(11)
        steps = [self.at(i + 1) - self.at(i) for i in range(100, 499)]
        self.assertLess(max(abs(step - PERIOD) for step in steps), 0.003)
        self.assertAlmostEqual(self.frames[400].capture_seconds - self.at(400), 0.005, delta=0.003)

    def test_resamples_a_sender_of_another_rate(self):
        for i in range(300):
            self.arrive(i / 30, i / 30 + 0.004)
        self.assertAlmostEqual(len(self.frames), 299 / 30 * RATE, delta=2)
        self.check_times(0.004)
        self.assertEqual(self.clock.notes, [])

    def test_keeps_step_with_a_sender_that_is_slightly_faster_or_slower(self):
        for period in (PERIOD / 1.001, PERIOD * 1.001):
            self.setUp()
            for i in range(5000):
                self.arrive(i * period, i * period + 0.004)
                self.assertEqual(len(self.frames), i + 1)  # no wait, no frame left out

    def test_a_sender_clock_that_jumps_is_set_anew(self):
        for jump in (-50, -0.7, 5000):
            self.setUp()
            self.arrive_in_time(*range(21))
            for i in range(21, 100):
                self.arrive(i * PERIOD, i * PERIOD + 0.005, claimed=100 + i * PERIOD + jump)
            self.assertEqual(self.clock.counts["jumps of the sender's clock"], 1, jump)
            self.assertAlmostEqual(self.at(-1), 99 * PERIOD, delta=0.01)
            self.assertAlmostEqual(len(self.frames), 100, delta=1)

    def test_frames_without_times_have_that_of_their_arrival(self):
        for i in range(100):
            now = i * PERIOD + (i % 3) * 0.003
            self.clock.receive(Frame(None, np.array([[i * PERIOD, 0, 0]])), now)
            self.take(now)
        self.assertEqual((len(self.frames), +self.clock.counts), (100, {}))

    def test_whatever_a_sender_claims_frames_go_on_with_the_receivers_clock(self):
        chance = random.Random(5)
        for claim in (lambda: 7.0, lambda: chance.randrange(2_000_000) / 1000 - 1000):
            self.setUp()
            for i in range(1000):
                self.arrive(i * PERIOD, i * PERIOD, claimed=claim())
            self.assertAlmostEqual(len(self.frames), 1000, delta=20)
            self.assertGreater(self.at(-1), 990 * PERIOD)


class CaptureStreamTest(unittest.TestCase):
    def test_estimates_rates_in_spite_of_loss_and_rounding(self):
        for rate in (24, 30, 60, 90, 120):
            times = [round(i / rate, 3) for i in range(rate + 9) if i % 7 != 3]
            self.assertEqual(clock.estimate_rate(times), rate)
        for measured, usual in ((62.1, 60), (58.2, 60), (30.9, 30), (24.1, 24), (73.9, 75), (64, 64), (43, 43),
                                (240, 120)):
            self.assertAlmostEqual(clock.estimate_rate([i / measured for i in range(301)]), usual)
        self.assertIsNone(clock.estimate_rate([i / 60 for i in range(30)]))

    def hips(self, seconds, height=1):
        return vmc(seconds, ["Hips"], Hips=((0, height, 0), (0, 0, 0, 1)))

    def test_measures_the_rate_and_then_passes_frames_on(self):
        stream = clock.CaptureStream(VmcReader)
        count = 0
        for i in range(120):
            stream.receive(self.hips(i / 60), "a", i / 60)
            while stream.next(i / 60):
                count += 1
        self.assertEqual(stream.rate_hz, 60)
        self.assertAlmostEqual(count, 60, delta=3)
        self.assertIn("120 frames", stream.summary())
        self.assertNotIn("no frame", " ".join(stream.notes))

    def test_ignores_a_second_sender_until_the_first_is_silent(self):
        stream = clock.CaptureStream(VmcReader, 30)
        heights = []

        def receive(i, sender, height):
            stream.receive(self.hips(i / 30, height), sender, i / 30)
            while (frame := stream.next(i / 30)) is not None:
                heights.append(frame.positions[0, 1])
        for i in range(30):
            receive(i, "a", 1)
            receive(i, "b", 2)
        self.assertNotIn(2, heights)
        self.assertTrue(any("a second sender" in note for note in stream.notes))
        for i in range(150, 160):
            receive(i, "b", 2)
        self.assertEqual(heights[-1], 2)

    def test_reports_once_what_it_does_not_understand(self):
        stream = clock.CaptureStream(VmcReader, 30)
        for i in range(100):
            stream.receive(b"MXTP%02d" % (i % 10), "a", i)
        self.assertEqual(len(stream.notes), 1)
        self.assertIn("100 datagrams not understood", stream.summary())

    def test_names_what_is_missing_in_a_stream_without_frames(self):
        for datagram, reader, missing in (
                (osc.bundle([osc.message("/VMC/Ext/Bone/Pos", "sfffffff", "mBone", *range(7))]), VmcReader,
                 "got only the bones 'mBone'"),
                (osc.bundle([osc.message("/VMC/Ext/OK", "i", 1)]), VmcReader, "got only '/VMC/Ext/OK'"),
                (b'{"scene":{"actors":[]}}', RokokoReader, "an actor with a body")):
            stream = clock.CaptureStream(reader, 30)
            stream.receive(datagram, "a", 100)
            self.assertIsNone(stream.next(100))
            self.assertIsNone(stream.next(stream.next_due()))
            self.assertIsNone(stream.next(200))
            self.assertEqual(len(stream.notes), 1)
            self.assertIn(missing, stream.notes[0])


class BodyMapTest(unittest.TestCase):
    def test_a_model_joint_is_at_its_place_for_every_protocol(self):
        for make, reader in ((senders.vmc, VmcReader()), (senders.xsens, XsensReader()),
                             (senders.rokoko, RokokoReader())):
            first = read_all(reader, *make(0, 0), *make(1, 1 / 30))[0].positions
            if reader.joint_names == XsensReader.joint_names:
                first = first[:, (2, 1, 0)] * (-1, 1, 1)  # MVN's person faces +x
            at = dict(zip(SBU, BodyMap(reader.joint_names, SBU, first, {}).apply(first)))
            with self.subTest(make.__name__):
                for joint, bone in (("left_hand", "LeftHand"), ("right_knee", "RightLowerLeg"),
                                    ("left_hip", "LeftUpperLeg"), ("neck", "Neck")):
                    np.testing.assert_allclose(at[joint], REST[find_bone(bone)], atol=0.01)
                self.assertAlmostEqual(at["torso"][1], 1.18, delta=0.13)
                self.assertAlmostEqual(at["head"][1], REST[find_bone("Head")][1] + 0.1, delta=0.02)

    def test_wrists_and_tops_of_heads_have_their_own_joints(self):
        joints = ["head", "head_top", "left_wrist", "left_hand", "hips", "chest", "left_toe"]
        at = dict(zip(joints, BodyMap(BONE_NAMES, joints, REST, {}).apply(REST)))
        np.testing.assert_allclose(at["head"], REST[find_bone("Head")])
        self.assertGreater(at["head_top"][1], at["head"][1] + 0.1)
        self.assertGreater(at["left_hand"][0], at["left_wrist"][0] + 0.05)

    def test_unknown_joints_are_named_and_can_be_given(self):
        with self.assertRaisesRegex(ValueError, "expected joints for tail, got none"):
            BodyMap(BONE_NAMES, ["tail"], REST, {})
        at = BodyMap(BONE_NAMES, ["tail"], REST, {"tail": "Hips"}).apply(REST)
        np.testing.assert_allclose(at[0], REST[0])
        with self.assertRaisesRegex(ValueError, "--joint tail=Tip"):
            BodyMap(BONE_NAMES, ["tail"], REST, {"tail": "Tip"})


class VmcWriterTest(unittest.TestCase):
    """A person with the joints of SBU who stands in the T pose, turned by 0.7 about y, with a bent arm."""

    class Joint:
        def __init__(self, name, parent):
            self.name, self.parent = name, parent

    def setUp(self):
        turn = np.array([0, math.sin(0.35), 0, math.cos(0.35)])
        bend = np.array([0, 0, math.sin(0.4), math.cos(0.4)])
        parents = {"torso": "", "neck": "torso", "neck_to_head": "neck", "head": "neck_to_head"}
        for side in ("left", "right"):
            for part, above in (("shoulder", "neck"), ("elbow", f"{side}_shoulder"), ("hand", f"{side}_elbow"),
                                ("hip", "torso"), ("knee", f"{side}_hip"), ("foot", f"{side}_knee")):
                parents[f"{side}_{part}"] = above
        names = list(parents)
        self.rig = [self.Joint(name, names.index(above) if above else -1) for name, above in parents.items()]
        self.rotations = np.array([turn if name == "torso" else bend if name == "left_elbow" else frames.IDENTITY
                                   for name in names])
        at = dict(zip(SBU, BodyMap(BONE_NAMES, SBU, REST, {}).apply(REST)))
        at["left_hand"] = at["left_elbow"] + frames.rotate(bend, at["left_hand"] - at["left_elbow"])
        self.positions = np.array([frames.rotate(turn, at[name]) for name in SBU])

    def read_back(self, datagrams):
        [frame] = read_all(VmcReader(), *datagrams, vmc(9))
        return frame.positions

    def test_what_is_sent_is_received(self):
        datagrams = VmcWriter(SBU).write(self.rig, self.rotations, self.positions, 0.5)
        self.assertGreater(len(datagrams), 1)
        self.assertTrue(all(len(datagram) <= VmcWriter.MOST_BYTES for datagram in datagrams))
        back = self.read_back(datagrams)
        for joint, bone in (("left_hand", "LeftHand"), ("right_foot", "RightFoot"), ("head", "Head"),
                            ("left_elbow", "LeftLowerArm"), ("right_hip", "RightUpperLeg")):
            np.testing.assert_allclose(back[find_bone(bone)], self.positions[SBU.index(joint)], atol=1e-4)

    def test_rotations_alone_give_the_pose(self):
        datagrams = VmcWriter(SBU).write(self.rig, self.rotations, self.positions, 0)
        elements = []
        for datagram in datagrams:
            for address, types, data in osc.messages(datagram):
                values = osc.arguments(types, data)
                if address == "/VMC/Ext/Bone/Pos":  # positions of zero: the reader's built-in person
                    elements.append(osc.message(address, types, values[0], 0, 0, 0, *values[4:]))
        back = self.read_back([osc.bundle(elements)])
        joints = {"LeftUpperArm": "left_shoulder", "LeftLowerArm": "left_elbow", "LeftHand": "left_hand",
                  "RightUpperLeg": "right_hip", "RightLowerLeg": "right_knee", "Neck": "neck", "Head": "head"}
        for a, b in (("LeftUpperArm", "LeftLowerArm"), ("LeftLowerArm", "LeftHand"),
                     ("RightUpperLeg", "RightLowerLeg"), ("Neck", "Head")):
            got = frames.unit(back[find_bone(b)] - back[find_bone(a)], 0)
            sent = frames.unit(self.positions[SBU.index(joints[b])] - self.positions[SBU.index(joints[a])], 0)
            self.assertGreater(got @ sent, 0.999, b)

    def test_names_the_joints_that_a_follower_lacks(self):
        with self.assertRaisesRegex(ValueError, "expected the joints neck, left_shoulder"):
            VmcWriter(["head", "left_hand"])


if __name__ == "__main__":
    unittest.main()
