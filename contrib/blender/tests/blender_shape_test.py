"""The Blender add-on's tools for shaping an answer: gallery, label curves, pins, the user's armature,
other models."""

import json
import math
import pathlib
import re
import shutil
import tempfile
import unittest

import tools

BLENDER = shutil.which("blender")
SHAPE = pathlib.Path(__file__).parent / "in_blender" / "shape.py"
REACHED = 0.01  # metres


class BlenderShapeTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        with tools.running_server() as server:
            models = tools.duet("models", "--json", "--server", server.address)
            salsa = next(model for model in json.loads(models.stdout)["models"]
                         if model["name"] == "salsa")
            (cls.folder / "salsa.json").write_text(json.dumps(salsa), encoding="utf-8")
            cls.convert("hug", "leader.glb")
            cls.convert("salsa", "dancer.glb", "--skeleton", cls.folder / "salsa.json")
            done = tools.run(BLENDER, "--background", "--factory-startup", "--python-exit-code",
                             "1", "--python", SHAPE, "--", tools.SOURCE / "contrib" / "blender",
                             cls.folder / "leader.glb", cls.folder / "dancer.glb", server.address,
                             tools.PROGRAMS / "duet", cls.folder, timeout=4 * tools.RUN_SECONDS)
        assert done.returncode == 0, done.stdout + done.stderr
        cls.state = json.loads((cls.folder / "state.json").read_text(encoding="utf-8"))

    @classmethod
    def convert(cls, sample, out, *flags):
        done = tools.duet("convert", tools.sample(sample), *flags, "--out", cls.folder / out)
        assert done.returncode == 0, done.stderr

    def assert_near(self, place, expected, metres=REACHED):
        distance = sum((a - b) ** 2 for a, b in zip(place, expected)) ** 0.5
        self.assertLess(distance, metres)

    # Gallery.

    def test_gallery_lists_eight_seeds_with_grades_best_first(self):
        first = min(self.state["seeds"])  # the server's choice
        self.assertEqual(sorted(self.state["seeds"]), list(range(first, first + 8)))
        self.assertEqual(self.state["faults"], sorted(self.state["faults"]))
        for grade in self.state["grades"]:
            self.assertRegex(grade, r"^(no faults|(twist|overlap|slide) \d+ %)$")

    def test_chosen_answer_replaces_the_partner(self):
        for shown, index in zip(self.state["shown"], (0, 3), strict=True):
            self.assertEqual(shown["chosen"], index)
            self.assertEqual(shown["kept"], [True, self.state["seeds"][index]])
            self.assertIn(f"seed {self.state['seeds'][index]}", shown["state"])
            self.assertEqual(shown["followers"], 2)  # the leader's and the partner's armature
            self.assert_near(shown["hand"], shown["expected"], 1e-3)
        self.assertIn(f"(seed {self.state['seed_of_take']})", self.state["take"])

    def test_panel_lists_the_answers(self):
        panel = self.state["panel"]
        for seed, grade in zip(self.state["seeds"], self.state["grades"]):
            self.assertIn(f"Seed {seed}, {grade}", panel)
        self.assertLessEqual({"leader", "place", "weight", "duet.key_labels", "duet.react",
                              "duet.show_eight"}, set(panel))

    def test_panels_show_pins_and_settings(self):
        panel = self.state["pin_panel"]
        self.assertEqual([what for what in panel if what in ("joint", "thing", "bone", "softness")],
                         ["joint", "thing", "softness", "joint", "thing", "bone", "softness"])
        self.assertIn("2 key frames, 25 to 45", panel)
        self.assertIn("1 key frame, 50", panel)
        reading, server = self.state["other_panels"]
        self.assertIn("bone", reading)
        self.assertEqual(server, ["server", "program", "model"])

    def test_missing_answers_are_reported(self):
        self.assertIn("expected one of 8, got 8", self.state["no_such_answer"])
        self.assertIn("Press React again", self.state["gone"])

    # Label curves.

    def test_keyed_labels_become_keyframes(self):
        flags = self.state["labels"]
        self.assertEqual(set(flags[::2]), {"--keyframe"})
        first, last = flags[1], flags[-1]
        self.assertTrue(first.startswith("0:"), first)
        self.assertTrue(last.startswith("49:"), last)
        self.assertIn("hug=1,", first)
        self.assertIn("push=0,", first)
        self.assertIn("hug=0,", last)
        self.assertIn("push=1,", last)

    # Pins.

    def test_new_pin_is_where_the_joint_is(self):
        pin = self.state["new_pin"]
        self.assertEqual((pin["joint"], pin["frame"]), ("right_hand", 30))
        self.assert_near(pin["place"], pin["hand"], 1e-4)
        self.assertTrue(self.state["shared"])

    def test_pin_without_key_frames_applies_in_its_own_frame(self):
        pin = self.state["one_pin"]
        self.assert_near(pin["hand"], pin["wanted"])
        self.assertEqual(pin["told"], "All pins reached")

    def test_each_key_frame_is_a_pin(self):
        for frame, wanted in self.state["keyed"].items():
            self.assert_near(self.state["hands"][frame], wanted)

    def test_keyed_bone_and_softness_are_sent_in_metres_with_y_up(self):
        self.assertEqual((self.state["bone_pin"]["bone"], self.state["bone_pin"]["thing"]),
                         ("Head", "Puppet"))
        *hands, head = self.state["constraints_sent"]
        for hand, frame in zip(hands, (14, 34), strict=True):
            self.assertIn(f'joint_name: "right_hand" frame: {frame} ', hand)
        self.assertIn('joint_name: "head" frame: 39 ', head)
        *place, softness = map(float, re.findall(r"(?:x|y|z|softness): (\S+)", head))
        x, y, z = self.state["bone_pin"]["place"]
        self.assert_near(place, (x, z, -y), 1e-4)
        self.assertEqual(softness, 1)
        self.assertRegex(self.state["told"], r"^head at 50: \d+ cm away$")

    def test_unusable_pins_are_reported(self):
        self.assertIn('got "wing"', self.state["wing"])
        self.assertIn("has no key frame from frame 11 to 60", self.state["outside"])
        self.assertIn("has no object", self.state["nothing"])

    # An armature of the user's.

    def test_partner_is_a_copy_of_the_users_armature(self):
        self.assertIn("Choose your armature under Body", self.state["no_armature"])
        self.assertEqual(self.state["copied_bones"], self.state["own_bones"])
        for name, far in self.state["characters"].items():
            for joint in ("left_foot", "right_foot"):
                self.assertLess(far[joint], REACHED, f"{name}: {joint}")
            # Joints of a larger or smaller character are elsewhere.
            self.assertLess(sum(far.values()) / len(far), 0.06 if name == "Usual" else 0.2, name)
        for joint in ("left_hand", "right_hand"):
            self.assertLess(self.state["characters"]["Usual"][joint], 0.04)

    # Other models.

    def test_model_brings_its_classes_and_joints(self):
        self.assertEqual(self.state["salsa"], "")
        self.assertIn("follower_turn", self.state["salsa_classes"])
        self.assertIn("left_toe", self.state["salsa_joints"])
        for joint in self.state["salsa_joints"]:
            self.assertIn(joint, self.state["salsa_bones"])

    def test_dancers_own_rig_follows_with_its_toes(self):
        self.assertEqual(self.state["salsa_rig"], "")
        self.assertEqual(self.state["salsa_rig_bones"], self.state["dancer_bones"])
        for wanted, place in self.state["salsa_rig_places"]:
            self.assertLess(math.dist(wanted, place), 0.05)


if __name__ == "__main__":
    if not BLENDER:
        tools.skip("no blender; install the package blender")
    tools.main()
