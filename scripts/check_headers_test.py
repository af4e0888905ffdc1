#!/usr/bin/env python3
"""Shows that check_headers.py finds the header that leans on another, and skips what is proven."""

import contextlib
import io
import unittest

import build_tree
import check_headers
import source_tree
import test_project


class CheckHeadersTest(test_project.ProjectTestCase):
    def setUp(self):
        super().setUp()
        self.write("model/clip.h", text="#pragma once\nstruct Clip {};\n")
        self.write("model/clip.cc", "model/clip.h")
        self.compile_command("model/clip.cc")

    def run_check(self, *arguments):
        output = io.StringIO()
        with contextlib.redirect_stdout(output), contextlib.redirect_stderr(output):
            status = check_headers.main([*arguments, str(self.build_dir)])
        return status, output.getvalue()

    def test_sufficient_headers_pass(self):
        self.write("model/pair.h", "model/clip.h", text="#pragma once\nstruct Pair { Clip a; };\n")
        status, output = self.run_check()
        self.assertEqual(status, 0, output)
        self.assertIn("1 come first in a source file, 1 of the other 1 compile by themselves", output)

    def test_header_that_leans_on_another_fails_by_name(self):
        self.write("model/pair.h", text="#pragma once\nstruct Pair { Clip a; };\n")
        status, output = self.run_check()
        self.assertEqual(status, 1)
        self.assertIn("model/pair.h", output)

    def test_header_without_a_guard_fails(self):
        self.write("model/pair.h", text="struct Pair {};\n")
        self.assertEqual(self.run_check()[0], 1)

    def test_torch_headers_can_be_left_out(self):
        self.write("model/network.h", "torch/no_such_header.h")
        self.assertEqual(self.run_check("--torch-free")[0], 0)
        self.assertEqual(self.run_check()[0], 1)

    def test_file_with_a_precompiled_header_proves_nothing(self):
        self.write("model/network.cc", "model/network.h")
        self.compile_command("model/network.cc", "-include", "cmake_pch.hxx")
        proven = check_headers.proven_by_the_build(
            source_tree.SourceTree(self.root), build_tree.compile_commands(self.build_dir))
        self.assertEqual(proven, {"model/clip.h"})

    def test_flags_are_those_of_the_nearest_source(self):
        sources = ["model/a/x.cc", "model/a/clip.cc", "model/b/pair.cc", "server/x.cc"]
        for header, expected in (("model/a/clip.h", "model/a/clip.cc"),
                                 ("model/b/only.h", "model/b/pair.cc"),
                                 ("server/deep/only.h", "server/x.cc")):
            self.assertEqual(check_headers.nearest_source(header, sources), expected)


if __name__ == "__main__":
    unittest.main()
