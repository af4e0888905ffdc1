#!/usr/bin/env python3
"""Shows what source_tree.py and build_tree.py read out of a project."""

import unittest

import build_tree
import source_tree
import test_project


class SourceTreeTest(test_project.ProjectTestCase):
    def setUp(self):
        super().setUp()
        self.tree = source_tree.SourceTree(self.root)

    def test_includes_are_found_in_order_and_comments_are_not(self):
        self.write("model/a.cc", "model/a.h", "vector", text='// #include "model/b.h"\n')
        self.assertEqual(self.tree.includes("model/a.cc"), ("model/a.h", "vector"))

    def test_reach_goes_through_headers_and_ends_in_a_circle(self):
        self.write("model/a.h", "model/b.h")
        self.write("model/b.h", "model/a.h", "torch/types.h")
        self.assertEqual(self.tree.reach("model/a.h"), {"model/a.h", "model/b.h", "torch/types.h"})


class BuildTreeTest(test_project.ProjectTestCase):
    def test_torch_is_seen_through_private_links(self):
        self.target("duet_torch", [])
        self.target("duet_network", ["model/network.cc"], private=["duet_torch"])
        self.target("duet_motion", ["model/motion.cc"], public=["absl::status"])
        self.target("duet_eval", ["model/eval.cc"], private=["duet_motion", "duet_network"])
        targets = build_tree.read_targets(self.build_dir)
        self.assertFalse(build_tree.is_torch_free(targets, "duet_eval"))
        self.assertTrue(build_tree.is_torch_free(targets, "duet_motion"))
        self.assertEqual(build_tree.closure(targets, "duet_motion"),
                         {"duet_motion", "absl::status"})

    def test_flags_are_those_that_any_compiler_takes(self):
        words = ("ccache c++ -DX=1 -I/a -isystem /b -O3 -fPIC -Wall -std=c++17 -Winvalid-pch "
                 "-include cmake_pch.hxx -o a.o -c a.cc").split()
        self.assertEqual(build_tree.portable_flags(words),
                         ["-DX=1", "-I/a", "-isystem/b", "-std=c++17"])

    def test_files_of_a_batch_have_the_command_of_the_batch(self):
        self.batch("model/a.cc", "model/b.cc")
        self.compile_command("model/c.cc")
        commands = build_tree.compile_commands(self.build_dir)
        self.assertEqual(list(commands), ["model/a.cc", "model/b.cc", "model/c.cc"])
        self.assertIn("-DBATCHED", commands["model/b.cc"])
        self.assertEqual([file for file, words in commands.items() if "-include" in words], ["model/a.cc", "model/b.cc"])


if __name__ == "__main__":
    unittest.main()
