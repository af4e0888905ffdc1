"""The synthetic set of the augmentation experiment: duet-eval's leaders, answered by duet batch with
recipes/sbu_300.textproto, read by a loader of SBU's layout and by duet-eval, on made-up captures."""

import json
import math
import pathlib
import re
import shutil
import tempfile
import unittest

import tools

JOINTS = 15
TORSO = 2
FRAMES = 20
SEQUENCES_A_CLASS = 4
RECIPE = tools.SOURCE / "recipes" / "sbu_300.textproto"


def person(column, turn, frame):
    """Joints of one person in SBU's normalised unit, swaying; `column` is where it stands."""
    values = []
    for joint in range(JOINTS):
        sway = 0.05 * math.sin(0.3 * frame + joint + turn)
        values += [column + 0.01 * (joint % 3) + sway, 0.2 + 0.04 * joint, 1.5 + sway]
    return values


def write_captures(folder):
    """A folder in SBU's layout, with every class of the model that is served."""
    for number in range(len(tools.CLASSES)):
        for take in range(SEQUENCES_A_CLASS):
            path = folder / "s01s02" / f"{number + 3:02d}" / f"{take + 1:03d}"
            path.mkdir(parents=True)
            lines = []
            for frame in range(FRAMES):
                values = person(0.3, number + take, frame) + person(0.7, 2 * number + take, frame)
                lines.append(",".join(map(str, [frame + 1] + [f"{v:.5f}" for v in values])))
            (path / "skeleton_pos.txt").write_text("\n".join(lines) + "\n", encoding="utf-8")


def read_sbu(folder):
    """As any loader of SBU reads it: path to frames of two people's joints, in its unit."""
    found = {}
    for path in sorted(folder.glob("s[0-9][0-9]s[0-9][0-9]/0[3-8]/[0-9][0-9][0-9]/skeleton_pos.txt")):
        frames = []
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), start=1):
            values = [float(value) for value in line.split(",")]
            assert values[0] == number and len(values) == 1 + 2 * 3 * JOINTS, path
            points = [values[i:i + 3] for i in range(1, len(values), 3)]
            frames.append((points[:JOINTS], points[JOINTS:]))
        found[path.relative_to(folder).as_posix()] = frames
    return found


def metres(point):
    """SBU's own conversion, y up."""
    return [1.28 - 2.56 * point[0], 0.96 - 1.92 * point[1], 1.28 * point[2]]


def rows(path):
    lines = [line.split("\t") for line in path.read_text(encoding="utf-8").splitlines()]
    return [dict(zip(lines[0], line)) for line in lines[1:]]


def make_set(server, out, *leaders):
    return tools.duet("batch", *leaders, "--recipe", RECIPE, "--out", out, "--server",
                      server.address, "--quiet")


def evaluate(*arguments):
    return tools.run(tools.PROGRAMS / "duet-eval", "augmentation", *arguments, timeout=300)


class AugmentationSetTest(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        folder = pathlib.Path(temporary.name)
        self.data, self.jobs, self.out = folder / "data", folder / "jobs", folder / "set"
        self.runs = folder / "runs"
        write_captures(self.data)
        checkpoints = self.runs / "half-4" / "checkpoint"
        shutil.copytree(tools.SOURCE / "model" / "embedded" / "sbu" / "1",
                        checkpoints / "sbu" / "1")
        self.server = tools.Server("--model-repository", checkpoints)
        self.addCleanup(self.server.stop)

    def test_set_is_made_by_server_and_client(self):
        written = evaluate("--data", self.data, "--write-jobs", self.jobs, "--seeds", "4",
                           "--match", "1", "--mix", "1")
        self.assertEqual(written.returncode, 0, written.stderr)
        made = make_set(self.server, self.out, "--manifest", self.jobs / "manifest.tsv")
        self.assertEqual(made.returncode, 0, made.stderr)
        clips = read_sbu(self.out)
        self.assertEqual(sorted(clips), sorted(f"s01s02/0{number}/00{take}/skeleton_pos.txt"
                                               for number in range(3, 9) for take in (1, 2)))
        for row in rows(self.out / "index.tsv"):
            asked = json.loads((self.jobs / row["leader"]).read_text(encoding="utf-8"))
            frames = clips[row["path"]]
            self.assertEqual(len(frames), len(asked["leader"]))
            for frame, joints in zip(frames, asked["leader"]):
                for wanted, came in zip(joints, frame[0]):
                    self.assertLess(math.dist(wanted, metres(came)), 1e-4)
            self.assertLess(math.dist(metres(frames[0][0][TORSO]), metres(frames[0][1][TORSO])), 4)

        common = ["--data", self.data, "--runs", self.runs, "--match", "1", "--mix", "1",
                  "--epochs", "1", "--synthetic", self.out]
        result = evaluate(*common, "--seeds", "4")
        self.assertEqual(result.returncode, 0, result.stderr)
        for row in ("captured", "captured + 1 match + 1 mix", "synthetic alone",
                    "captured + set through the server", "paper: augmented"):
            self.assertIn(f"\n{row} ", result.stdout)

        other = evaluate(*common, "--seeds", "5")
        self.assertNotEqual(other.returncode, 0)
        self.assertIn("half-5", other.stderr)

    def test_captured_leaders_keep_their_side_and_pair(self):
        manifest = self.data / "manifest.tsv"
        manifest.write_text("leader\tside\tlabels\n"
                            "s01s02/03/001/skeleton_pos.txt\tright\tkick=1\n"
                            "s01s02/03/001/skeleton_pos.txt\tleft\thug=1\n", encoding="utf-8")
        made = make_set(self.server, self.out, "--manifest", manifest)
        self.assertEqual(made.returncode, 0, made.stderr)
        clips = read_sbu(self.out)
        captured = read_sbu(self.data)["s01s02/03/001/skeleton_pos.txt"]
        sides = {row["path"]: row["leader_side"] for row in rows(self.out / "index.tsv")}
        self.assertEqual(sides, {"s01s02/03/001/skeleton_pos.txt": "right",
                                 "s01s02/06/001/skeleton_pos.txt": "left"})
        for path, side in sides.items():
            place = 0 if side == "left" else 1
            for wanted, came in zip(captured, clips[path]):
                for one, other in zip(wanted[place], came[place]):
                    self.assertLess(math.dist(one, other), 1e-4)
                self.assertNotEqual(wanted[1 - place], came[1 - place])

    def test_leaders_at_another_rate_are_resampled_to_the_layouts(self):
        made = make_set(self.server, self.out, tools.sample("kick"))
        self.assertEqual(made.returncode, 0, made.stderr)
        clips = read_sbu(self.out)
        self.assertEqual(len(clips), 12)
        self.assertTrue(all(re.match(r"s00s00/0[3-8]/00[12]/", path) for path in clips))
        text = tools.sample("kick").read_text(encoding="utf-8")
        frames = int(re.search(r"Frames:\s*(\d+)", text).group(1))
        seconds = frames * float(re.search(r"Frame Time:\s*(\S+)", text).group(1))
        self.assertNotAlmostEqual(seconds * 15, frames, delta=2)
        for clip in clips.values():
            self.assertAlmostEqual(len(clip), seconds * 15, delta=2)
        self.assertEqual({(row["frames"], float(row["frame_rate_hz"]))
                          for row in rows(self.out / "index.tsv")},
                         {(str(len(clip)), 15.0) for clip in clips.values()})

    def test_write_jobs_rejects_several_seeds(self):
        result = evaluate("--data", self.data, "--write-jobs", self.jobs, "--seeds", "1,2")
        self.assertNotEqual(result.returncode, 0)
        self.assertIn("--seeds: expected one with --write-jobs, got 2", result.stderr)
        self.assertFalse(self.jobs.exists())


if __name__ == "__main__":
    tools.main()
