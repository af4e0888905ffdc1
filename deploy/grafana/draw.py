#!/usr/bin/env python3
"""Draws the panels of the dashboard as a picture from a running Prometheus, with the same queries but
without Grafana. Fails if Prometheus rejects a query.

    deploy/grafana/draw.py http://localhost:9090 MINUTES dashboard.png
"""

import datetime
import json
import pathlib
import sys
import time
import urllib.parse
import urllib.request

import matplotlib

matplotlib.use("Agg")
from matplotlib import dates, pyplot  # noqa: E402  the backend is chosen first

DASHBOARD = pathlib.Path(__file__).resolve().parent / "duet.json"
COLUMNS = 3
STEP = 5  # seconds


def filled(expression):
    """The query with the dashboard's variables replaced: all servers, a rate over a minute."""
    return expression.replace("$__rate_interval", "1m").replace("$instance", ".*")


def series(address, expression, minutes, end):
    """Prometheus's result as (labels, times, values)."""
    query = urllib.parse.urlencode({"query": filled(expression), "start": end - 60 * minutes,
                                    "end": end, "step": STEP})
    with urllib.request.urlopen(f"{address}/api/v1/query_range?{query}") as reply:
        answer = json.load(reply)
    assert answer["status"] == "success", answer
    for one in answer["data"]["result"]:
        times = [datetime.datetime.fromtimestamp(at, datetime.timezone.utc)
                 for at, _ in one["values"]]
        yield one["metric"], times, [float(value) for _, value in one["values"]]


def legend(text, labels):
    for name, value in labels.items():
        text = text.replace("{{" + name + "}}", value)
    return text


def draw(address, minutes, out):
    end = time.time()
    panels = json.loads(DASHBOARD.read_text(encoding="utf-8"))["panels"]
    rows = -(-len(panels) // COLUMNS)
    figure, axes = pyplot.subplots(rows, COLUMNS, figsize=(15, 2.6 * rows), squeeze=False)
    for panel, axis in zip(panels, axes.flat):
        axis.set_title(f"{panel['title']} [{panel['fieldConfig']['defaults']['unit']}]", fontsize=9)
        for target in panel["targets"]:
            for labels, times, values in series(address, target["expr"], minutes, end):
                axis.plot(times, values, linewidth=1, label=legend(target["legendFormat"], labels))
        axis.set_ylim(bottom=0)
        axis.set_xlim(*(datetime.datetime.fromtimestamp(at, datetime.timezone.utc)
                        for at in (end - 60 * minutes, end)))
        axis.xaxis.set_major_formatter(dates.DateFormatter("%H:%M"))
        axis.tick_params(labelsize=7)
        if axis.get_legend_handles_labels()[0]:
            axis.legend(fontsize=6)
    figure.tight_layout()
    figure.savefig(out, dpi=80)


if __name__ == "__main__":
    draw(sys.argv[1], float(sys.argv[2]), sys.argv[3])
