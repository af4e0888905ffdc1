"""The report as one HTML page that needs no other file."""

import base64
from html import escape
from pathlib import Path

from report.markdown import READING_GUIDE, latest_date
from report.tables import MISSING, cells

STYLE = Path(__file__).with_name("page.css")
MEDIA_TYPES = {".svg": "image/svg+xml", ".gif": "image/gif", ".png": "image/png"}
# <details> that stay closed would be missing on paper.
PRINT_SCRIPT = ("<script>addEventListener('beforeprint', () => "
                "document.querySelectorAll('details').forEach((d) => { d.open = true; }));</script>")


def to_page(title, sections, pictures, folder):
    """`pictures` maps a figure's name to the files in `folder` that show it."""
    numbers = {"table": 0, "figure": 0}
    contents = "".join(f"<li><a href=\"#{section['id']}\">{escape(section['title'])}</a></li>\n"
                       for section in sections)
    body = "".join(_section(section, pictures, folder, numbers) for section in sections)
    style = STYLE.read_text(encoding="utf-8")
    return (f"<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
            f"<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
            f"<meta name=\"color-scheme\" content=\"light dark\">\n<title>{escape(title)}</title>\n"
            f"<style>\n{style}</style>\n</head>\n<body>\n<header>\n<h1>{escape(title)}</h1>\n"
            f"<p class=\"date\">{latest_date(sections)}</p>\n<p>{escape(READING_GUIDE)}</p>\n"
            f"</header>\n<nav aria-label=\"Contents\">\n<h2>Contents</h2>\n<ol>\n{contents}</ol>\n"
            f"</nav>\n<main>\n{body}</main>\n{PRINT_SCRIPT}\n</body>\n</html>\n")


def _section(section, pictures, folder, numbers):
    html = f"<section id=\"{section['id']}\">\n<h2>{escape(section['title'])}</h2>\n"
    html += "".join(f"<p>{escape(paragraph)}</p>\n" for paragraph in section["text"])
    for table in section["tables"]:
        numbers["table"] += 1
        html += _table(table, numbers["table"])
    for figure in section["figures"]:
        numbers["figure"] += 1
        html += _figure(figure, numbers["figure"], pictures.get(figure["name"], []), folder)
    return html + _origin(section) + "</section>\n"


def _breakable(name):
    return escape(name).replace("_", "_<wbr>")


def _row(row, row_cells):
    tds = "".join("<td>&ndash;</td>" if text == MISSING else
                  f"<td class=\"best\"><b>{text}</b></td>" if best else f"<td>{text}</td>"
                  for text, best in row_cells)
    return f"<tr><th scope=\"row\">{_breakable(row['name'])}</th>{tds}</tr>\n"


def _table(table, number):
    head = "".join(f"<th scope=\"col\">{_breakable(column)}</th>" for column in table["columns"])
    rows = list(zip(table["rows"], cells(table)))
    measured = "".join(_row(*pair) for pair in rows if not pair[0]["printed"])
    printed = "".join(_row(*pair) for pair in rows if pair[0]["printed"])
    if printed:
        printed = ("<tbody class=\"printed\">\n<tr class=\"group\"><th scope=\"rowgroup\" colspan=\""
                   f"{len(table['columns']) + 1}\"><span>Printed in the paper, not measured here"
                   f"</span></th></tr>\n{printed}</tbody>\n")
    notes = "".join(f"<p>{escape(note)}</p>\n" for note in table["notes"])
    return (f"<figure class=\"table\">\n<figcaption><b>Table {number}.</b> {escape(table['title'])}"
            f"</figcaption>\n<div class=\"scroll\" tabindex=\"0\" role=\"region\" "
            f"aria-label=\"Table {number}\">\n<table>\n<thead><tr><td></td>{head}</tr></thead>\n"
            f"<tbody>\n{measured}</tbody>\n{printed}</table>\n</div>\n"
            + (f"<div class=\"notes\">\n{notes}</div>\n" if notes else "") + "</figure>\n")


def _figure(figure, number, files, folder):
    images = ""
    for name in files:
        data = base64.b64encode((folder / name).read_bytes()).decode("ascii")
        media = MEDIA_TYPES[Path(name).suffix]
        images += (f"<img alt=\"{escape(figure['caption'])}\" "
                   f"src=\"data:{media};base64,{data}\">\n")
    return (f"<figure class=\"plot\">\n<div class=\"scroll\">\n{images}</div>\n<figcaption>"
            f"<b>Figure {number}.</b> {escape(figure['caption'])}</figcaption>\n</figure>\n")


def _origin(section):
    settings = "".join(f"<dt>{escape(setting['name'])}</dt><dd>{escape(setting['value'])}</dd>\n"
                       for setting in section["settings"])
    return (f"<details>\n<summary>Settings and command</summary>\n<dl>\n{settings}<dt>date</dt>"
            f"<dd>{section['date']}</dd>\n</dl>\n<pre><code>{escape(section['command'])}</code>"
            "</pre>\n</details>\n")
