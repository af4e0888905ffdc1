"""`duet convert --rig` with the followers of answers: unknown joint names, joint maps, rigs of other shapes."""

import json
import re

import numpy as np
import tools

ADVICE = "--rig-joint-map FILE"
MIXAMO = {"hips": "Hips", "spine": "Spine", "chest": "Spine2", "neck": "Neck", "head": "Head",
          "head_top": "HeadTop_End"}
for side in ("left", "right"):
    for joint, name in (("shoulder", "Arm"), ("elbow", "ForeArm"), ("wrist", "Hand"),
                        ("hand", "HandMiddle1"), ("hip", "UpLeg"), ("knee", "Leg"), ("ankle", "Foot"),
                        ("toe", "ToeBase")):
        MIXAMO[f"{side}_{joint}"] = side.capitalize() + name


class RigTest(tools.ServedTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.leader = tools.sample("kick")
        text = cls.leader.read_text(encoding="utf-8")
        names = re.findall(r"(?:ROOT|JOINT) (\S+)", text)
        cls.strange = {name: f"Part{i}" for i, name in enumerate(names)}
        cls.rig = cls.folder / "strange.bvh"
        cls.rig.write_text(re.sub(r"(ROOT|JOINT) (\S+)", lambda line: f"{line[1]} {cls.strange[line[2]]}",
                                  text), encoding="utf-8")
        cls.table = cls.folder / "joints.txt"
        cls.table.write_text("# model joint = joint of the file\n" + "".join(
            f"{name} = {part}\n" for name, part in cls.strange.items() if "_to_" not in name),
            encoding="utf-8")

        cls.kick = cls.answer("kick.json", cls.leader, "--label", "kick=1")
        cls.dance = cls.answer("dance.json", tools.sample("salsa"), "--model", "salsa", "--label", "basic=1")

    @classmethod
    def answer(cls, out, leader, *flags):
        tools.duet("synthesize", "--server", cls.server.address, "--leader", leader, "--out",
                   cls.folder / out, "--quiet", *flags).check_returncode()
        return cls.folder / out

    def convert(self, out, *flags, pair=None):
        """Writes the follower of a pair."""
        return tools.duet("convert", pair or self.kick, "--side", "right", "--out", self.folder / out,
                          *flags)

    def motion_of(self, file):
        """The channel values, which are the same whatever joints are called."""
        return (self.folder / file).read_text(encoding="utf-8").partition("MOTION")[2]

    def test_joint_map_file_maps_the_joints(self):
        self.convert("known.bvh", "--rig", self.leader).check_returncode()
        done = self.convert("told.bvh", "--rig", self.rig, "--rig-joint-map", self.table)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.motion_of("told.bvh"), self.motion_of("known.bvh"))
        self.assertIn("JOINT Part1", (self.folder / "told.bvh").read_text(encoding="utf-8"))

    def dancer(self):
        """The joints' names and the follower of the salsa."""
        pair = json.loads(self.dance.read_text(encoding="utf-8"))
        return pair["joint_names"], np.array(pair["follower"])

    def read(self, file, *flags):
        """The joints' names and the positions of a file of one person."""
        out = self.folder / "read.json"
        done = tools.duet("convert", self.folder / file, "--out", out, "--quiet", *flags)
        self.assertEqual(done.returncode, 0, done.stderr)
        motion = json.loads(out.read_text(encoding="utf-8"))
        return motion["joint_names"], np.array(motion["leader"])

    def test_follower_of_salsa_moves_feet_toes_and_hands_of_a_mixamo_rig(self):
        text = tools.sample("salsa").read_text(encoding="utf-8")
        (self.folder / "mixamo.bvh").write_text(re.sub(
            r"(ROOT|JOINT) (\S+)", lambda line: f"{line[1]} mixamorig:{MIXAMO.get(line[2], line[2])}",
            text), encoding="utf-8")
        done = self.convert("dance.bvh", "--rig", self.folder / "mixamo.bvh", "--skeleton", self.dance,
                            pair=self.dance)
        self.assertEqual(done.returncode, 0, done.stderr)
        names, follower = self.dancer()
        self.assertIn("JOINT mixamorig:LeftToeBase",
                      (self.folder / "dance.bvh").read_text(encoding="utf-8"))
        joints, on_rig = self.read("dance.bvh", "--skeleton", self.dance)
        self.assertEqual(joints, names)
        for side in ("left", "right"):
            start, end = (names.index(f"{side}_{joint}") for joint in ("ankle", "toe"))
            self.assertLess(np.abs(on_rig[:, start] - follower[:, start]).max(), 0.002, side)
            feet = [(motion[:, end] - motion[:, start]) for motion in (on_rig, follower)]
            cosines = np.sum(feet[0] * feet[1], axis=1) / np.prod([np.linalg.norm(foot, axis=1)
                                                                   for foot in feet], axis=0)
            self.assertGreater(cosines.min(), 0.99, side)
            wrist, hand = (names.index(f"{side}_{joint}") for joint in ("wrist", "hand"))
            hands = [(motion[:, hand] - motion[:, wrist]) for motion in (on_rig, follower)]
            self.assertLess(np.abs(hands[0] - hands[1]).max(), 0.03, side)

    def test_follower_of_salsa_stands_on_a_rig_without_toes_and_hands(self):
        self.convert("robot.bvh", "--rig", self.leader, "--skeleton", self.dance,
                     pair=self.dance).check_returncode()
        names, follower = self.dancer()
        joints, on_rig = self.read("robot.bvh")
        self.assertEqual(len(joints), 15)
        for side in ("left", "right"):
            at, wanted = joints.index(f"{side}_foot"), names.index(f"{side}_ankle")
            self.assertLess(np.abs(on_rig[:, at] - follower[:, wanted]).max(), 0.002, side)


if __name__ == "__main__":
    tools.main()
