#!/usr/bin/env python3
"""Writes result sections about runs of duet-train, from their log.csv.

    scripts/training_results.py curves --run [NAME=]RUN... [--out RESULTS]
    scripts/training_results.py validation --runs [NAME=]RUNS... [--out RESULTS]

`curves` shows how losses went; `validation` compares settings on the subjects that their runs held
back. Both print their tables. scripts/make_report.py makes the report of the sections.
"""

import argparse
import json
import sys
from pathlib import Path

from report import training
from report.markdown import table_lines
from report.sections import check_section


def read_runs(texts):
    runs = []
    for text in texts:
        name, folder = training.parse_run(text)
        runs.append((name, training.read_log(folder / "log.csv")))
    return runs


def read_configurations(texts):
    configurations = []
    for text in texts:
        name, folder = training.parse_run(text)
        files = sorted(folder.glob("*/log.csv"))
        if not files:
            raise training.LogError(f"{folder}: no <run>/log.csv; expected output of duet-train")
        configurations.append((name, {file.parent.name: training.read_log(file)
                                      for file in files}))
    return configurations


def write_section(section, folder):
    folder.mkdir(parents=True, exist_ok=True)
    text = json.dumps(section, indent=1, allow_nan=False) + "\n"
    (folder / f"{section['id']}.json").write_text(text, encoding="utf-8")


def parse_arguments(arguments):
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", maxsplit=1)[0])
    commands = parser.add_subparsers(dest="command", required=True)
    curves = commands.add_parser("curves", help="training curves")
    curves.add_argument("--run", "--runs", dest="runs", nargs="+", action="extend", required=True,
                        help="[NAME=]DIR, the folder of a run")
    validation = commands.add_parser("validation", help="settings compared on held-back subjects")
    validation.add_argument("--runs", nargs="+", action="extend", required=True,
                            help="[NAME=]DIR, output of duet-train with validation subjects")
    for command, default_id, title in (
            (curves, "60_curves", "Training curves"),
            (validation, "22_validation", "Settings compared on validation subjects")):
        command.add_argument("--out", type=Path, help="folder of results, for make_report.py")
        command.add_argument("--id", default=default_id, help="id of the section")
        command.add_argument("--title", default=title, help="title of the section")
    return parser.parse_args(arguments)


def main(arguments=None):
    args = parse_arguments(arguments)
    try:
        if args.command == "curves":
            section = training.curves(args.id, args.title, read_runs(args.runs))
        else:
            section = training.validation(args.id, args.title, read_configurations(args.runs))
        check_section(section)
        for table in section["tables"]:
            print("\n".join(table_lines(table)), end="\n\n")
        if args.out:
            write_section(section, args.out)
    except (ValueError, OSError) as error:
        print(f"training_results.py: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
