#!/usr/bin/env python3
"""Shows which figures check_figures.py accepts, rejects and writes."""

import contextlib
import io
import json
import pathlib
import tempfile
import unittest

import check_figures

DATA = {"ms": {"small/1": 1.2345, "small/8": 9.996, "big/1": 1234.5, "big/8": 0.126}}


def table(*rows, mark="<!-- figures: run.json: ms {row}/{column} -->"):
    return "\n".join(["# Speed", "", mark, "", "| ms | 1 | 8 |", "|---|---|---|", *rows, "", "| 1 | 2 |"])


class FiguresTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        self.save(DATA)

    def save(self, data):
        (self.root / "run.json").write_text(json.dumps(data))

    def check(self, text):
        return check_figures.check_text(self.root, text)

    def problems(self, text):
        return [message for _, message in self.check(text)[1]]

    def test_rounded_figures_are_accepted(self):
        self.assertEqual(self.check(table("| small | 1.23 ms | **10.00** |", "| big | 1,234 | .13 |"))[1:],
                         ([], 1))

    def test_figure_that_differs_is_named_with_its_value(self):
        text = table("| small | 1.24 | 10 |")
        wanted, found, _ = self.check(text)
        self.assertEqual(found, [(7, 'row "small", column "1": expected 1.23 as in run.json, got 1.24')])
        self.assertEqual(wanted, text.replace("1.24", "1.23"))

    def test_labels_map_to_keys_and_columns_are_skipped(self):
        mark = "<!-- figures: run.json: ms {row}/{column}\nthe small one = small\nskip: 8\n-->"
        self.assertEqual(self.problems(table("| the small one | 1.23 | 77 |", mark=mark)), [])
        self.assertEqual(self.problems(table("| the big one | 1.23 | 77 |", mark=mark)),
                         ['row "the big one", column "1": expected a value for the key '
                          '"the big one/1", got none'])

    def test_records_of_a_list_are_selected_by_value_or_index(self):
        self.save({"steps": [{"callers": 1, "s": [5, 6]}, {"callers": 8, "s": [7, 8]}]})
        mark = "<!-- figures: run.json: steps callers={column} s {row} -->"
        self.assertEqual(self.problems(table("| 0 | 5 | 7 |", "| 1 | 6 | 8 |", mark=mark)), [])
        self.assertEqual(len(self.problems(table("| 2 | 5 | - |", mark=mark))), 1)

    def test_cells_without_a_number_are_left_alone(self):
        self.assertEqual(self.problems(table("| tiny | - | |")), [])

    def test_mistakes_in_marks_are_reported(self):
        for mark, wrong in (("<!-- figures: run.json -->", "file: path"),
                            ("<!-- figures: gone.json: ms {row}/{column} -->", "No such file"),
                            ("<!-- figures: run.json: ms {row}/{column}\nwhat\n-->", "label = key"),
                            ("<!-- figures: run.json: ms {row}/{column}\nskip: 9\n-->", "name columns"),
                            ("<!-- figures: run.json: ms -->", "expected a number")):
            self.assertIn(wrong, " ".join(self.problems(table("| small | 1.23 | - |", mark=mark))))
        self.assertIn("expected a table", self.problems("<!-- figures: run.json: ms -->\n\ntext")[0])

    def test_two_numbers_in_a_cell_are_reported(self):
        self.assertIn("expected one number", self.problems(table("| small | 1.23, 4 | - |"))[0])

    def test_examples_in_code_are_no_marks(self):
        self.assertEqual(self.check("```\n" + table("| small | 7 | 7 |") + "\n```\n")[1:], ([], 0))

    def test_write_brings_documents_up_to_date(self):
        document = self.root / "speed.md"
        document.write_text(table("| big | 1,111 | .99 |"))
        with contextlib.redirect_stderr(io.StringIO()), contextlib.redirect_stdout(io.StringIO()):
            self.assertEqual(check_figures.main([], self.root), 1)
            self.assertEqual(check_figures.main(["--write"], self.root), 0)
            self.assertEqual(check_figures.main([], self.root), 0)
        self.assertIn("| big | 1,234 | .13 |", document.read_text())


if __name__ == "__main__":
    unittest.main()
