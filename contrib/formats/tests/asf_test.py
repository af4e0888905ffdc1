"""duet_asf.py: the places of joints, errors, and what Duet reads of the BVH."""

import math
import pathlib
import random
import sys
import tempfile
import unittest

import numpy as np

FOLDER = pathlib.Path(__file__).resolve().parents[1] / "asf"
sys.path.insert(0, str(FOLDER))
import duet_asf  # noqa: E402

UNIT = 2.54 / 0.45  # centimetres
FRAMES = 12
# Bone, parent, end of the bone from its start in metres, rotations.
_SIDE = (("hipjoint", "root", (.1, -.05, 0), ""), ("femur", "hipjoint", (0, -.42, 0), "rx ry rz"),
         ("tibia", "femur", (0, -.4, 0), "rx"), ("foot", "tibia", (0, -.04, .14), "rx rz"),
         ("clavicle", "thorax", (.17, .05, 0), "ry rz"), ("humerus", "clavicle", (.29, 0, 0), "rz rx ry"),
         ("radius", "humerus", (.25, 0, 0), "rx"), ("hand", "radius", (.08, 0, 0), "rx rz"))
_MIDDLE = (("lowerback", "root", (0, .14, 0), "rx ry rz"), ("upperback", "lowerback", (0, .14, 0), "rx ry rz"),
           ("thorax", "upperback", (0, .14, 0), "rx ry rz"), ("neck", "thorax", (0, .1, 0), "rx ry rz"),
           ("head", "neck", (0, .1, 0), "rx ry rz"))


def bones():
    found = list(_MIDDLE)
    for side, sign in (("l", 1), ("r", -1)):
        for name, parent, (x, y, z), freedoms in _SIDE:
            found.append((side + name, parent if parent in ("root", "thorax") else side + parent,
                          (sign * x, y, z), freedoms))
    return found


def asf():
    lines = [":version 1.10", ":units", "  mass 1.0", "  length 0.45", "  angle deg", ":root",
             "  order TX TY TZ RX RY RZ", "  axis XYZ", "  position 0 0 0", "  orientation 0 0 0", ":bonedata"]
    for number, (name, _, end, freedoms) in enumerate(bones()):
        length = math.hypot(*end)
        lines += ["  begin", f"    id {number}", f"    name {name}",
                  "    direction " + " ".join(f"{value / length:.9f}" for value in end),
                  f"    length {100 * length / UNIT:.9f}", f"    axis {10 + 3 * number} {5 * number} -20 XYZ"]
        lines += [f"    dof {freedoms}", "    limits (-160.0 20.0)"] if freedoms else []
        lines.append("  end")
    lines += [":hierarchy", "  begin"]
    for parent in ["root"] + [name for name, *_ in bones()]:
        children = [name for name, above, *_ in bones() if above == parent]
        lines += [" ".join([" ", parent, *children])] if children else []
    return "\n".join(lines + ["  end", ""])


def amc():
    lines = ["#!OML:ASF made.asf", ":FULLY-SPECIFIED", ":DEGREES"]
    for frame in range(FRAMES):
        lines += [str(frame + 1), f"root {frame} 17 {-frame} {3 * frame} {90 + frame} 0"]
        for number, (name, _, _, freedoms) in enumerate(bones()):
            values = [25 * math.sin(0.7 * number + 0.4 * frame + i) for i in range(len(freedoms.split()))]
            lines += [name + "".join(f" {value:.6f}" for value in values)] if values else []
    return "\n".join(lines) + "\n"


class AsfTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def write(self, name, text):
        (self.folder / name).write_text(text, encoding="utf-8")
        return self.folder / name

    def read(self, skeleton=None, motion=None):
        parsed = duet_asf.read_skeleton(self.write("a.asf", skeleton or asf()))
        return parsed, *duet_asf.read_motion(self.write("a.amc", motion or amc()), parsed)

    def test_bones_keep_their_lengths_and_turn_about_their_own_axes(self):
        skeleton, root, rotations = self.read()
        at = duet_asf.joint_positions(skeleton, root, rotations)
        for name, parent, end, _ in bones():
            starts = [child for child, above, *_ in bones() if above == name] or [f"{name}.end"]
            np.testing.assert_allclose(np.linalg.norm(at[starts[0]] - at[name], axis=-1), 100 * math.hypot(*end),
                                       rtol=1e-6)
        np.testing.assert_allclose(at["root"][3], np.array([3, 17, -3]) * UNIT)
        # Positions by an independent reader in C++, which this program replaced.
        for name, metres in {"head": (0.53212, 1.37556, -0.44345), "lhand": (0.20065, 1.4013, -1.13607),
                             "rfoot": (0.24551, 0.44215, 0.0253)}.items():
            np.testing.assert_allclose(at[name][11] / 100, metres, atol=1e-4)

    def test_radians_are_read(self):
        skeleton, root, rotations = self.read()
        lines = []
        for line in amc().replace(":DEGREES", ":RADIANS").splitlines():
            words = line.split()
            if len(words) > 1 and not line.startswith("#"):
                moves = 3 if words[0] == "root" else 0
                words[1 + moves:] = [str(math.radians(float(word))) for word in words[1 + moves:]]
            lines.append(" ".join(words))
        _, _, again = self.read(motion="\n".join(lines))
        np.testing.assert_allclose(again, rotations, atol=1e-6)

    def test_bvh_has_the_same_joints(self):
        skeleton, root, rotations = self.read()
        at = duet_asf.joint_positions(skeleton, root, rotations)
        text = duet_asf.to_bvh(skeleton, root, rotations, 60)
        self.assertIn(f"Frame Time: {1 / 60:.9f}", text)
        for name, positions in play_bvh(text).items():
            np.testing.assert_allclose(positions, at[name], atol=0.01, err_msg=name)

    def test_finds_the_skeleton_of_the_motion_or_its_subject(self):
        with self.assertRaisesRegex(duet_asf.FileError, "expected 01_02.asf or 01.asf in the same folder"):
            duet_asf.skeleton_of(self.folder / "01_02.amc")
        self.assertEqual(self.write("01.asf", ""), duet_asf.skeleton_of(self.folder / "01_02.amc"))
        self.assertEqual(self.write("01_02.asf", ""), duet_asf.skeleton_of(self.folder / "01_02.amc"))

    def test_errors_name_the_line(self):
        for skeleton, motion, error in (
                (asf().replace("id 0", "id 0\n    direction 1 x 0"), None, r"a.asf:\d+: direction: expected 3 numbers"),
                (asf().replace("dof rx ry rz", "dof rx rx"), None, "dof: expected rx ry rz, each at most once"),
                (asf().replace("  root ", "  root nobody "), None, "hierarchy: expected a bone, got 'nobody'"),
                (asf().replace(" lowerback lhipjoint", " lhipjoint"), None, "bones below the root"),
                ("HIERARCHY\n", None, "is this an ASF file"),
                (None, amc().replace("\nhead", "\nskull", 1), r"a.amc:\d+: .*got 'skull'"),
                (None, amc().replace("\nhead ", "\nhead 1 ", 1), "head: expected 3 numbers"),
                (None, "\n".join(line for line in amc().splitlines() if not line.startswith("neck")),
                 "frame 1: expected values for 'neck'"),
                (None, "#nothing\n", "expected at least 1 frame")):
            with self.subTest(error), self.assertRaisesRegex(duet_asf.FileError, error):
                self.read(skeleton, motion)

    def test_damaged_files_are_errors_at_worst(self):
        chance = random.Random(3)
        refused = 0
        for _ in range(200):
            texts = []
            for text in (asf(), amc()):
                at = chance.randrange(len(text))
                texts.append(text[:at] + chance.choice("0123456789-e. \n:abtrxyz") + text[at + chance.randrange(3):])
            try:
                self.assertTrue(np.isfinite(self.read(*texts)[2]).all())
            except duet_asf.FileError:
                refused += 1
        self.assertGreater(refused, 40)


def play_bvh(text):
    """``{joint: [frames, 3]}`` by forward kinematics."""
    words = iter(text.split())
    stack, joints, channels = [], [], 0
    for word in words:
        if word in ("ROOT", "JOINT"):
            joints.append([next(words), stack[-1] if stack else None, None, channels])
            channels += 3 if stack else 6
        elif word == "End":
            next(words)
            joints.append([joints[stack[-1]][0] + ".end", stack[-1], None, None])
        elif word == "{":
            stack.append(len(joints) - 1)
        elif word == "}":
            stack.pop()
        elif word == "OFFSET":
            joints[-1][2] = np.array([float(next(words)) for _ in range(3)])
        elif word == "MOTION":
            break
    rows = np.array([line.split() for line in text.split("MOTION")[1].splitlines()[3:]], dtype=float)
    at, world = {}, []
    for name, parent, offset, channel in joints:
        local = np.eye(3) * np.ones((len(rows), 1, 1))
        if channel is not None:
            angles = np.radians(rows[:, channel + (3 if parent is None else 0):][:, :3])
            local = np.array([duet_asf.turn([0, 1, 2], row[::-1]) for row in angles])
        place = rows[:, :3] if parent is None else at[joints[parent][0]] + world[parent] @ offset
        at[name] = place
        world.append(local if parent is None else world[parent] @ local)
    return at


if __name__ == "__main__":
    unittest.main()
