#!/usr/bin/env python3
"""Writes the evaluation's report from the JSON sections that duet-eval wrote.

    scripts/make_report.py --results RESULTS --out REPORT

REPORT receives report.md and every figure as SVG and PNG; animations are GIFs. Figures need python3-matplotlib and python3-sklearn: without them the
report has its tables and no figures.
"""

import argparse
import sys
from pathlib import Path

from report import plots
from report.markdown import to_markdown
from report.sections import SectionError, read_sections


def draw_figures(sections, out):
    """Writes every figure to `out`. Returns a map from a figure's name to the files that show it."""
    pictures = {}
    for figure in (figure for section in sections for figure in section["figures"]):
        name = figure["name"]
        pictures[name], remark = plots.draw_plot(figure["plot"], out, name)
        figure["caption"] = f"{figure['caption']} {remark}".strip()
    return pictures


def write_report(title, results, out):
    sections = read_sections(results)
    out.mkdir(parents=True, exist_ok=True)
    pictures = {}
    try:
        plots.use_matplotlib()
        pictures = draw_figures(sections, out)
    except ImportError as error:
        print(f"make_report.py: {error} (Debian: python3-matplotlib, python3-sklearn): "
              "the report has no figures", file=sys.stderr)
    (out / "report.md").write_text(to_markdown(title, sections, pictures), encoding="utf-8")
    return len(sections)


def main(arguments=None):
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", maxsplit=1)[0])
    parser.add_argument("--results", type=Path, required=True,
                        help="folder that duet-eval --out wrote")
    parser.add_argument("--out", type=Path, required=True, help="folder of the report")
    parser.add_argument("--title", default="Duet: evaluation", help="title of the report")
    args = parser.parse_args(arguments)
    try:
        count = write_report(args.title, args.results, args.out)
    except (SectionError, OSError) as error:
        print(f"make_report.py: {error}", file=sys.stderr)
        return 1
    print(f"{count} sections: {args.out / 'report.md'}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
