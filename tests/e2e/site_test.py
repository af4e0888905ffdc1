"""The site is made without a warning, its links lead somewhere, and its pages load nothing from
elsewhere."""

import html.parser
import importlib.util
import pathlib
import tempfile
import unittest
import urllib.parse

import tools

for module, package in (("sphinx", "python3-sphinx"), ("myst_parser", "python3-myst-parser"),
                        ("furo", "furo"), ("grpc", "python3-grpcio")):
    if importlib.util.find_spec(module) is None:
        tools.skip(f"no Python module {module}; install the package {package}")


class Page(html.parser.HTMLParser):
    """What a page links to, what it loads, and what may be linked to in it."""

    def __init__(self, path):
        super().__init__()
        self.links, self.loads, self.ids = [], [], set()
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attrs):
        values = dict(attrs)
        self.ids.update(values[name] for name in ("id", "name") if values.get(name))
        if tag == "a" and values.get("href"):
            self.links.append(values["href"])
        if tag in ("img", "script", "iframe") and values.get("src"):
            self.loads.append(values["src"])
        if tag == "link" and values.get("rel") in ("stylesheet", "icon"):
            self.loads.append(values["href"])


class SiteTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.site = pathlib.Path(folder.name).resolve()
        cls.made = tools.run(tools.SOURCE / "scripts" / "build_site.sh", cls.site, "--no-cpp",
                             timeout=800)
        cls.pages = {path: Page(path) for path in cls.site.rglob("*.html")}

    def test_site_builds_without_warnings(self):
        self.assertEqual(self.made.returncode, 0, self.made.stderr)
        names = {path.relative_to(self.site).as_posix() for path in self.pages}
        for name in ("index.html", "docs/site/index.html", "docs/site/python.html", "README.html",
                     "docs/guides/tour.html", "docs/guides/cookbook.html",
                     "docs/results/report.html",
                     "client/python/examples/mixing_reactions.html"):
            self.assertIn(name, names)

    def test_links_have_targets(self):
        for path, page in self.pages.items():
            for link in page.links + page.loads:
                parts = urllib.parse.urlsplit(link)
                if parts.scheme or parts.netloc:
                    continue
                target = (path.parent / urllib.parse.unquote(parts.path)).resolve()
                target = path if not parts.path else target
                self.assertTrue(target.is_file(), f"{path.name} links to {link}")
                # Furo's own links to the page's top have no name.
                if parts.fragment and target in self.pages:
                    self.assertIn(urllib.parse.unquote(parts.fragment), self.pages[target].ids,
                                  f"{path.name} links to {link}")

    def test_pages_load_nothing_from_other_hosts(self):
        for path, page in self.pages.items():
            for load in page.loads:
                self.assertFalse(urllib.parse.urlsplit(load).netloc, f"{path.name} loads {load}")

    def test_python_reference_lists_the_public_names(self):
        text = (self.site / "docs/site/python.html").read_text(encoding="utf-8")
        for name in ("duet_motion.Client.synthesize", "duet_motion.Motion",
                     "duet_motion.errors.InvalidRequestError", "duet_motion.sets.read_set",
                     "duet_motion.files.read_motion", "duet_motion.aio.Client",
                     "duet_motion.SynthesisRequest.seed"):
            self.assertIn(f'id="{name}"', text)


if __name__ == "__main__":
    tools.main()
