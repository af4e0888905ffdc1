#!/usr/bin/env python3
"""Checks that the figures in documents are those that a command wrote.

A comment in front of a table of a Markdown document names a committed JSON file and the path to each cell's value:

    <!-- figures: benchmarks/figures.json: milliseconds windows/{row}/{column}
    default model = sbu@2
    skip: change -->

    | ms | 1 | 8 | change |
    |---|---|---|---|
    | default model | 1.17 | 9.25 | +3 % |

The path is a list of keys with spaces between them. `{row}` is the first cell of the row and `{column}` the head of the column;
a line `label = key` gives the key of a label that differs. In a list, `name=value` selects the record that has that value, and
a number selects by index. `skip:` names columns that hold other things, separated by commas. Each remaining cell holds one
number, or none. The JSON value, rounded to the decimals that the cell prints, must equal the number.

    scripts/check_figures.py            reports each figure that differs
    scripts/check_figures.py --write    writes the values of the JSON files into the documents
"""

import json
import pathlib
import re
import sys

import check_docs

MARK = re.compile(r"<!-- figures:(.*?)(?:-->|\Z)", re.DOTALL)
CODE = re.compile(r"^```.*?^```", re.DOTALL | re.MULTILINE)
NUMBER = re.compile(r"(?<![\w.])[-+]?(?:\d[\d,]*(?:\.\d+)?|\.\d+)")


class Problem(Exception):
    """What is wrong with a mark or a cell."""


def label(cell):
    return re.sub("[*`]", "", cell).strip()


def cells_of(line):
    return line.strip().strip("|").split("|")


class Mark:
    """The comment in front of a table."""

    def __init__(self, text):
        first, *rest = text.strip().splitlines() or [""]
        self.file, separator, path = first.partition(": ")
        if not separator:
            raise Problem(f'mark: expected "file: path", got "{first}"')
        self.path, self.keys, self.skipped = path.split(), {}, set()
        for line in filter(None, map(str.strip, rest)):
            name, separator, key = line.rpartition(" = ")
            if line.startswith("skip: "):
                self.skipped = {name.strip() for name in line.removeprefix("skip: ").split(",")}
            elif separator:
                self.keys[name.strip()] = key.strip()
            else:
                raise Problem(f'mark: expected "label = key" or "skip: columns", got "{line}"')

    def value(self, document, row, column):
        """The number in the JSON document for a cell."""
        labels = {"{row}": self.keys.get(row, row), "{column}": self.keys.get(column, column)}
        for step in self.path:
            for place, key in labels.items():
                step = step.replace(place, key)
            document = descend(document, step)
        if isinstance(document, bool) or not isinstance(document, (int, float)):
            raise Problem(f"expected a number in {self.file}, got {json.dumps(document)[:40]}")
        return document


def descend(document, step):
    """The part of a JSON document that one key of a path names."""
    if isinstance(document, list):
        name, separator, wanted = step.partition("=")
        found = ([item for item in document if str(item.get(name)) == wanted] if separator else
                 document[int(step):int(step) + 1] if step.isdigit() else [])
        if len(found) == 1:
            return found[0]
    elif isinstance(document, dict) and step in document:
        return document[step]
    raise Problem(f'expected a value for the key "{step}", got none')


def rounded(value, printed):
    """`value` in the form of `printed`: as many decimals, commas, and a leading zero if it has one."""
    decimals = len(printed.partition(".")[2])
    text = f"{value:{'+' if printed[0] == '+' else ''}{',' if ',' in printed else ''}.{decimals}f}"
    return re.sub(r"^([-+]?)0\.", r"\1.", text) if re.match(r"[-+]?\.", printed) else text


def check_cell(mark, document, row, column, cell):
    """The cell with its number as the JSON document has it."""
    numbers = NUMBER.findall(cell)
    if not numbers:
        return cell
    if len(numbers) > 1:
        raise Problem(f'expected one number in a cell, got "{label(cell)}"')
    value = mark.value(document, row, column)
    return NUMBER.sub(lambda _: rounded(value, numbers[0]), cell)


def check_table(root, mark, lines, number):
    """Yields (line number, line as it must read, problems) for each wrong row of the table at lines[number]."""
    document = json.loads((root / mark.file).read_text(encoding="utf-8"))
    heads = [label(cell) for cell in cells_of(lines[number])]
    if unknown := mark.skipped - set(heads):
        raise Problem(f'mark: expected "skip:" to name columns, got "{", ".join(sorted(unknown))}"')
    for place in range(number + 2, len(lines)):
        if not lines[place].startswith("|"):
            return
        cells, problems = cells_of(lines[place]), []
        for index, (column, cell) in enumerate(zip(heads[1:], cells[1:]), start=1):
            if column in mark.skipped:
                continue
            try:
                cells[index] = check_cell(mark, document, label(cells[0]), column, cell)
                if cells[index] != cell:
                    problems.append(f'row "{label(cells[0])}", column "{column}": expected '
                                    f"{label(cells[index])} as in {mark.file}, got {label(cell)}")
            except Problem as problem:
                problems.append(f'row "{label(cells[0])}", column "{column}": {problem}')
        if problems:
            yield place, "|" + "|".join(cells) + "|", problems


def check_text(root, text):
    """Returns the text as it must read, its problems as (line, message), and how many tables it marks."""
    lines, problems, tables = text.split("\n"), [], 0
    blanked = CODE.sub(lambda code: " " * len(code[0]), text)  # an example is no mark
    for match in MARK.finditer(blanked):
        tables += 1
        number = text.count("\n", 0, match.end()) + 1
        try:
            while number < len(lines) and not lines[number].strip():
                number += 1
            if number >= len(lines) or not lines[number].startswith("|"):
                raise Problem("mark: expected a table below it, got none")
            for place, line, found in check_table(root, Mark(match[1]), lines, number):
                lines[place] = line
                problems += [(place + 1, message) for message in found]
        except (Problem, OSError, ValueError) as problem:
            problems.append((number, str(problem)))
    return "\n".join(lines), problems, tables


def main(arguments, root=pathlib.Path(__file__).resolve().parent.parent):
    if arguments not in ([], ["--write"]):
        sys.exit(__doc__)
    found, tables = [], 0
    for document in check_docs.documents_of(root):
        text = (root / document).read_text(encoding="utf-8")
        wanted, problems, marked = check_text(root, text)
        tables += marked
        if arguments and wanted != text:
            (root / document).write_text(wanted, encoding="utf-8")
            problems = check_text(root, wanted)[1]
        found += [f"{document}:{line}: {message}" for line, message in problems]
    for problem in found:
        print(problem, file=sys.stderr)
    if found:
        return 1
    print(f"Figures: tables that agree with their files: {tables}.")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
