"""Sphinx configuration of the site that scripts/build_site.sh builds. The source folder is the
repository's root, so that Sphinx reads every document in place and checks its links unchanged."""

import fnmatch
import pathlib
import posixpath
import re
import sys

ROOT = pathlib.Path(__file__).parents[2]
sys.path[:0] = [str(ROOT / "client" / "python"), str(ROOT / "client" / "viewer"),
                str(ROOT / "docs" / "site")]

import element  # noqa: E402
from notebook_parser import NotebookParser  # noqa: E402

project = "Duet"
copyright = "the Duet authors"  # noqa: A001 (Sphinx wants this name)
version = release = re.search(r"project\(duet VERSION ([\d.]+)",
                              (ROOT / "CMakeLists.txt").read_text(encoding="utf-8"))[1]

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon"]
root_doc = "docs/site/index"
source_suffix = {".md": "markdown", ".ipynb": "notebook"}
include_patterns = ["*.md", "client/**.ipynb", "docs/**.md", "client/**.md", "deploy/**.md", "model/**.md",
                    "benchmarks/**.md", "tests/**.md", "samples/**.md", "recipes/**.md",
                    "contrib/**.md"]
exclude_patterns = ["**/node_modules/**"]

# Links may point to any heading, as on GitHub.
myst_heading_anchors = 4
suppress_warnings = ["myst.header"]  # documents may begin below the first level
nitpicky = False

autodoc_member_order = "bysource"
autodoc_typehints = "signature"
autodoc_typehints_format = "short"
python_use_unqualified_type_names = True
autodoc_type_aliases = {"Positions": "Positions", "Labels": "Labels", "Path": "Path",
                        "Shown": "Shown", "npt.ArrayLike": "ArrayLike"}
napoleon_google_docstring = True

html_theme = "furo"
html_title = f"Duet {version}"
html_static_path = ["style.css"]
html_css_files = ["style.css"]
html_extra_path = ["extra"]
html_copy_source = False
html_show_sourcelink = False
html_show_sphinx = False
# No fonts or scripts from other hosts.
html_theme_options = {
    "light_css_variables": {"color-brand-primary": "#0b6e6e", "color-brand-content": "#0b6e6e"},
    "dark_css_variables": {"color-brand-primary": "#4cc4c4", "color-brand-content": "#4cc4c4"},
}


ANCHOR = re.compile(r'^<a id="([^"]+)"></a>$', re.MULTILINE)
ANCHOR_LINK = re.compile(r"\[([^\]]*)\]\(#([^)]+)\)")
TITLED = re.compile(r"^.*<|>$")
TOCTREE = re.compile(r"^```\{toctree\}\n(.*?)^```$", re.MULTILINE | re.DOTALL)
# Pages below a page in the sidebar. "*" stands for every document that is in no other list.
BELOW = {
    "docs/results/README": ["Every table and figure <report>"],
    "docs/decisions/README": ["0*"],
    "docs/README": ["*"],
}


def adapt_source(app, docname, source):
    """Adapts a document to MyST, which does not resolve links to <a id>, and adds its toctree."""
    anchors = set(ANCHOR.findall(source[0]))
    source[0] = ANCHOR_LINK.sub(
        lambda link: f'<a href="#{link[2]}">{link[1]}</a>' if link[2] in anchors else link[0],
        source[0])
    if docname in BELOW:
        entries = the_rest(app.env.found_docs) if BELOW[docname] == ["*"] else BELOW[docname]
        source[0] += "\n```{toctree}\n:hidden:\n:glob:\n\n" + "\n".join(entries) + "\n```\n"


def the_rest(documents):
    """Absolute paths of the documents that are in neither the index nor another list."""
    index = (ROOT / f"{root_doc}.md").read_text(encoding="utf-8")
    lists = [(root_doc, [line for block in TOCTREE.findall(index) for line in block.splitlines()]),
             *BELOW.items()]
    patterns = [posixpath.normpath(posixpath.join(posixpath.dirname(page), TITLED.sub("", entry)))
                for page, entries in lists for entry in entries
                if entry not in ("", "*") and not entry.startswith(":")]
    return [f"/{name}" for name in sorted(documents - {root_doc})
            if not any(fnmatch.fnmatch(name, pattern) for pattern in patterns)]


def add_element(app, failure):
    """Writes the script of <duet-motion> for the pages that show motion."""
    if failure is None:
        element.main([str(pathlib.Path(app.outdir) / "_static" / "duet-motion.js")])


def setup(app):
    app.connect("build-finished", add_element)
    app.add_source_parser(NotebookParser)
    app.connect("source-read", adapt_source)
