"""The studies: their figures on made-up people, and their tables from a real server."""

import json
import os
import pathlib
import sys
import unittest

import numpy as np
import tools

STUDIES = tools.SOURCE / "contrib" / "studies"
os.environ.update(DUET_PROGRAM=str(tools.PROGRAMS / "duet"), PYTHONPATH=str(tools.SOURCE / "client" / "python"))
sys.path[:0] = [str(STUDIES), str(tools.SOURCE / "client" / "python")]
import people  # noqa: E402
import solver_numbers  # noqa: E402

NAMES = ("neck", "left_hip", "right_hip", "left_hand", "right_hand")


def person(x, yaw, lean=0):
    """Hips, neck and hands of a person who is turned by `yaw` [frames] at x."""
    yaw = np.broadcast_to(yaw, 60)
    across = np.stack([np.cos(yaw), 0 * yaw, np.sin(yaw)], axis=-1)
    middle = np.array([x, 1, 0])
    neck = np.broadcast_to(middle + [np.sin(lean), np.cos(lean), 0], (60, 3))
    return np.stack([neck, middle - 0.1 * across, middle + 0.1 * across,
                     middle - 0.4 * across, middle + 0.4 * across], axis=1)


class FiguresTest(unittest.TestCase):
    def test_figures_of_two_people(self):
        leader, follower = person(0, 0), person(1, 0, lean=0.5)
        self.assertAlmostEqual(people.root_distance(leader, follower, NAMES)[0], 1)
        self.assertAlmostEqual(people.lean_degrees(follower, NAMES)[0], np.degrees(0.5))
        self.assertEqual(people.joint_speed(leader, 30), 0)
        self.assertEqual(people.hands_held(leader, follower, NAMES), 0)
        self.assertEqual(people.hands_held(leader, person(0.9, 0), NAMES), 1)

    def test_turns_are_counted_and_matched(self):
        around = np.linspace(0, 2 * np.pi, 60)
        leader = person(0, 0)
        once = people.turns(leader, person(1, around), NAMES, 30)
        self.assertEqual(len(once), 1)
        self.assertEqual(people.turns(leader, person(1, around / 2), NAMES, 30), [])
        self.assertEqual(people.matched_turns(once, once), 1)
        back = people.turns(leader, person(1, -around), NAMES, 30)
        self.assertEqual(people.matched_turns(once, back), 0)


class SolverNumbersTest(unittest.TestCase):
    def test_constants_are_read_from_the_environment(self):
        text, numbers = solver_numbers.open_numbers(
            "constexpr double kFast = 0.6,\n                 kSlow = 2 * kFast;\nconstexpr Vec3 kUp{0, 1, 0};\n", "steps")
        self.assertEqual(numbers, {"steps.kFast": "0.6", "steps.kSlow": "2 * kFast"})
        self.assertIn('kSlow = static_cast<double>(StudiedNumber("steps.kSlow=", 2 * kFast));', text)
        self.assertIn("constexpr Vec3 kUp", text)

    def test_an_interval_is_of_the_mean_difference(self):
        low, high = solver_numbers.interval(np.tile([[1.0], [3.0]], (20, 1)), np.random.default_rng(0))
        self.assertLess(low[0], 2)
        self.assertGreater(high[0], 2)
        self.assertGreater(low[0], 1.5)


class TablesTest(tools.ServedTest):
    def rows(self, *command):
        result = tools.run(sys.executable, "-B", *command, "--server", self.server.address)
        self.assertEqual(result.returncode, 0, result.stderr)
        return [line.split() for line in result.stdout.splitlines()]

    def test_hour_has_a_row_a_leader(self):
        rows = self.rows(STUDIES / "hour.py", tools.sample("hug"), "--minutes", "0.1")
        self.assertEqual([row[0] for row in rows[1:]], ["idle", "wild", "absent", "teleporting"])
        for row in rows[1:]:
            self.assertEqual(float(row[-1]), 1, "the first minute is the last")

    def test_dance_measures_a_take(self):
        import duet_motion as duet
        leader = duet.read_motion(tools.sample("hug")).resampled(15)
        with duet.Client(self.server.address) as client:
            model = client.get_model()
        leader = leader.select(model.model.joint_names)
        folder = pathlib.Path(self.folder) / "takes"
        folder.mkdir()
        (folder / "dataset.json").write_text(json.dumps(
            {"unit": "metres", "up_axis": "y-up", "frame_rate_hz": 15,
             "skeleton": {"joint_names": leader.joint_names}}), encoding="utf-8")
        (folder / "index.tsv").write_text("path\tleader_side\tsubjects\none.txt\tleft\ta,b\n", encoding="utf-8")
        (folder / "labels.tsv").write_text(
            "path\tclass\tfrom_seconds\tto_seconds\none.txt\thug\t0\t1\none.txt\tpush\t1\t2\n", encoding="utf-8")
        both = np.stack([leader.positions, leader.positions * [-1, 1, -1] + [0, 0, -1.2]], axis=1)
        frames = np.column_stack([np.arange(len(both)), both.reshape(len(both), -1)])
        np.savetxt(folder / "one.txt", frames, delimiter=",")
        rows = self.rows(STUDIES / "dance.py", "--data", folder, "--take", "one.txt", "--seeds", "1")
        self.assertEqual(rows[0], ["error", "distance", "hands", "turns", "matched", "speed"])
        self.assertEqual(rows[1][:2], ["captured", "0.000"])
        self.assertGreater(float(rows[3][1]), 0)


if __name__ == "__main__":
    tools.main()
