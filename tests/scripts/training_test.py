import math
import tempfile
import unittest
from pathlib import Path

from report import training
from report.sections import check_section

HEADER = "epoch,generator,reconstruction,bone,continuity,validation_afd,seconds\n"
VALIDATED = "1,6,5,2,0,0.9,1.5\n2,5,4,1.5,0,0.5,1.5\n3,4,3,1,0,,1.5\n4,3,2,0.5,0,0.6,1.5\n"
PLAIN = "1,6,5,0,0,,2\n2,5,4,0,0,,2\n"


class TrainingTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.file = Path(folder.name) / "log.csv"

    def log(self, text):
        self.file.write_text(text, encoding="utf-8")
        return training.read_log(self.file)

    def problem_with(self, text):
        with self.assertRaises(training.LogError) as raised:
            self.log(text)
        return str(raised.exception)

    def two_runs(self):
        return [("s01", self.log(HEADER + VALIDATED)), ("s02", self.log(HEADER + PLAIN))]

    def test_columns_are_read_by_name(self):
        log = self.log("epoch,bone,adversarial\n1,0.5,nan\n2,,nan\n4,0.25,nan\n")
        self.assertEqual(log.epochs, [1, 2, 4])
        self.assertTrue(math.isnan(log.find("bone")[1]))
        self.assertIsNone(log.find("adversarial"))
        self.assertIsNone(log.find("continuity"))

    def test_errors_name_the_line_and_the_column(self):
        for text, message in (
                ("", "log.csv:1: expected distinct column names"),
                ("bone,generator\n1,2\n", "one of them epoch, got 'bone,generator'"),
                ("epoch,bone,bone\n", "distinct column names"),
                ("epoch,bone\n", "log.csv:2: expected a line for each epoch, got none"),
                ("epoch,bone\n1,2\n2\n", "log.csv:3: expected 2 fields, got 1"),
                ("epoch,bone\n1,much\n", "log.csv:2: bone: expected a number, got 'much'"),
                ("epoch,bone\n1,2\n1,3\n", "log.csv:3: epoch: expected a later one, got 1"),
                ("epoch,bone\n,2\n", "log.csv:2: epoch: expected a later one, got nan")):
            self.assertIn(message, self.problem_with(text))

    def test_one_run_has_its_losses_in_one_figure(self):
        section = training.curves("60_curves", "Curves", self.two_runs()[:1])
        check_section(section)
        self.assertEqual([figure["name"] for figure in section["figures"]],
                         ["60_curves_losses", "60_curves_validation_afd"])
        losses, validation = (figure["plot"] for figure in section["figures"])
        # Continuity is zero throughout; the log has no adversarial column.
        self.assertEqual([series["name"] for series in losses["series"]],
                         ["generator, weighted sum", "reconstruction", "bone lengths"])
        # Epoch 3 was not validated, and the smallest error is at epoch 2.
        self.assertEqual(validation["series"][0], {"name": "s01", "x": [1, 2, 4],
                                                   "y": [0.9, 0.5, 0.6]})
        self.assertEqual(validation["marked_x"], [2])

    def test_epochs_that_score_whole_answers_are_told_apart(self):
        log = self.log("epoch,generator,validation_afd,whole_answers\n1,6,0.3,0\n2,5,0.2,0\n"
                       "3,19,0.5,1\n4,18,0.4,1\n")
        section = training.curves("c", "Curves", [("s01", log)])
        check_section(section)
        losses, validation = (figure["plot"] for figure in section["figures"])
        self.assertEqual(losses["marked_x"], [3])
        self.assertIn("From the dotted line on", section["figures"][0]["caption"])
        # Only these epochs can become the checkpoint.
        self.assertEqual(validation["marked_x"], [4])

    def test_several_runs_have_a_figure_for_each_loss(self):
        section = training.curves("c", "Curves", self.two_runs())
        names = [figure["name"] for figure in section["figures"]]
        self.assertEqual(names, ["c_generator", "c_reconstruction", "c_bone", "c_validation_afd"])
        lines = [[series["name"] for series in figure["plot"]["series"]]
                 for figure in section["figures"]]
        # The second run's bone loss was off, and it held nothing back.
        self.assertEqual(lines, [["s01", "s02"], ["s01", "s02"], ["s01"], ["s01"]])
        self.assertEqual(section["command"],
                         "scripts/training_results.py curves --run s01=RUN s02=RUN")

    def test_tables_show_what_runs_took_and_reached(self):
        took, reached = training.curves("c", "Curves", self.two_runs())["tables"]
        self.assertEqual([row["values"] for row in took["rows"]], [[4, 6, 2], [2, 4, None]])
        self.assertEqual([row["values"] for row in reached["rows"]], [[2, 0.5, 0.5], [4, 0, None]])

    def test_validation_shows_the_last_epoch_of_each_run_and_their_mean(self):
        def log(*errors):
            return self.log("epoch,validation_afd\n"
                            + "".join(f"{i + 1},{e}\n" for i, e in enumerate(errors)))
        section = training.validation("22", "Settings", [
            ("plain", {"s01": log(3, 2), "s02": log(9, 4)}), ("less", {"s01": log(1, 5)})])
        check_section(section)
        first, second = section["tables"]
        self.assertEqual(first["columns"], ["s01", "s02", "mean"])
        self.assertEqual([row["values"] for row in first["rows"]], [[2, 4, 3], [5, None, None]])
        self.assertEqual(second["rows"][0]["values"], [None, None, None])
        self.assertEqual(first["best"], "lowest")

    def test_runs_are_named_by_their_folder_unless_given_a_name(self):
        self.assertEqual(training.parse_run("/runs/s01/")[0], "s01")
        self.assertEqual(training.parse_run("ours=/runs/x"), ("ours", Path("/runs/x")))
        with self.assertRaises(training.LogError):
            training.parse_run("=x")


if __name__ == "__main__":
    unittest.main()
