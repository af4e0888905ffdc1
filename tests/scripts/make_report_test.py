"""Tests make_report.py and what it reads: sections that are complete, and a report without matplotlib."""

import contextlib
import io
import json
import tempfile
import unittest
from pathlib import Path
from unittest import mock

import make_report
from report import plots
from report.sections import SectionError, read_sections


def section(section_id="10_folds"):
    """A section with a table and a figure."""
    return {
        "format_version": 1, "id": section_id, "title": "Methods & classes", "text": ["First <paragraph>."],
        "tables": [{
            "title": "Errors <raw> & all", "columns": ["kick", "shake_hands"],
            "rows": [{"name": "ours", "printed": False, "values": [0.504, 1 / 3]},
                     {"name": "frozen_first_frame", "printed": False, "values": [0.7, None]}],
            "notes": ["lower is better"], "decimals": 3, "best": "lowest"}],
        "figures": [{"name": section_id + "_curve", "caption": "A curve of \"errors\".", "plot": {
            "kind": "latent", "title": "ours", "class_names": ["kick", "hug"], "classes": [0] * 10 + [1] * 10,
            "perplexity": 30, "seed": 1,
            "features": [[float(i % 10), 0.0 if i < 10 else 100.0, 1.0] for i in range(20)]}}],
        "settings": [{"name": "data", "value": "SBU"}], "command": "duet-eval folds --data DIR", "date": "2024-02-29"}


class ReportTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.results, self.out = Path(folder.name) / "results", Path(folder.name) / "report"
        self.results.mkdir()

    def write(self, written, name=None):
        (self.results / f"{name or written['id']}.json").write_text(json.dumps(written), encoding="utf-8")

    def make(self):
        err = io.StringIO()
        with contextlib.redirect_stderr(err), contextlib.redirect_stdout(io.StringIO()):
            code = make_report.main(["--results", str(self.results), "--out", str(self.out)])
        return code, err.getvalue()

    def test_without_matplotlib_the_report_has_its_tables(self):
        self.write(section())
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

    def test_sections_are_sorted_and_their_errors_name_the_file_and_the_field(self):
        for name in ("20_more", "10_folds"):
            self.write(section(name))
        self.assertEqual([read["id"] for read in read_sections(self.results)], ["10_folds", "20_more"])
        for change, message in (
                (lambda s: s.pop("command"), "10_folds.json: command: missing"),
                (lambda s: s.update(format_version=2), "format_version: expected 1, got 2"),
                (lambda s: s.update(id="30_more"), "10_folds.json: id: expected the name"),
                (lambda s: s["figures"][0].update(name="20_more_curve"), "already the name of another figure"),
                (lambda s: s["tables"][0]["rows"][1]["values"].pop(),
                 r"tables\[0\].rows\[1\].values: expected one for each of the 2 columns, got 1")):
            changed = section()
            change(changed)
            self.write(changed, "10_folds")
            with self.assertRaisesRegex(SectionError, message):
                read_sections(self.results)


if __name__ == "__main__":
    unittest.main()
