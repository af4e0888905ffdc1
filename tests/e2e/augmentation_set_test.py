"""The synthetic set of the augmentation experiment: from a run's checkpoint through server and
client to duet-eval, on made-up captures."""

import math
import pathlib
import shutil
import tempfile
import unittest

import tools

JOINTS = 15
FRAMES = 20
SEQUENCES_A_CLASS = 4


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


def make_set(run, data, out):
    return tools.run(tools.SOURCE / "scripts" / "augmentation_set.sh", tools.PROGRAMS, run, data, out,
                     "--match", "1", "--mix", "1", timeout=300)


def evaluate(*arguments):
    return tools.run(tools.PROGRAMS / "duet-eval", "augmentation", *arguments, timeout=300)


class AugmentationSetTest(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        folder = pathlib.Path(temporary.name)
        self.data, self.out, self.runs = folder / "data", folder / "set", folder / "runs"
        self.run_folder = self.runs / "half-4"
        write_captures(self.data)
        shutil.copytree(tools.SOURCE / "model" / "checkpoints" / "sbu" / "1",
                        self.run_folder / "checkpoint" / "sbu" / "1")

    def test_the_set_comes_back_through_server_and_client(self):
        made = make_set(self.run_folder, self.data, self.out)
        self.assertEqual(made.returncode, 0, made.stderr)
        followers = sorted(self.out.glob("followers/*.json"))
        self.assertEqual(len(followers), 2 * len(tools.CLASSES))

        # Given again it makes what is missing and leaves the rest as it is.
        followers[0].unlink()
        before = [file.stat().st_mtime_ns for file in followers[1:]]
        again = make_set(self.run_folder, self.data, self.out)
        self.assertEqual(again.returncode, 0, again.stderr)
        self.assertTrue(followers[0].is_file())
        self.assertEqual([file.stat().st_mtime_ns for file in followers[1:]], before)

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

    def test_a_folder_that_is_no_half_is_refused(self):
        made = make_set(self.runs, self.data, self.out)
        self.assertNotEqual(made.returncode, 0)
        self.assertIn("wanted a folder half-<seed>", made.stderr)

    def test_jobs_are_of_one_half(self):
        result = evaluate("--data", self.data, "--write-jobs", self.out, "--seeds", "1,2")
        self.assertNotEqual(result.returncode, 0)
        self.assertIn("--seeds: 2 came, wanted one with --write-jobs", result.stderr)
        self.assertFalse(self.out.exists())


if __name__ == "__main__":
    tools.main()
