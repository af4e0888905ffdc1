import contextlib
import io
import json
import tempfile
import unittest
from pathlib import Path
from unittest import mock

import make_report
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

    def make(self):
        err = io.StringIO()
        with contextlib.redirect_stderr(err), contextlib.redirect_stdout(io.StringIO()):
            code = make_report.main(["--results", str(self.results), "--out", str(self.out)])
        return code, err.getvalue()

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


if __name__ == "__main__":
    unittest.main()
