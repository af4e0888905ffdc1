#!/usr/bin/env python3
"""Shows that check_docs.py finds what it is for, in a made-up project."""

import unittest

import check_docs
import test_project


class CheckDocsTest(test_project.ProjectTestCase):
    def setUp(self):
        super().setUp()
        self.write("model/motion/clip.h")
        self.write("docs/guide.md")

    def problems(self, document, text):
        self.write(document, text=text)
        return list(check_docs.problems(self.root, document))

    def test_what_is_there_passes(self):
        self.assertEqual(self.problems("docs/a.md", "[g](guide.md#top) `model/motion/clip.h` "
                                       "`model/motion/clip` `model/*/clip.{h,h}` `bin/duet` "
                                       "[web](https://example.org)\n"), [])

    def test_a_link_to_nothing_is_found_with_its_line(self):
        self.assertEqual(self.problems("docs/a.md", "\n[g](gone.md)\n"),
                         [(2, "links to gone.md, which does not exist")])

    def test_a_path_to_nothing_is_found(self):
        self.assertEqual(self.problems("README.md", "`model/motion/clip.{h,cc}`\n"),
                         [(1, "names model/motion/clip.cc, which does not exist")])

    def test_the_past_may_name_what_is_gone_but_not_link_to_it(self):
        self.assertEqual(self.problems("CHANGELOG.md", "`model/gone.h` [g](gone.md)\n"),
                         [(1, "links to gone.md, which does not exist")])

    def test_what_is_made_is_no_document(self):
        self.write("build/a.md")
        self.write(".cache/a.md")
        self.write("README.md")
        self.assertEqual(check_docs.documents_of(self.root), ["README.md", "docs/guide.md"])


if __name__ == "__main__":
    unittest.main()
