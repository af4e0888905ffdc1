import contextlib
import io
import json
import tempfile
import unittest
from pathlib import Path
from unittest import mock

import make_report
import training_results
import report_example as example
from report import plots


class MakeReportTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.results, self.out = self.folder / "results", self.folder / "report"
        self.results.mkdir()

    def write(self, section):
        (self.results / f"{section['id']}.json").write_text(json.dumps(section), encoding="utf-8")

    def run_program(self, program, *words):
        err = io.StringIO()
        with contextlib.redirect_stderr(err), contextlib.redirect_stdout(io.StringIO()):
            code = program.main([*map(str, words)])
        return code, err.getvalue()

    def make(self):
        return self.run_program(make_report, "--results", self.results, "--out", self.out)

    def test_without_matplotlib_the_report_has_its_tables(self):
        self.write(example.section())
        with mock.patch.object(plots, "use_matplotlib", side_effect=ImportError("no matplotlib")):
            code, err = self.make()
        self.assertEqual(code, 0)
        self.assertIn("no matplotlib (Debian: python3-matplotlib", err)
        self.assertIn("**Table 1.", (self.out / "report.md").read_text())

    def test_an_invalid_folder_is_an_error(self):
        code, err = self.make()
        self.assertEqual(code, 1)
        self.assertIn("no .json file", err)
        self.assertFalse(self.out.exists())

    def test_training_logs_become_sections(self):
        run = self.folder / "runs" / "s01"
        run.mkdir(parents=True)
        (run / "log.csv").write_text("epoch,bone,validation_afd\n1,2,0.5\n2,1,0.4\n")
        for words in (("curves", "--run", run), ("validation", "--runs", f"a={run.parent}")):
            self.assertEqual(
                self.run_program(training_results, *words, "--out", self.results), (0, ""))
        with mock.patch.object(plots, "use_matplotlib", side_effect=ImportError):
            self.assertEqual(self.make()[0], 0)
        self.assertIn("Settings compared", (self.out / "report.md").read_text())

    def test_a_missing_run_is_named(self):
        code, err = self.run_program(training_results, "curves", "--run", self.folder / "absent")
        self.assertEqual(code, 1)
        self.assertIn("absent/log.csv", err)


if __name__ == "__main__":
    unittest.main()
