"""contrib/salsa/make_salsa.py makes a data set from files like those of the CMU motion capture database."""

import importlib.util
import json
import math
import pathlib
import sys
import tempfile
import unittest

import tools

if importlib.util.find_spec("numpy") is None:
    tools.skip("no Python module numpy; install the package python3-numpy")

SCRIPT = tools.SOURCE / "contrib/salsa/make_salsa.py"
UNIT = 0.0254 / 0.45  # metres
FRAMES, RATE = 180, 60
DISTANCE = 0.8  # of the two people, metres

# A made-up person: bone, parent, end of the bone from its start (metres), rotations.
_SIDE = (("hipjoint", "root", (.1, -.05, 0), ""), ("femur", "hipjoint", (0, -.42, 0), "rx ry rz"),
         ("tibia", "femur", (0, -.4, 0), "rx"), ("foot", "tibia", (0, -.04, .14), "rx rz"),
         ("toes", "foot", (0, 0, .07), "rx"), ("clavicle", "thorax", (.17, .05, 0), "ry rz"),
         ("humerus", "clavicle", (.29, 0, 0), "rx ry rz"), ("radius", "humerus", (.19, 0, 0), "rx"),
         ("wrist", "radius", (.09, 0, 0), "ry"), ("hand", "wrist", (.04, 0, 0), "rx rz"),
         ("fingers", "hand", (.03, 0, 0), "rx"), ("thumb", "wrist", (.04, 0, .04), "rx rz"))
_MIDDLE = tuple((name, parent, (0, height, 0), "rx ry rz") for name, parent, height in (
    ("lowerback", "root", .12), ("upperback", "lowerback", .12), ("thorax", "upperback", .12),
    ("lowerneck", "thorax", .09), ("upperneck", "lowerneck", .09), ("head", "upperneck", .1)))


def bones():
    found = list(_MIDDLE)
    for side, sign in (("l", 1), ("r", -1)):
        for name, parent, (x, y, z), rotations in _SIDE:
            is_middle = parent in ("root", "thorax")
            found.append((side + name, parent if is_middle else side + parent,
                          (sign * x, y, z), rotations))
    return found


def skeleton():
    lines = [":version 1.10", ":name made", ":units", "  mass 1.0", "  length 0.45", "  angle deg",
             ":root", "  order TX TY TZ RX RY RZ", "  axis XYZ", "  position 0 0 0",
             "  orientation 0 0 0", ":bonedata"]
    for name, _, end, rotations in bones():
        length = math.hypot(*end)
        lines += ["  begin", f"    name {name}",
                  "    direction " + " ".join(f"{value / length:.6f}" for value in end),
                  f"    length {length / UNIT:.6f}", "    axis 0 0 0 XYZ"]
        lines += [f"    dof {rotations}"] if rotations else []
        lines.append("  end")
    lines += [":hierarchy", "  begin"]
    for parent in ["root"] + [bone[0] for bone in bones()]:
        children = [bone[0] for bone in bones() if bone[1] == parent]
        lines += [" ".join(["   ", parent, *children])] if children else []
    return "\n".join(lines + ["  end", ""])


def motion(z, yaw, frames=FRAMES):
    """A person at `z` metres whose arms hang and whose hips rise."""
    posed = {"lhumerus": "0 0 -60", "rhumerus": "0 0 60"}
    lines = ["#!made", ":FULLY-SPECIFIED", ":DEGREES"]
    for t in range(frames):
        lines += [str(t + 1), f"root 0 {(.92 + .0001 * t) / UNIT:.6f} {z / UNIT:.6f} 0 {yaw} 0"]
        lines += [f"{name} {posed.get(name, ' '.join('0' for _ in rotations.split()))}"
                  for name, _, _, rotations in bones() if rotations]
    return "\n".join(lines) + "\n"


class SalsaDataTest(unittest.TestCase):

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.files = self.folder / "cmu"
        self.files.mkdir()
        self.write("60.asf", skeleton())
        self.write("61.asf", skeleton())
        self.write("60_03.amc", motion(0, 0))
        self.write("61_03.amc", motion(DISTANCE, 180))

    def write(self, name, text):
        (self.files / name).write_text(text, encoding="utf-8")

    def make(self, *more, duet=tools.PROGRAMS / "duet"):
        return tools.run(sys.executable, "-B", SCRIPT, "--cmu", self.files, "--duet", duet,
                         "--out", self.folder / "salsa", *more)

    def refused(self, *more, **options):
        done = self.make(*more, **options)
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertFalse((self.folder / "salsa").exists())
        return done.stderr

    def frames(self):
        """[frame][joint] of the lead, and of the follower."""
        names = json.loads((self.folder / "salsa/dataset.json").read_text())["skeleton"]["joint_names"]
        for line in (self.folder / "salsa/takes/03.txt").read_text().splitlines():
            values = [float(value) for value in line.split(",")[1:]]
            joints = [values[i:i + 3] for i in range(0, len(values), 3)]
            yield dict(zip(names, joints)), dict(zip(names, joints[len(names):]))

    def test_both_people_keep_their_places_in_metres(self):
        done = self.make()
        self.assertEqual(done.returncode, 0, done.stderr)
        frames = list(self.frames())
        self.assertEqual(len(frames), FRAMES // 2)
        lead, follow = frames[45]
        for joint, place in (("hips", (0, 0)), ("spine", (0, .12)), ("head_top", (0, .64)),
                             ("left_shoulder", (.17, .41)), ("right_hip", (-.1, -.05)),
                             ("left_ankle", (.1, -.87))):
            self.assertAlmostEqual(lead[joint][0], place[0], delta=.002, msg=joint)
            self.assertAlmostEqual(lead[joint][1] - lead["hips"][1], place[1], delta=.002, msg=joint)
        for axis, apart in ((0, 0), (2, DISTANCE)):
            self.assertAlmostEqual(follow["hips"][axis] - lead["hips"][axis], apart, delta=.002)
        # The follower faces the lead, so that its left is the lead's right.
        self.assertAlmostEqual(follow["left_hip"][0], -.1, delta=.002)
        # Both stand on the floor, toes slightly above it.
        self.assertLess(abs(min(lead["left_toe"][1], follow["left_toe"][1])), .03)

    def test_the_data_set_has_the_takes_as_subjects(self):
        self.assertEqual(self.make().returncode, 0)
        index = (self.folder / "salsa/index.tsv").read_text().splitlines()
        self.assertEqual(index[1:], ["takes/03.txt\tleft\ttake_03"])

    def test_a_slightly_longer_partner_is_cut(self):
        self.write("61_03.amc", motion(DISTANCE, 180, FRAMES - 4))
        self.assertEqual(self.make().returncode, 0)
        self.assertEqual(len(list(self.frames())), (FRAMES - 4) // 2)

    def test_a_data_set_is_not_overwritten(self):
        self.assertEqual(self.make().returncode, 0)
        done = self.make()
        self.assertEqual(done.returncode, 2)
        self.assertIn("expected a new folder", done.stderr)

    def test_a_much_shorter_partner_is_named(self):
        self.write("61_03.amc", motion(DISTANCE, 180, FRAMES - 60))
        self.assertIn("61_03.amc: expected 180 frames, as 60_03.amc has, got 120", self.refused())

    def test_a_missing_partner_is_named(self):
        (self.files / "61_03.amc").unlink()
        self.assertIn("61_03.amc: expected a file, as the partner's exists, got none",
                      self.refused())

    def test_an_empty_folder_is_named(self):
        for file in self.files.iterdir():
            file.unlink()
        self.assertIn("expected 60_NN.amc and 61_NN.amc, got neither", self.refused())

    def test_a_broken_file_is_named_with_its_line(self):
        text = motion(0, 0)
        line = text.splitlines().index("lowerneck 0 0 0") + 1
        self.write("60_03.amc", text.replace("lowerneck 0 0 0", "lowerneck 0 much 0", 1))
        self.assertRegex(self.refused(), rf"60_03\.amc:{line}: .*lowerneck.*: expected .*, got")

    def test_half_a_file_is_named_with_its_line(self):
        text = motion(0, 0)
        self.write("60_03.amc", text[:len(text) // 2])
        self.assertRegex(self.refused(), r"60_03\.amc:\d+: .*expected")

    def test_a_skeleton_without_a_joint_is_named(self):
        self.write("61.asf", skeleton().replace("rwrist", "rpalm"))
        self.write("61_03.amc", motion(DISTANCE, 180).replace("rwrist", "rpalm"))
        self.assertIn("rwrist", self.refused())

    def test_a_missing_program_is_named(self):
        self.assertIn("--duet: expected the program duet, got nowhere", self.refused(duet="nowhere"))


if __name__ == "__main__":
    tools.main()
