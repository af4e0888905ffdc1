"""The runbook speaks of what there is: every alert of the rules has its row and no row is of another, and
the settings, figures, log events, flags and panels that it names exist."""

import json
import re
import unittest

import tools

RUNBOOK = (tools.SOURCE / "docs/runbook.md").read_text(encoding="utf-8")
ROWS = re.findall(r"^\| (Duet\w+) \| (.+) \| (.+) \|$", RUNBOOK, re.MULTILINE)
# Labels that the Prometheus operator makes of those of a pod.
POD_LABELS = {"duet_dev_track", "app_kubernetes_io_version"}


def text_of(path):
    return (tools.SOURCE / path).read_text(encoding="utf-8")


class RunbookTest(unittest.TestCase):
    def test_every_alert_has_its_row(self):
        alerts = re.findall(r"^ +- alert: (\w+)$", text_of("deploy/prometheus/rules.yml"),
                            re.MULTILINE)
        self.assertEqual([name for name, _, _ in ROWS], alerts)

    def test_settings_figures_and_events_are_the_servers(self):
        known = set(POD_LABELS)
        known.update(re.findall(r"(\w+) = \d+[;\s]", text_of("proto/duet/v1/server_config.proto")))
        known.update(re.findall(r"`(\w+)`", text_of("docs/metrics.md")))
        for file in (tools.SOURCE / "server").rglob("*.cc"):
            known.update(re.findall(r'"(\w+)"', file.read_text(encoding="utf-8")))
        named = set(re.findall(r"`([a-z]+(?:_[a-z]+)+)`", RUNBOOK))
        self.assertLessEqual({"drain_seconds", "cannot_serve"}, named)
        self.assertEqual(named - known, set())

    def test_panels_are_the_dashboards(self):
        panels = {panel["title"] for panel in json.loads(text_of("deploy/grafana/duet.json"))["panels"]}
        named = {panel for _, look, _ in ROWS if look.endswith(" (dashboard)")
                 for panel in look.removesuffix(" (dashboard)").split(", ")}
        self.assertIn("Windows that wait", named)
        self.assertEqual(named - panels, set())

    def test_flags_are_those_of_server_and_client(self):
        known = tools.run(tools.PROGRAMS / "duet", "batch", "--help").stdout
        known += tools.run(tools.PROGRAMS / "duet-server", "--help").stdout
        named = set(re.findall(r"`(--[a-z-]+)`", RUNBOOK))
        self.assertIn("--max-in-flight", named)
        self.assertEqual({flag for flag in named if flag not in known}, set())


if __name__ == "__main__":
    tools.main()
