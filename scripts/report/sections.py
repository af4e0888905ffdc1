"""Reads result sections: the JSON files that `duet-eval ... --out RESULTS` writes (model/evaluation/report)."""

import json
from pathlib import Path

FORMAT_VERSION = 1
FIELDS = ("format_version", "id", "title", "text", "tables", "figures", "settings", "command", "date")


class SectionError(ValueError):
    """A file that is not a section; the message names the file and the field."""


def read_sections(folder):
    """Every section of a folder, sorted by id."""
    files = sorted(Path(folder).glob("*.json"))
    if not files:
        raise SectionError(f"{folder}: no .json file; expected results of duet-eval --out")
    sections, figures = [], set()
    for file in files:
        try:
            section = json.loads(file.read_text(encoding="utf-8"))
            check_section(section)
            if section["id"] != file.stem:
                raise ValueError(f'id: expected the name of the file, got "{section["id"]}"')
            for figure in section["figures"]:
                if figure["name"] in figures:
                    raise ValueError(f'figures: "{figure["name"]}" is already the name of another figure')
                figures.add(figure["name"])
        except (OSError, ValueError) as error:
            raise SectionError(f"{file}: {error}") from error
        sections.append(section)
    return sections


def check_section(section):
    """Raises ValueError for a section of another version or form, such as a row without a value for each column."""
    missing = [field for field in FIELDS if field not in section]
    if missing:
        raise ValueError(f"{missing[0]}: missing")
    if section["format_version"] != FORMAT_VERSION:
        raise ValueError(f"format_version: expected {FORMAT_VERSION}, got {section['format_version']}")
    for index, table in enumerate(section["tables"]):
        for number, row in enumerate(table["rows"]):
            if len(row["values"]) != len(table["columns"]):
                raise ValueError(f"tables[{index}].rows[{number}].values: expected one for each of the "
                                 f"{len(table['columns'])} columns, got {len(row['values'])}")
