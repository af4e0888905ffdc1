"""The dashboard has the types that Grafana publishes (deploy/grafana/validate.mjs); that its metrics are the
server's, observability_test.py shows. Needs DUET_NODE_MODULES, a folder with npm's @grafana/schema and
typescript."""

import json
import os
import pathlib
import shutil
import tempfile
import unittest

import tools

GRAFANA = tools.SOURCE / "deploy/grafana"
MODULES = pathlib.Path(os.environ.get("DUET_NODE_MODULES", "/nonexistent"))


def validate(*dashboard):
    return tools.run("node", GRAFANA / "validate.mjs", MODULES, *dashboard)


class DashboardTest(unittest.TestCase):
    def test_the_dashboard_has_the_published_types(self):
        result = validate()
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        self.assertIn(", 0 wrong", result.stdout)

    def test_wrong_metric_name_is_found_in_dashboard_and_panel(self):
        dashboard = json.loads((GRAFANA / "duet.json").read_text(encoding="utf-8"))
        dashboard["refreshes"] = dashboard.pop("refresh")
        dashboard["panels"][0]["options"]["tooltip"]["mode"] = "many"
        with tempfile.NamedTemporaryFile("w", suffix=".json") as file:
            json.dump(dashboard, file)
            file.flush()
            result = validate(file.name)
        self.assertEqual(result.returncode, 1, result.stdout + result.stderr)
        self.assertIn("'\"refreshes\"' does not exist", result.stdout)
        self.assertIn('"many"', result.stdout)


if __name__ == "__main__":
    if not shutil.which("node") or not (MODULES / "@grafana/schema").is_dir():
        tools.skip("needs node, and DUET_NODE_MODULES with @grafana/schema")
    tools.main()
