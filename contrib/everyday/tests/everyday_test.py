import contextlib
import dataclasses
import importlib.util
import io
import json
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

HAS_NUMPY = importlib.util.find_spec("numpy") is not None

if HAS_NUMPY:
    import make_everyday
    import numpy
    from everyday import baselines, captures, dataset_folder, figures, staged

JOINTS = ("Hips", "Spine", "Chest", "Neck", "Head", "HeadTop",
          "LShoulder", "LElbow", "LWrist", "LHand", "RShoulder", "RElbow", "RWrist", "RHand",
          "LHip", "LKnee", "LAnkle", "LToe", "RHip", "RKnee", "RAnkle", "RToe")
PARENTS = (-1, 0, 1, 2, 3, 4, 2, 6, 7, 8, 2, 10, 11, 12, 0, 14, 15, 16, 0, 18, 19, 20)
FLOOR = (1, 0, 1)


def person(frames, speed=0.0):
    """A body that faces +z, raises its right hand and walks ahead: [frames, joints, 3], metres."""
    limb = {"Shoulder": (.2, 1.4, 0), "Elbow": (.25, 1.2, .1), "Wrist": (.2, 1.1, .3),
            "Hand": (.2, 1.1, .4), "Hip": (.1, .9, 0), "Knee": (.1, .5, 0), "Ankle": (.1, .1, 0),
            "Toe": (.1, .05, .15)}
    middle = {"Hips": .95, "Spine": 1.1, "Chest": 1.3, "Neck": 1.5, "Head": 1.6, "HeadTop": 1.75}
    pose = [(0, middle[name], 0) if name in middle
            else numpy.array(limb[name[1:]]) * [1 if name[0] == "L" else -1, 1, 1] for name in JOINTS]
    motion = numpy.repeat(numpy.array(pose, dtype=float)[None], frames, axis=0)
    motion[:, JOINTS.index("RHand"), 1] += numpy.linspace(0, 0.5, frames)
    motion[..., 2] += speed * numpy.arange(frames)[:, None]
    return motion


def archive(rate=60, **arrays):
    return captures.Archive("people.npz", JOINTS, PARENTS, rate, arrays)


@unittest.skipUnless(HAS_NUMPY, "needs python3-numpy")
class CapturesTest(unittest.TestCase):
    def pairs(self, spans, glitches=None, frames=300, left_out=False):
        people = archive(a_18_01=person(frames), b_19_01=person(frames) + [0, 0, 1])
        return captures.pairs(people, {"18_01": (1, left_out, spans)}, glitches or {})

    def test_a_pair_begins_and_ends_with_its_classes(self):
        pair, = self.pairs([("pull", 1.0, 3.0), ("walk", 2.0, 4.0)])
        self.assertEqual((pair.name, pair.leader, pair.subjects), ("18_01", 1, ("18_01",)))
        self.assertEqual(pair.spans, (("pull", 0, 2), ("walk", 1, 3)))
        self.assertEqual([len(one) for one in pair.people], [90, 90])
        height = pair.people[0][0, JOINTS.index("RHand"), 1]
        self.assertAlmostEqual(height, 1.1 + .5 * 60 / 299, delta=.002)

    def test_frames_with_glitches_are_left_out(self):
        first, second = self.pairs([("pull", 0, 5)], {"b_19_01": [(100, 120)]})
        self.assertEqual((first.name, second.name), ("18_01", "18_01_2"))
        self.assertAlmostEqual(first.seconds, 100 / 60, delta=.05)
        self.assertAlmostEqual(second.seconds, 179 / 60, delta=.05)

    def test_short_stretches_are_dropped(self):
        self.assertEqual(self.pairs([("pull", 0, 0.9)]), [])

    def test_a_left_out_trial_has_a_second_subject(self):
        self.assertEqual(self.pairs([("pull", 0, 5)], left_out=True)[0].subjects,
                         ("18_01", captures.LEFT_OUT))

    def test_a_missing_or_shorter_partner_is_named(self):
        for partner, message in (({}, "b_19_01: expected an array, got none"),
                                 ({"b_19_01": person(5)}, "b_19_01: expected 300 frames")):
            with self.subTest(message), self.assertRaisesRegex(captures.CaptureError, message):
                captures.pairs(archive(a_18_01=person(300), **partner),
                               {"18_01": (0, False, [("pull", 0, 5)])}, {})

    def test_the_stretches_name_known_classes(self):
        trials = captures.read_stretches(make_everyday.STRETCHES)
        named = {span[0] for _, _, spans in trials.values() for span in spans}
        self.assertEqual(named, set(dataset_folder.CLASSES))
        for name in named:
            held = [left_out for _, left_out, spans in trials.values()
                    if name in {span[0] for span in spans}]
            self.assertGreaterEqual(len(held), 3, name)
            self.assertTrue(any(held) and not all(held), name)


@unittest.skipUnless(HAS_NUMPY, "needs python3-numpy")
class StagedTest(unittest.TestCase):
    def setUp(self):
        self.random = numpy.random.default_rng(1)

    def test_walkers_keep_beside_each_other(self):
        leader, follower = staged.beside(person(90, speed=.03), JOINTS, self.random)
        apart = (follower - leader)[:, 0] * FLOOR
        distances = numpy.linalg.norm(apart, axis=1)
        self.assertGreater(distances.min(), staged.BESIDE_METRES[0] - .01)
        self.assertLess(distances.max(), staged.BESIDE_METRES[1] + .2)  # late by some frames

    def test_who_walks_up_stops_and_reaches_out(self):
        walk = person(150, speed=.04)
        leader, follower = staged.approach(walk, 60, JOINTS, self.random)
        hands = [JOINTS.index(side + "Hand") for side in "LR"]
        apart = numpy.linalg.norm(leader[:, hands] - follower[:, hands], axis=2).min(axis=1)
        self.assertLess(apart[-1], staged.HANDS_METRES[1] + .01)
        self.assertGreater(apart[0], .8)
        hips = numpy.linalg.norm((leader - follower)[:, 0] * FLOOR, axis=1)
        self.assertGreater(hips[0] - hips[-1], 2 * staged.LEAST_WALK_METRES)
        self.assertTrue((leader[-1] == leader[-10]).all())
        arm = [JOINTS.index("RElbow"), JOINTS.index("RWrist")]
        lengths = numpy.linalg.norm(leader[:, arm[1]] - leader[:, arm[0]], axis=1)
        self.assertLess(numpy.ptp(lengths), 1e-6)
        self.assertIsNone(staged.approach(person(150), 60, JOINTS, self.random))

    def test_hands_meet_where_one_person_reaches_farthest(self):
        leader = person(120)
        hand = JOINTS.index("RHand")
        leader[:, hand, 2] += .3 * numpy.sin(numpy.linspace(0, numpy.pi, 120))
        (first, second), = staged.meetings(leader, JOINTS, self.random)
        apart = numpy.linalg.norm((first - second)[:, hand], axis=1)
        # The second person is late by some frames.
        self.assertLess(apart.min(), staged.HANDS_METRES[1] + .02)
        self.assertGreater(apart.max(), .2)
        hips = numpy.linalg.norm((first - second)[:, 0], axis=1)
        self.assertGreater(hips.min(), staged.APART_METRES)

    def test_a_hand_that_is_not_offered_meets_none(self):
        for change in ([0, 1.2, .3], [-.6, 0, .3], [0, 0, -.2]):  # overhead, aside, near the body
            with self.subTest(change):
                leader = person(120)
                leader[:, JOINTS.index("RHand")] = leader[0, JOINTS.index("RHand")] + change
                self.assertEqual(staged.meetings(leader, JOINTS, self.random), [])


@unittest.skipUnless(HAS_NUMPY, "needs python3-numpy")
class MeasureTest(unittest.TestCase):
    """Two people walk side by side, .5 m apart; their hands meet."""

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        out = Path(self.folder.name) / "out"
        leader = person(120, speed=.03)
        self.apart = numpy.array([.5, 0, 0])
        pair = captures.Pair("20_02", (leader, leader + self.apart), 0, (("walk", 0, 4),), ("20_02",))
        dataset_folder.write([pair], JOINTS, PARENTS, 30, out)
        self.data = baselines.read(out)
        self.pair, = self.data.pairs

    def test_the_nearest_follower_of_a_known_leader_is_its_own(self):
        turned = staged._turned
        moved = dataclasses.replace(self.pair, leader=turned(self.pair.leader, 1) + [3, 0, 1],
                                    follower=turned(self.pair.follower, 1) + [3, 0, 1])
        for known in (1, len(JOINTS)):  # the place, the pose
            found = baselines.nearest(moved, [self.pair], 30, moved.follower[0, :known])
            numpy.testing.assert_allclose(found, moved.follower, atol=1e-3)

    def test_the_mean_follower_keeps_its_place(self):
        mean = baselines.class_mean(self.pair, [dataclasses.replace(self.pair, is_symmetric=False)])
        numpy.testing.assert_allclose(mean[:, 0, 2], self.pair.leader[:, 0, 2], atol=.02)
        numpy.testing.assert_allclose(mean[:, 0, 0], 0, atol=.02)  # with the mirrored pair

    def test_figures_of_the_captured_follower_and_of_one_who_stands(self):
        names = self.data.joint_names

        def measured(follower):
            return figures.pair(self.pair.leader, follower, self.pair.follower, names, 30)
        own = measured(self.pair.follower)
        self.assertEqual((own["error_m"], own["held"], own["speed"]), (0, 1, 1))
        self.assertAlmostEqual(own["hands_m"], .1, places=3)
        self.assertLess(own["facing_deg"], .01)
        still = measured(numpy.repeat(self.pair.follower[:1], 120, axis=0))
        self.assertLess(still["held"], .2)
        self.assertGreater(still["distance_m"], 1)
        self.assertEqual(figures.stillness(self.pair.follower[:1].repeat(9, axis=0), names, 30)["speed"], 0)


@unittest.skipUnless(HAS_NUMPY, "needs python3-numpy")
class MakeEverydayTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.out = self.folder / "out"

    def write(self, name, rate, **arrays):
        numpy.savez(self.folder / name, joints=numpy.array(JOINTS), parents=numpy.array(PARENTS),
                    fps=rate, **arrays)
        return str(self.folder / name)

    def make(self, **changed):
        pair = {"a_18_01": person(150), "b_19_01": person(150), **changed}
        (self.folder / "stretches.tsv").write_text(
            "trial\tleader\tclass\tfrom_seconds\tto_seconds\tleft_out\n18_01\ta\tpull\t0\t2.4\tno\n")
        (self.folder / "single.tsv").write_text(
            "key\tclass\tpair_trial\ns_02_01\twalk\t\ns_18_01\ttalk\tyes\n")
        output = io.StringIO()
        with contextlib.redirect_stdout(output), contextlib.redirect_stderr(output):
            code = make_everyday.main([
                "--trials", self.write("trials.npz", 60, **pair),
                "--stretches", str(self.folder / "stretches.tsv"),
                "--single", self.write("single.npz", 30, s_02_01=person(90, .03), s_18_01=person(90)),
                "--table", str(self.folder / "single.tsv"), "--out", str(self.out)])
        return code, output.getvalue()

    def test_writes_two_data_sets(self):
        code, output = self.make()
        self.assertEqual(code, 0, output)
        copies = [f"18_01_copy{i}" for i in range(2, make_everyday.CLASS_WINDOWS + 1)]
        for name, staged_pairs in (("first", ["meet_hands_s_02_01_up_1", "walk_s_02_01"]),
                                   ("second", ["walk_s_02_01"])):
            files = sorted((self.out / name / "pairs").iterdir())
            self.assertEqual([file.stem for file in files], sorted(["18_01", *copies, *staged_pairs]))
            lines = files[0].read_text().splitlines()
            self.assertEqual(len(lines), 72)
            self.assertEqual(len(lines[0].split(",")), 1 + 2 * 22 * 3)
        self.assertIn("pairs/18_01.txt\tpull\t0.000\t2.400",
                      (self.out / "second/labels.tsv").read_text())
        self.assertIn("pairs/18_01.txt\tleft\t18_01", (self.out / "first/index.tsv").read_text())
        layout = json.loads((self.out / "first/dataset.json").read_text())
        names = layout["skeleton"]["joint_names"]
        self.assertEqual(sorted(joint for part in layout["skeleton"]["parts"]
                                for joint in part["joints"]), sorted(names))

    def test_wrong_arrays_are_named(self):
        wrong = person(150)
        wrong[7, 0, 0] = numpy.nan
        for changed, message in (({"a_18_01": wrong}, "a_18_01: expected finite numbers"),
                                 ({"a_18_01": numpy.zeros((150, 3))}, "a_18_01: expected shape")):
            with self.subTest(message):
                code, output = self.make(**changed)
                self.assertEqual(code, 1)
                self.assertIn(message, output)


class ConfigurationsTest(unittest.TestCase):
    def test_change_settings_that_the_trainer_has(self):
        training = Path(__file__).resolve().parents[3] / "model/training"
        declared = ((training / "settings.proto").read_text(encoding="utf-8") +
                    (training / "configs/flow.json").read_text(encoding="utf-8"))
        files = sorted((Path(__file__).resolve().parents[1] / "configs").glob("*.json"))
        self.assertEqual([file.stem for file in files], ["first", "second", "third"])
        for file in files:
            changed = json.loads(file.read_text(encoding="utf-8"))
            self.assertTrue((training / f"configs/{changed['base']}.json").exists())
            for path in changed["set"]:
                for key in path.split("."):
                    self.assertRegex(declared, rf' {key} = |"{key}":', f"{file.name}: {path}")


if __name__ == "__main__":
    unittest.main()
