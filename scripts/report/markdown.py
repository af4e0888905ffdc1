"""The report as GitHub Markdown."""

import html
import re

from report.tables import cells

READING_GUIDE = (
    "The best figures of a column are bold, ties included. Rows marked as printed are the paper's "
    "own figures: they were not measured here, are never marked as best, and compare only as far "
    "as the notes below their table say. A dash is a figure that does not exist.")


def latest_date(sections):
    return max((section["date"] for section in sections), default="")


def escape(text):
    text = re.sub(r"[\x00-\x1f\x7f]", " ", text)
    # An underscore inside a word is literal in Markdown; elsewhere it would start emphasis.
    return re.sub(r"(?<![A-Za-z0-9])_|_(?![A-Za-z0-9])|[\\|*`\[\]<>~#]", r"\\\g<0>", text)


def to_markdown(title, sections, pictures):
    """`pictures` maps a figure's name to the files that show it."""
    lines = [f"# {escape(title)}", "", f"{latest_date(sections)}. {READING_GUIDE}", ""]
    lines += [f"- [{escape(section['title'])}](#{section['id']})" for section in sections]
    lines.append("")
    numbers = {"table": 0, "figure": 0}
    for section in sections:
        lines += _section(section, pictures, numbers)
    return "\n".join(lines).rstrip("\n") + "\n"


def _section(section, pictures, numbers):
    lines = [f"<a id=\"{section['id']}\"></a>", "", f"## {escape(section['title'])}", ""]
    for paragraph in section["text"]:
        lines += [escape(paragraph), ""]
    for table in section["tables"]:
        numbers["table"] += 1
        lines += table_lines(table, f"Table {numbers['table']}. ") + [""]
    for figure in section["figures"]:
        numbers["figure"] += 1
        caption = escape(figure["caption"])
        for picture in pictures.get(figure["name"], []):
            lines += [f"![{caption}]({picture})", ""]
        lines += [f"*Figure {numbers['figure']}. {caption}*", ""]
    return lines + _origin(section)


def table_lines(table, numbering=""):
    lines = [f"**{numbering}{escape(table['title'])}**", "",
             "| |" + "".join(f" {escape(column)} |" for column in table["columns"]),
             "|---|" + "---:|" * len(table["columns"])]
    for row, row_cells in zip(table["rows"], cells(table)):
        name = escape(row["name"])
        line = f"| *{escape(row['name'] + ' (printed)')}* |" if row.get("printed") else f"| {name} |"
        lines.append(line + "".join(f" **{text}** |" if best else f" {text} |"
                                    for text, best in row_cells))
    for note in table["notes"]:
        lines += ["", escape(note)]
    return lines


def _origin(section):
    lines = ["<details><summary>Settings and command</summary>", "", "| | |", "|---|---|"]
    lines += [f"| {escape(setting['name'])} | {escape(setting['value'])} |"
              for setting in section["settings"]]
    return lines + [f"| date | {section['date']} |", "",
                    f"<pre><code>{html.escape(section['command'])}</code></pre>", "",
                    "</details>", ""]
