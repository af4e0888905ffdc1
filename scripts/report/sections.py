"""Reads result sections: the JSON files that `duet-eval ... --out RESULTS` writes."""

import datetime
import json
import re
from pathlib import Path

FORMAT_VERSION = 1
NAME = re.compile(r"[a-z0-9_]{1,64}")
PLOT_KINDS = ("lines", "latent", "poses")

SECTION = {"format_version": int, "id": str, "title": str, "text": list, "tables": list,
           "figures": list, "settings": list, "command": str, "date": str}
TABLE = {"title": str, "columns": list, "rows": list, "notes": list, "decimals": int, "best": str}
ROW = {"name": str, "printed": bool, "values": list}
FIGURE = {"name": str, "caption": str, "plot": dict}
SETTING = {"name": str, "value": str}


class SectionError(ValueError):
    """A file that is not a section; the message names the file and the field."""


def read_sections(folder):
    """Every section of a folder, sorted by id."""
    files = sorted(Path(folder).glob("*.json"))
    if not files:
        raise SectionError(f"{folder}: no .json file; expected results of duet-eval --out")
    sections = sorted((read_section(file) for file in files), key=lambda s: s["id"])
    seen = set()
    for section in sections:
        for figure in section["figures"]:
            if figure["name"] in seen:
                raise SectionError(f"{section['id']}.json: figures: \"{figure['name']}\" is already "
                                   "the name of another figure")
            seen.add(figure["name"])
    return sections


def read_section(file):
    """One section, as a dictionary whose fields and types have been checked."""
    try:
        section = json.loads(file.read_text(encoding="utf-8"))
        check_section(section)
    except (OSError, ValueError) as error:
        raise SectionError(f"{file}: {error}") from error
    if section["id"] != file.stem:
        raise SectionError(f"{file}: id: expected the name of the file, got \"{section['id']}\"")
    return section


def check_section(section):
    _check_fields(section, SECTION, "")
    if section["format_version"] != FORMAT_VERSION:
        raise ValueError(
            f"format_version: expected {FORMAT_VERSION}, got {section['format_version']}")
    _check_name(section["id"], "id")
    datetime.date.fromisoformat(section["date"])
    _check_texts(section["text"], "text")
    for index, table in enumerate(section["tables"]):
        _check_table(table, f"tables[{index}]")
    for index, figure in enumerate(section["figures"]):
        _check_figure(figure, f"figures[{index}]")
    for index, setting in enumerate(section["settings"]):
        _check_fields(setting, SETTING, f"settings[{index}]")


def _check_fields(value, fields, path):
    if not isinstance(value, dict):
        raise ValueError(f"{path or 'the file'}: expected an object, got {value!r:.40}")
    prefix = path + "." if path else ""
    for key, kind in fields.items():
        if key not in value:
            raise ValueError(f"{prefix}{key}: missing")
        if not isinstance(value[key], kind) or (kind is int and isinstance(value[key], bool)):
            raise ValueError(f"{prefix}{key}: expected {kind.__name__}, got {value[key]!r:.40}")
    for key in value:
        if key not in fields:
            raise ValueError(f"{prefix}{key}: unknown field")


def _check_name(name, path):
    if not NAME.fullmatch(name):
        raise ValueError(f"{path}: expected 1 to 64 of a-z, 0-9 and _, got {name!r:.80}")


def _check_texts(texts, path):
    for index, text in enumerate(texts):
        if not isinstance(text, str):
            raise ValueError(f"{path}[{index}]: expected str, got {text!r:.40}")


def _check_table(table, path):
    _check_fields(table, TABLE, path)
    _check_texts(table["columns"], f"{path}.columns")
    _check_texts(table["notes"], f"{path}.notes")
    if table["best"] not in ("none", "lowest", "highest"):
        raise ValueError(f"{path}.best: expected none, lowest or highest, got {table['best']!r:.40}")
    if not 0 <= table["decimals"] <= 12:
        raise ValueError(f"{path}.decimals: expected 0 to 12, got {table['decimals']}")
    for index, row in enumerate(table["rows"]):
        where = f"{path}.rows[{index}]"
        _check_fields(row, ROW, where)
        if len(row["values"]) != len(table["columns"]):
            raise ValueError(f"{where}.values: expected one for each of the "
                             f"{len(table['columns'])} columns, got {len(row['values'])}")
        for column, value in enumerate(row["values"]):
            number = isinstance(value, (int, float)) and not isinstance(value, bool)
            if value is not None and not number:
                raise ValueError(f"{where}.values[{column}]: expected a number or null, "
                                 f"got {value!r:.40}")


def _check_figure(figure, path):
    _check_fields(figure, FIGURE, path)
    _check_name(figure["name"], f"{path}.name")
    plot = figure["plot"]
    if plot.get("kind") not in PLOT_KINDS:
        raise ValueError(f"{path}.plot.kind: expected one of {', '.join(PLOT_KINDS)}")
