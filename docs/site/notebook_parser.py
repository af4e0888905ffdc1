"""Reads a Jupyter notebook as a page: text as Markdown, code and output as blocks, and images."""

import json

from myst_parser.sphinx_ import Parser


def fenced(language, text):
    return f"```{language}\n{text.rstrip()}\n```\n"


def output_as_markdown(output):
    if output["output_type"] == "stream":
        return fenced("text", "".join(output["text"]))
    return f"![]({'data:image/png;base64,' + output['data']['image/png'].strip()})\n"


def as_markdown(notebook):
    parts = []
    for cell in notebook["cells"]:
        source = "".join(cell["source"])
        if cell["cell_type"] == "markdown":
            parts.append(source + "\n")
        elif cell["cell_type"] == "code":
            parts.append(fenced("python", source))
            parts.extend(map(output_as_markdown, cell["outputs"]))
    return "\n".join(parts)


class NotebookParser(Parser):
    supported = ("notebook",)

    def parse(self, inputstring, document):
        super().parse(as_markdown(json.loads(inputstring)), document)
