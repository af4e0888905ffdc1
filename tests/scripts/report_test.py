import copy
import unittest

import report_example as example
from report import tables
from report.markdown import escape, to_markdown


def two_sections():
    sections = [example.section("10_folds"), example.section("20_more")]
    sections[1].update(title="More", date="2024-03-01")
    pictures = {name: [f"{name}.svg"] for name in ("10_folds_curve", "20_more_curve")}
    return sections, pictures


class TablesTest(unittest.TestCase):
    def test_ties_are_all_best_and_printed_rows_never(self):
        table = copy.deepcopy(example.section()["tables"][0])
        table.update(decimals=1)
        table["rows"][1]["values"][0] = 0.5
        table["rows"][2]["values"][0] = 0.52
        self.assertEqual(tables.cells(table)[0][0], ("0.5", True))
        self.assertEqual(tables.cells(table)[2], [("0.5", True), ("-", False)])
        self.assertEqual(tables.cells(table)[1][0], ("0.5", False))

    def test_highest_or_none_can_be_best(self):
        table = example.section()["tables"][0]
        self.assertTrue(tables.cells({**table, "best": "highest"})[2][0][1])
        self.assertFalse(any(best for row in tables.cells({**table, "best": "none"})
                             for _, best in row))

    def test_zero_has_no_sign(self):
        self.assertEqual(tables.rounded(-0.001, 2), "0.00")
        self.assertEqual(tables.rounded(-0.006, 2), "-0.01")


class MarkdownTest(unittest.TestCase):
    def test_report_has_contents_tables_figures_and_origins(self):
        text = to_markdown("Figures & tables", *two_sections())
        self.assertTrue(text.startswith("# Figures & tables\n\n2024-03-01. The best figures"))
        for part in (
                "- [Methods & classes](#10_folds)\n- [More](#20_more)\n",
                "<a id=\"20_more\"></a>\n\n## More\n\nFirst \\<paragraph\\>.\n\n",
                "**Table 2. Errors \\<raw\\> & all**\n\n| | kick | shake_hands |\n|---|---:|---:|\n",
                "| ours | **0.504** | **0.333** |\n| *paper (printed)* | 0.100 | 0.200 |\n",
                "| frozen_first_frame | 0.700 | - |\n\nlower is better\n\n",
                "![A curve of \"errors\".](20_more_curve.svg)\n\n*Figure 2. A curve of \"errors\".*\n",
                "| seeds | 1, 2 |\n| date | 2024-03-01 |\n\n"
                "<pre><code>duet-eval folds --data DIR</code></pre>\n\n</details>\n"):
            self.assertIn(part, text)

    def test_markup_is_escaped(self):
        self.assertEqual(escape("a|b *c* _d_ shake_hands\n"), "a\\|b \\*c\\* \\_d\\_ shake_hands ")


if __name__ == "__main__":
    unittest.main()
