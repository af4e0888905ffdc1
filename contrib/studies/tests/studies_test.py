"""The studies: their figures on made-up people, and their tables from a real server."""

import json
import os
import pathlib
import sys
import tempfile
import unittest

import numpy as np
import tools

STUDIES = tools.SOURCE / "contrib" / "studies"
os.environ.update(DUET_PROGRAM=str(tools.PROGRAMS / "duet"), PYTHONPATH=str(tools.SOURCE / "client" / "python"))
sys.path[:0] = [str(STUDIES), str(tools.SOURCE / "client" / "python")]
import people  # noqa: E402
import reactions  # noqa: E402
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


class ReactionsTest(unittest.TestCase):
    """Leaders whose hand comes forward for a second, and followers who step back from it."""

    def setUp(self):
        names = ["root", "head", "left_hand", "right_hand", "left_foot", "right_foot"]
        skeleton = {"joint_names": names, "root": "root", "left_foot": "left_foot", "right_foot": "right_foot"}
        self.described = {"frame_rate_hz": 15, "skeleton": skeleton,
                          "classes": [{"name": name} for name in ("push", "hug")]}
        strike = np.exp(-np.square(np.arange(60) / 15 - 2))
        leader, follower = np.zeros((60, 6, 3)), np.zeros((60, 6, 3))
        leader[:, 2, 0] = strike
        follower[:, :, 1] = 0.3  # taller
        self.captures = []
        for index in range(4):
            follower[:, :, 0] = 1.5 + (0.2 + 0.1 * index) * strike[:, np.newaxis]
            self.captures.append(reactions.Capture(index, "push", leader, follower.copy()))

    def figures(self, follower_of, avoiding=0.0):
        """The first figure of every row: of answers as captured, and of padded ones."""
        def ask(capture, leader, weights):
            follower = follower_of(capture) + [avoiding if -1 in weights.values() else 0, 0, 0]
            padding = (len(leader) - len(follower)) // 2
            return np.pad(follower, ((padding, padding), (0, 0), (0, 0)), mode="edge")
        tables = reactions.tables(ask, self.described, self.captures, ["push"])
        return {name: (*values[::3],) for _, rows in tables for name, values in rows}

    def test_captured_follower_reacts_as_captured(self):
        figures = self.figures(lambda capture: capture.follower)
        for name in reactions.FIGURES:
            np.testing.assert_allclose(figures[name], (1, 1), atol=1e-6, err_msg=name)
        self.assertEqual(figures["distance moved"], (0,))

    def test_half_of_a_reaction_has_half_of_the_amplitude(self):
        figures = self.figures(lambda capture: 0.4 * capture.follower)
        np.testing.assert_allclose(figures["amplitude, torso"], (0.4, 0.4), atol=1e-6)
        np.testing.assert_allclose(figures["correlation"], (1, 1), atol=1e-6)
        # Half of the captured mean: only the longest of the four steps still reaches it.
        self.assertEqual(figures["goes back, torso"], (0.25, 0.25))

    def test_follower_who_stands_or_jumps_does_not_react(self):
        jump = np.sin(np.linspace(0, np.pi, 60))[:, np.newaxis, np.newaxis] * [0, 1, 0]
        for moves in (0, jump):
            figures = self.figures(lambda capture, moves=moves: np.repeat(capture.follower[:1], 60, axis=0) + moves)
            for name in reactions.FIGURES:
                np.testing.assert_allclose(figures[name], (0, 0), atol=1e-6, err_msg=name)

    def test_distance_moved_is_that_of_the_avoided_class(self):
        for metres in (0.1, -0.1):
            moved, = self.figures(lambda capture: capture.follower, avoiding=metres)["distance moved"]
            self.assertAlmostEqual(moved, 0.1)

    def test_smoothing_keeps_a_steady_motion(self):
        steady = np.arange(20.0)[:, np.newaxis, np.newaxis] * np.ones((1, 2, 3))
        np.testing.assert_allclose(reactions.without_noise(steady, 15), steady, atol=1e-9)

    def test_an_interval_draws_leaders_with_all_their_rows(self):
        leaders, values = np.repeat([0, 1], 50), np.repeat([0.0, 1.0], 50)
        self.assertEqual(reactions.estimate(leaders, lambda rows: values[rows].mean()).tolist(), [0.5, 0, 1])

    def test_captures_are_spread_over_those_of_a_class(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            described = self.described | {"unit": "metres", "up_axis": "y-up"}
            (folder / "dataset.json").write_text(json.dumps(described), encoding="utf-8")
            (folder / "push").mkdir()
            index = ["path\tleader_side\tsubjects"]
            for number in (3, 2, 1, 0):
                index.append(f"push/{number}.txt\tright\ts0{number % 2},s05")
                np.savetxt(folder / f"push/{number}.txt", [[0] + 18 * [1] + 18 * [2]] * 2, delimiter=",")
            (folder / "index.tsv").write_text("\n".join(index), encoding="utf-8")
            captures = reactions.read_captures(folder, {"s05"}, 2)[1]
            self.assertEqual([capture.index for capture in captures], [0, 2])
            self.assertEqual((captures[0].leader[0, 0, 0], captures[0].follower[0, 0, 0]), (2, 1))
            captures = reactions.read_captures(folder, {"s01"}, 0)[1]
            self.assertEqual([capture.index for capture in captures], [1, 3])
            with self.assertRaisesRegex(ValueError, "--subjects: expected .*, got s09"):
                reactions.read_captures(folder, {"s09"}, 0)


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
