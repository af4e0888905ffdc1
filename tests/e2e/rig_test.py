"""`duet synthesize --follower-rig`: rigs with unknown joint names, and joint maps for them."""

import re

import tools

ADVICE = "--follower-rig-joint-map-file FILE"


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

    def synthesize(self, out, *flags, leader=None):
        return tools.run(tools.PROGRAMS / "duet", "synthesize", "--server", self.server.address,
                         "--leader", leader or self.leader, "--label", "kick=1", "--out",
                         self.folder / out, *flags)

    def motion_of(self, file):
        """The channel values, which are the same whatever joints are called."""
        return (self.folder / file).read_text(encoding="utf-8").partition("MOTION")[2]

    def test_unknown_joint_names_are_rejected_with_the_flag_to_use(self):
        done = self.synthesize("refused.bvh", "--follower-rig", self.rig)
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("strange.bvh", done.stderr)
        self.assertIn(ADVICE, done.stderr)
        self.assertFalse((self.folder / "refused.follower.bvh").exists())

    def test_joint_map_file_maps_the_joints(self):
        self.synthesize("known.bvh", "--follower-rig", self.leader).check_returncode()
        done = self.synthesize("told.bvh", "--follower-rig", self.rig,
                               "--follower-rig-joint-map-file", self.table)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.motion_of("told.follower.bvh"), self.motion_of("known.follower.bvh"))
        self.assertIn("JOINT Part1", (self.folder / "told.follower.bvh").read_text(encoding="utf-8"))

    def test_joint_map_flags_override_the_file(self):
        spoilt = self.folder / "spoilt.txt"
        spoilt.write_text(self.table.read_text(encoding="utf-8").replace(
            f"left_hand = {self.strange['left_hand']}", "left_hand = Nowhere"), encoding="utf-8")
        flags = ("--follower-rig", self.rig, "--follower-rig-joint-map-file", spoilt)
        done = self.synthesize("spoilt.bvh", *flags)
        self.assertIn("left_hand=Nowhere", done.stderr)
        done = self.synthesize("mended.bvh", *flags, "--follower-rig-joint-map",
                               f"left_hand={self.strange['left_hand']}")
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_leaders_rig_uses_the_leaders_joint_map(self):
        done = self.synthesize("own.bvh", "--follower-rig", "leader", leader=self.rig)
        self.assertIn("--joint-map-file FILE", done.stderr)
        done = self.synthesize("own.bvh", "--follower-rig", "leader", "--joint-map-file", self.table,
                               leader=self.rig)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("ROOT Part0", (self.folder / "own.follower.bvh").read_text(encoding="utf-8"))

    def test_joint_map_without_a_rig_is_rejected(self):
        for flags in ((), ("--follower-rig", "leader")):
            done = self.synthesize("mistake.bvh", "--follower-rig-joint-map-file", self.table, *flags)
            self.assertIn("--follower-rig-joint-map-file: is only valid with --follower-rig FILE", done.stderr)
        done = self.synthesize("mistake.bvh", "--follower-rig", self.rig,
                               "--follower-rig-joint-map-file", self.folder / "nowhere.txt")
        self.assertIn("nowhere.txt: no such file", done.stderr)

    def test_keys_between_frames_raise_rate_and_frame_count(self):
        self.synthesize("plain.bvh").check_returncode()
        self.synthesize("fine.bvh", "--bvh-keys-per-frame", "4").check_returncode()
        counts = [[int(re.search(r"Frames: (\d+)", text)[1]),
                   float(re.search(r"Frame Time: (\S+)", text)[1])]
                  for text in map(self.motion_of, ("plain.follower.bvh", "fine.follower.bvh"))]
        (frames, step), (keys, finer) = counts
        self.assertEqual(keys, 4 * (frames - 1) + 1)
        self.assertAlmostEqual(finer, step / 4, places=7)
        plain, fine = ([line.split() for line in self.motion_of(file).splitlines()[3:]]
                       for file in ("plain.follower.bvh", "fine.follower.bvh"))
        # Every fourth key is a frame, up to whole turns.
        for frame, key in zip(plain, fine[::4]):
            for a, b in zip(frame[:3], key[:3]):
                self.assertAlmostEqual(float(a), float(b), places=3)


if __name__ == "__main__":
    tools.main()
