"""The Blender add-on on a scene whose rate, unit, first frame and axes differ from Duet's."""

import json
import os
import pathlib
import re
import shutil

import tools

BLENDER = shutil.which("blender")
ADD_ON = tools.SOURCE / "contrib" / "blender"
REACT = pathlib.Path(__file__).parent / "in_blender" / "react.py"
UNITS_PER_METRE = 2  # of the scene
# What the preferences' button and check box do.
INSTALL = """
import os
import bpy
bpy.ops.preferences.addon_install(filepath=os.path.abspath("duet_blender.zip"))
bpy.ops.preferences.addon_enable(module="duet_blender")
assert bpy.context.scene.duet.answers is not None
"""


def install(folder):
    """Follows contrib/blender/README.md: zips and installs the add-on. Returns the folder of add-ons."""
    guide = (ADD_ON / "README.md").read_text(encoding="utf-8")
    shutil.copytree(ADD_ON, folder / "contrib" / "blender", ignore=shutil.ignore_patterns("__pycache__"))
    commands = re.search(r"## Installing\n.*?```sh\n(.*?)```", guide, re.DOTALL)[1]
    tools.run("bash", "-e", "-c", commands, cwd=folder).check_returncode()
    scripts = folder / "scripts"
    scripts.mkdir()
    done = tools.run(BLENDER, "--background", "--factory-startup", "--python-exit-code", "1",
                     "--python-expr", INSTALL, cwd=folder / "contrib" / "blender",
                     env={**os.environ, "BLENDER_USER_SCRIPTS": str(scripts)})
    assert done.returncode == 0, done.stdout + done.stderr
    return scripts / "addons"


class BlenderTest(tools.FolderTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        leader = cls.folder / "leader.glb"
        done = tools.duet("convert", tools.sample("kick"), "--out", leader)
        assert done.returncode == 0, done.stderr
        with tools.running_server() as server:
            done = tools.run(BLENDER, "--background", "--factory-startup", "--python-exit-code",
                             "1", "--python", REACT, "--", install(cls.folder),
                             leader, server.address, tools.PROGRAMS / "duet", cls.folder)
        assert done.returncode == 0, done.stdout + done.stderr
        cls.state = json.loads((cls.folder / "state.json").read_text(encoding="utf-8"))

    def test_sliders_match_the_servers_classes(self):
        self.assertEqual(sorted(self.state["known"]), sorted(tools.CLASSES))
        self.assertEqual(sorted(self.state["asked"]), sorted(tools.CLASSES))

    def test_errors_are_reported(self):
        self.assertTrue(self.state["refused_without_leader"])
        self.assertEqual([self.state["still"], self.state["missing"]], [["CANCELLED"]] * 2)
        zero, program, joints = self.state["failures"]
        self.assertIn("expected joints for left_hand, right_hand, got none", joints)
        self.assertIn("Choose the bones in the panel", joints)
        self.assertIn("Every label is 0", zero)
        self.assertIn("no-such-program", program)

    def test_react_replaces_its_last_answer(self):
        self.assertEqual(self.state["again"], ["FINISHED"])
        self.assertEqual(self.state["after_two"], ["Duet follower", "Rig"])

    def test_kept_answer_becomes_a_take(self):
        self.assertEqual(self.state["after_take"],
                         ["Duet follower", f"Duet take 1 (seed {self.state['seed']})", "Rig"])
        self.assertGreater(self.state["seed"], 0)  # it shows the server's choice

    def test_mapped_bones_and_the_leaders_rig_are_used(self):
        self.assertEqual(self.state["unmapped"], ["CANCELLED"])
        self.assertEqual(self.state["own_rig"], ["FINISHED"])
        self.assertEqual(self.state["own_bones"], self.state["leaders_bones"])
        x, y, z = self.state["own_torso"]
        self.assertAlmostEqual(x / UNITS_PER_METRE, 1.2, delta=0.3)
        self.assertAlmostEqual(z / UNITS_PER_METRE, 1.1, delta=0.3)

    def test_bones_without_children_end_in_a_joint(self):
        self.assertEqual(len(self.state["joints"]), 15)
        self.assertTrue(self.state["tails"])

    def test_follower_has_body_and_action(self):
        self.assertEqual(self.state["finished"], ["FINISHED"])
        self.assertEqual(self.state["bones"], 21)
        self.assertGreater(self.state["vertices"], 1000)
        self.assertIn("Duet follower", self.state["materials"])  # in a colour of their own, the same in each answer

    def test_animated_labels_are_sent_as_keyframes(self):
        flags = self.state["flags"]
        self.assertEqual(set(flags[::2]), {"--keyframe"})
        keys = [flag.split(":") for flag in flags[1::2]]
        self.assertEqual([keys[0][0], keys[-1][0]], ["0", "39"])
        self.assertIn("kick=1,", keys[0][1])
        self.assertIn("kick=0,", keys[-1][1])
        self.assertGreater(len(keys), 2)  # Blender eases between its key frames

    def test_the_place_is_sent_in_metres_with_y_up(self):
        flag, place = self.state["place"]
        self.assertEqual(flag, "--follower-start")
        x, y, z = map(float, place.split(","))
        self.assertAlmostEqual(x, 1.2, delta=1e-3)
        self.assertAlmostEqual(y, 1.1, delta=0.15)
        self.assertAlmostEqual(z, 0, delta=1e-3)

    def test_scene_settings_do_not_change(self):
        self.assertEqual(self.state["frame"], 20)
        self.assertEqual(self.state["fps"], 24)
        self.assertEqual(self.state["range"], [11, 50])

    def test_action_covers_the_leaders_frames(self):
        first, last = self.state["keys"]
        self.assertAlmostEqual(first, 11, delta=0.01)
        self.assertAlmostEqual(last, 50, delta=0.01)

    def test_follower_starts_at_the_empty_in_the_scenes_unit(self):
        x, y, z = self.state["torso"][0]
        self.assertAlmostEqual(x / UNITS_PER_METRE, 1.2, delta=0.3)
        self.assertAlmostEqual(y / UNITS_PER_METRE, 0, delta=0.3)
        self.assertAlmostEqual(z / UNITS_PER_METRE, 1.1, delta=0.25)


if __name__ == "__main__":
    if not BLENDER:
        tools.skip("no blender; install the package blender")
    tools.main()
