import contextlib
import importlib.util
import io
import json
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

HAS_NUMPY = importlib.util.find_spec("numpy") is not None
HAS_MATPLOTLIB = importlib.util.find_spec("matplotlib") is not None

if HAS_NUMPY:
    import make_salsa
    import numpy
    from salsa import dataset_folder, moves, takes

JOINTS = ("Hips", "Spine", "Chest", "Neck", "Head", "HeadTop",
          "LShoulder", "LElbow", "LWrist", "LHand", "RShoulder", "RElbow", "RWrist", "RHand",
          "LHip", "LKnee", "LAnkle", "LToe", "RHip", "RKnee", "RAnkle", "RToe")
PARENTS = (-1, 0, 1, 2, 3, 4, 2, 6, 7, 8, 2, 10, 11, 12, 0, 14, 15, 16, 0, 18, 19, 20)
RATE = 60


def body():
    """A person at the origin who faces +z: [joints, 3], metres."""
    limb = {"Shoulder": (.2, 1.4, 0), "Elbow": (.25, 1.2, .1), "Wrist": (.2, 1.1, .3),
            "Hand": (.2, 1.1, .4), "Hip": (.1, .9, 0), "Knee": (.1, .5, 0), "Ankle": (.1, .1, 0),
            "Toe": (.1, .05, .15)}
    middle = {"Hips": .95, "Spine": 1.1, "Chest": 1.3, "Neck": 1.5, "Head": 1.6, "HeadTop": 1.75}
    pose = []
    for joint in JOINTS:
        if joint in middle:
            pose.append((0, middle[joint], 0))
        else:
            x, y, z = limb[joint[1:]]
            pose.append((x if joint[0] == "L" else -x, y, z))
    return numpy.array(pose, dtype=float)


def people(yaws, places):
    """A body turned by `yaws` (degrees) at `places` ([frames, 2]: x, z)."""
    radians = numpy.radians(yaws)
    cosines, sines = numpy.cos(radians)[:, None], numpy.sin(radians)[:, None]
    pose = body()[None]
    return numpy.stack([cosines * pose[..., 0] + sines * pose[..., 2] + places[:, 0, None],
                        numpy.broadcast_to(pose[..., 1], (len(yaws), len(JOINTS))),
                        cosines * pose[..., 2] - sines * pose[..., 0] + places[:, 1, None]], axis=-1)


def couple(frames, follower_turn=0.0, couple_turn=0.0, distance=0.7):
    """Two people face to face along z; the turns (degrees) go on over all frames."""
    share = numpy.linspace(0, 1, frames)
    angle = numpy.radians(couple_turn * share)
    places = numpy.stack([numpy.sin(angle), numpy.cos(angle)], axis=1) * distance
    lead = people(couple_turn * share, numpy.zeros((frames, 2)))
    follow = people(180 + (couple_turn + follower_turn) * share, places)
    return takes.Take("01", lead, follow, JOINTS, RATE)


@unittest.skipUnless(HAS_NUMPY, "needs python3-numpy")
class MovesTest(unittest.TestCase):
    def classes(self, take):
        return {name for name, mask in moves.classify(take).items() if mask.any()}

    def test_a_couple_that_stands_is_basic(self):
        self.assertEqual(self.classes(couple(120, distance=0.8)), {"basic"})

    def test_a_hand_on_the_back_is_a_closed_hold(self):
        self.assertEqual(self.classes(couple(120, distance=0.5)), {"closed_hold"})

    def test_a_turn_of_the_follower_does_not_count_for_the_lead(self):
        self.assertIn("follower_turn", self.classes(couple(120, follower_turn=360)))
        self.assertNotIn("leader_turn", self.classes(couple(120, follower_turn=360)))

    def test_a_half_turn_is_none(self):
        self.assertNotIn("follower_turn", self.classes(couple(120, follower_turn=180)))

    def test_a_couple_that_turns_as_a_whole_changes_sides(self):
        found = self.classes(couple(120, couple_turn=180))
        self.assertIn("cross_body", found)
        self.assertNotIn("follower_turn", found)

    def test_several_classes_hold_at_once(self):
        masks = moves.classify(couple(180, follower_turn=360, couple_turn=200))
        self.assertTrue((masks["follower_turn"] & masks["cross_body"]).any())

    def test_people_without_contact_are_apart(self):
        self.assertEqual(self.classes(couple(120, distance=2.0)), {"apart"})

    def test_a_dip_has_no_class(self):
        take = couple(240, distance=0.8)
        take.follow[100:160, :, 1] *= 0.6
        masks = moves.classify(take)
        self.assertFalse(any(mask[110:150].any() for mask in masks.values()))
        self.assertTrue(masks["basic"][50])

    def test_spans_are_in_order(self):
        spans = moves.spans(couple(180, follower_turn=360, couple_turn=200))
        self.assertEqual(spans, sorted(spans, key=lambda span: span[1]))


@unittest.skipUnless(HAS_NUMPY, "needs python3-numpy")
class TakesTest(unittest.TestCase):
    def test_short_glitches_are_bridged_and_long_ones_cut(self):
        take = couple(600, distance=0.5)
        take.lead[100] += 0.5
        take.follow[300:320] += 0.5
        prepared = takes.prepare([take], {"01": [(100, 100), (300, 319)]})
        self.assertEqual([one.name for one in prepared], ["01", "01_2"])
        self.assertEqual(prepared[0].frame_rate_hz, 30)
        for one in prepared:
            self.assertLess(numpy.abs(one.lead - one.lead[0]).max(), 0.01)
            self.assertLess(numpy.abs(one.follow - one.follow[0]).max(), 0.01)

    def test_people_stand_on_the_floor(self):
        take = couple(120)
        take.lead[..., 1] += 0.3
        prepared = takes.prepare([take], {})[0]
        toe = prepared.joint("LToe")
        for person in (prepared.lead, prepared.follow):
            self.assertAlmostEqual(person[0, toe, 1], takes.STANDING_TOE_METRES, places=3)

    def test_a_wrong_head_is_rebuilt_from_the_trunk(self):
        wrong = takes.Take("06", *(couple(120).lead.copy(), couple(120).follow.copy()), JOINTS, RATE)
        wrong.lead[:, JOINTS.index("Head")] += 0.4
        prepared = takes.prepare([couple(120), wrong], {})
        numpy.testing.assert_allclose(prepared[1].lead, prepared[0].lead, atol=1e-6)


@unittest.skipUnless(HAS_NUMPY, "needs python3-numpy")
class MakeSalsaTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def archive(self, **changed):
        take = couple(300, follower_turn=360)
        arrays = {"lead_01": take.lead, "follow_01": take.follow, "joints": numpy.array(JOINTS),
                  "parents": numpy.array(PARENTS), "fps": RATE, **changed}
        numpy.savez(self.folder / "takes.npz",
                    **{key: array for key, array in arrays.items() if array is not None})
        return self.folder / "takes.npz"

    def run_script(self, path, *more):
        with contextlib.redirect_stdout(io.StringIO()):
            return make_salsa.main(["--takes", str(path), "--out", str(self.folder / "out"), *more])

    def test_writes_a_data_set(self):
        self.assertEqual(self.run_script(self.archive()), 0)
        out = self.folder / "out"
        layout = json.loads((out / "dataset.json").read_text())
        names = layout["skeleton"]["joint_names"]
        self.assertEqual(len(names), 22)
        self.assertEqual(sorted(joint for part in layout["skeleton"]["parts"]
                                for joint in part["joints"]), sorted(names))
        self.assertIn(["left_elbow", "left_wrist"], layout["skeleton"]["bones"])
        lines = (out / "takes/01.txt").read_text().splitlines()
        self.assertEqual(len(lines), 150)
        self.assertEqual(len(lines[0].split(",")), 1 + 2 * 22 * 3)
        rows = [row.split("\t") for row in (out / "labels.tsv").read_text().splitlines()[1:]]
        self.assertTrue(rows)
        for path, name, begin, end in rows:
            self.assertEqual(path, "takes/01.txt")
            self.assertIn(name, moves.CLASSES)
            self.assertLess(float(begin), float(end))
            self.assertLessEqual(float(end), 5.0)
        self.assertIn("takes/01.txt\tleft\ttake_01", (out / "index.tsv").read_text())

    @unittest.skipUnless(HAS_MATPLOTLIB, "needs python3-matplotlib")
    def test_draws_a_sheet_of_every_class(self):
        self.assertEqual(self.run_script(self.archive(), "--sheets", str(self.folder / "sheets")), 0)
        self.assertEqual(sorted(path.stem for path in (self.folder / "sheets").iterdir()),
                         sorted(moves.CLASSES))

    def test_bad_takes_are_named(self):
        short, wrong = numpy.zeros((5, 22, 3)), numpy.zeros((300, 22, 3))
        wrong[7, 0, 0] = numpy.nan
        for changed, message in (({"follow_01": None}, "follow_01: expected an array"),
                                 ({"follow_01": short}, "follow_01: expected 300 frames"),
                                 ({"lead_01": numpy.zeros((300, 3))}, "lead_01: expected shape"),
                                 ({"lead_01": wrong}, "got another in frame 7"),
                                 ({"fps": None}, "fps: expected"),
                                 ({"lead_01": None}, "lead_NN: expected at least one take")):
            with self.subTest(message), self.assertRaisesRegex(takes.TakesError, message):
                takes.read_archive(self.archive(**changed))

    def test_bad_glitches_are_named(self):
        path = self.folder / "glitches.tsv"
        path.write_text("person\tframes\nlead_01\t5\n", encoding="utf-8")
        with self.assertRaisesRegex(takes.TakesError, "line 2: expected PERSON_NN"):
            takes.read_glitches(path)

    def test_every_joint_has_duets_name(self):
        self.assertEqual([dataset_folder.joint_name(name) for name in ("Hips", "HeadTop", "RToe")],
                         ["hips", "head_top", "right_toe"])


if __name__ == "__main__":
    unittest.main()
