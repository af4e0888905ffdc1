#!/usr/bin/env python3
"""Shows how fix_links.py rewrites a CMakeLists.txt."""

import unittest

import build_tree
import check_links
import fix_links
import source_tree
import test_project


class FixLinksTest(test_project.ProjectTestCase):
    def setUp(self):
        super().setUp()
        self.write("model/motion/clip.h", "absl/status/status.h")
        self.write("model/motion/clip.cc", "model/motion/clip.h", "absl/strings/str_cat.h")
        self.write("tests/clip_test.cc", "model/motion/clip.h")

    def fix(self, text, public=(), private=()):
        self.target("duet_motion", ["model/motion/clip.cc"], public, private)
        self.target("clip_test", ["tests/clip_test.cc"], private=["GTest::gtest_main"],
                    kind="EXECUTABLE")
        checker = check_links.LinkCheck(build_tree.read_targets(self.build_dir),
                                        source_tree.SourceTree(self.root))
        return fix_links.fix(text, checker)

    def test_links_are_mended_and_the_rest_is_kept(self):
        text = ("# A room.\nduet_library(NAME motion\n  SOURCES clip.cc\n  DEPS absl::time)\n"
                "target_x()\n")
        self.assertEqual(self.fix(text, public=["absl::time"]), (
            "# A room.\nduet_library(NAME motion\n  SOURCES clip.cc\n  DEPS absl::status\n"
            "  PRIVATE_DEPS absl::strings)\ntarget_x()\n"))

    def test_links_that_are_right_stay_as_they_are_written(self):
        text = "duet_library(NAME motion SOURCES clip.cc\n   DEPS absl::status PRIVATE_DEPS a)"
        self.assertEqual(self.fix(text, public=["absl::status"], private=["absl::strings"]), text)

    def test_tests_have_one_list_and_keep_their_labels(self):
        self.assertEqual(
            self.fix("duet_test(NAME clip_test SOURCES clip_test.cc DEPS duet::x "
                     "LABELS unit threads)"),
            "duet_test(NAME clip_test\n  SOURCES clip_test.cc\n  DEPS duet::motion\n"
            "  LABELS unit threads)")

    def test_long_lists_are_wrapped(self):
        lines = fix_links.section("DEPS", [f"duet_library_number_{i}" for i in range(9)])
        self.assertLessEqual(max(map(len, lines[0].split("\n"))), fix_links.WIDTH)
        self.assertTrue(lines[0].split("\n")[1].startswith("       duet::"))


if __name__ == "__main__":
    unittest.main()
