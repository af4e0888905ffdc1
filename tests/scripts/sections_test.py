import json
import tempfile
import unittest
from pathlib import Path

import report_example as example
from report.sections import SectionError, read_sections


class SectionsTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def write(self, section, name=None):
        file = self.folder / f"{name or section['id']}.json"
        file.write_text(json.dumps(section), encoding="utf-8")

    def problem_with(self, change):
        section = example.section()
        change(section)
        self.write(section, "10_folds")
        with self.assertRaises(SectionError) as raised:
            read_sections(self.folder)
        return str(raised.exception)

    def test_sections_are_sorted_by_id(self):
        for name in ("20_more", "10_folds"):
            self.write(example.section(name))
        self.assertEqual([s["id"] for s in read_sections(self.folder)], ["10_folds", "20_more"])

    def test_errors_name_the_file_and_the_field(self):
        for change, message in (
                (lambda s: s.pop("command"), "10_folds.json: command: missing"),
                (lambda s: s.update(format_version=2), "format_version: expected 1, got 2"),
                (lambda s: s["tables"][0]["rows"][1]["values"].pop(),
                 "tables[0].rows[1].values: expected one for each of the 2 columns, got 1")):
            self.assertIn(message, self.problem_with(change))

    def test_a_file_is_named_by_its_id(self):
        self.write(example.section("10_folds"), "20_folds")
        with self.assertRaisesRegex(SectionError, "20_folds.json: id: expected the name"):
            read_sections(self.folder)

    def test_names_of_figures_are_unique_in_a_report(self):
        self.write(example.section("10_folds"))
        second = example.section("20_folds")
        second["figures"][0]["name"] = "10_folds_curve"
        self.write(second)
        with self.assertRaisesRegex(SectionError, "already the name of another figure"):
            read_sections(self.folder)

    def test_a_folder_without_sections_is_an_error(self):
        with self.assertRaisesRegex(SectionError, "no .json file"):
            read_sections(self.folder)


if __name__ == "__main__":
    unittest.main()
