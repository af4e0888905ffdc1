"""The page that compares Duet with other tools: every table has every tool, and what it says of Duet is what the
server says of its models."""

import json
import re
import unittest

import tools

PAGE = (tools.SOURCE / "docs/comparison.md").read_text(encoding="utf-8")
TOOLS = ("Duet", "ReGenNet", "InterGen", "ARMFlow", "Audio2Face-3D", "Triton + Python")
NUMBERS = {"six": 6, "seven": 7, "eight": 8}


def section(title):
    return re.search(rf"^## {title}\n(.*?)(?=^## |\Z)", PAGE, re.MULTILINE | re.DOTALL)[1]


def rows(title):
    """The cells of a section's table, without its head."""
    lines = re.findall(r"^\|(.+)\|$", section(title), re.MULTILINE)
    return [[cell.strip() for cell in line.split("|")] for line in lines[2:]]


class ComparisonTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        with tools.running_server() as server:
            shown = tools.duet("models", "--server", server.address, "--json")
        cls.models = json.loads(shown.stdout)["models"]

    def test_every_table_has_every_tool(self):
        for title in ("What each one does", "Licence and data"):
            for tool in TOOLS:
                with self.subTest(title=title, tool=tool):
                    self.assertTrue(any(f"**{tool}**" in row[0] for row in rows(title)))

    def test_terms_are_those_of_the_models(self):
        weights = next(row[2] for row in rows("Licence and data") if row[0] == "**Duet**")
        free, research = weights.split(";", 1)
        self.assertIn("free for all uses", free)
        self.assertIn("research and evaluation only", research)
        for model in self.models:
            stated = free if model["free_for_all_uses"] else research
            self.assertIn(f"`{model['name']}`", stated)

    def test_classes_and_joints_are_those_of_the_models(self):
        cannot = section("What Duet cannot do").lower()
        counts = {model["name"]: len(model["interaction_classes"]) for model in self.models}
        stated = re.search(r"(\w+), (\w+) and (\w+) classes in three models", cannot).groups()
        self.assertEqual(sorted(NUMBERS[word] for word in stated), sorted(counts.values()))
        joints = re.search(r"(\d+) or (\d+) joints", cannot).groups()
        self.assertEqual({int(count) for count in joints}, {len(model["joint_names"]) for model in self.models})


if __name__ == "__main__":
    tools.main()
