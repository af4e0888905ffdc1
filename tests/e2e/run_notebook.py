#!/usr/bin/env python3
"""Runs a notebook's cells from top to bottom in one process without Jupyter; names the cell that fails.

    tests/e2e/run_notebook.py NOTEBOOK.ipynb            runs it
    tests/e2e/run_notebook.py NOTEBOOK.ipynb --write    also stores its output and pictures in the notebook

A cell's outputs are its printed text, its last expression (unless it ends with a semicolon) and its matplotlib
figures, as in Jupyter.
"""

import argparse
import ast
import base64
import contextlib
import io
import json
import os
import pathlib
import sys


def outputs_of(source, name, variables):
    """Runs a cell and returns its outputs in the notebook's form."""
    from matplotlib import pyplot
    tree = ast.parse(source, name)
    last = tree.body.pop() if tree.body and isinstance(tree.body[-1], ast.Expr) else None
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        exec(compile(tree, name, "exec"), variables)
        value = last and eval(compile(ast.Expression(last.value), name, "eval"), variables)
        if value is not None and not source.rstrip().endswith(";"):
            print(repr(value))
    outputs = []
    if printed.getvalue():
        outputs.append({"output_type": "stream", "name": "stdout",
                        "text": printed.getvalue().splitlines(keepends=True)})
    for number in pyplot.get_fignums():
        outputs.append(picture(pyplot.figure(number)))
    pyplot.close("all")
    return outputs


def picture(figure):
    data = io.BytesIO()
    figure.savefig(data, format="png", dpi=80, bbox_inches="tight")
    return {"output_type": "display_data", "metadata": {},
            "data": {"image/png": base64.b64encode(data.getvalue()).decode() + "\n"}}


def run(path):
    """The notebook with the outputs of a run."""
    notebook = json.loads(path.read_text(encoding="utf-8"))
    variables = {"__name__": "__main__"}
    count = 0
    for index, cell in enumerate(notebook["cells"]):
        if cell["cell_type"] != "code":
            continue
        count += 1
        cell["execution_count"] = count
        cell["outputs"] = outputs_of("".join(cell["source"]), f"{path.name}, cell {index}",
                                     variables)
    return notebook


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("notebook", type=pathlib.Path)
    parser.add_argument("--write", action="store_true", help="keep the outputs in the notebook")
    options = parser.parse_args(arguments)
    path = options.notebook.resolve()
    os.environ["MPLBACKEND"] = "agg"
    os.chdir(path.parent)
    notebook = run(path)
    if options.write:
        text = json.dumps(notebook, indent=1, ensure_ascii=False) + "\n"
        path.write_text(text, encoding="utf-8")
    outputs = [output for cell in notebook["cells"] for output in cell.get("outputs", ())]
    pictures = sum(output["output_type"] == "display_data" for output in outputs)
    print(f"{path.name}: ran top to bottom, {pictures} pictures.")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
