#!/usr/bin/env python3
"""Shows what doxygen_filter.py makes of headers and proto files."""

import unittest

import doxygen_filter


def cpp(text):
    return [line for line in doxygen_filter.translate(text.splitlines()) if line.strip("/ ")]


def proto(text):
    return doxygen_filter.proto_as_cpp(text.splitlines())[:-1]


class DoxygenFilterTest(unittest.TestCase):
    def test_comment_belongs_to_what_follows(self):
        self.assertEqual(cpp("// One moment.\nstruct Frame {};"),
                         ["/// One moment.", "struct Frame {};"])

    def test_comment_before_a_blank_line_is_the_file_s(self):
        self.assertEqual(cpp("// Formats.\n\nstruct Frame {};")[0], "/// \\file")

    def test_comment_behind_a_member_belongs_to_it(self):
        self.assertEqual(cpp("  int joints;  // how many"), ["  int joints;  ///< how many"])

    def test_comment_behind_a_member_may_go_on_below(self):
        self.assertEqual(cpp("  int joints;  // how many\n               // there are\n  int x;"),
                         ["  int joints;  ///< how many there are", "  int x;"])

    def test_columns_keep_their_layout(self):
        self.assertEqual(cpp("// Shapes:  [frames]\nint f();"),
                         ["/// <pre>", "/// Shapes:  [frames]", "/// </pre>", "int f();"])

    def test_markup_is_shown_as_written(self):
        self.assertEqual(cpp("// vector<int> and `code` \\a\nint f();")[0],
                         "/// vector&#60;int&#62; and <tt>code</tt> &#92;a")

    def test_code_is_untouched(self):
        for line in ('const char* url = "http://a";', "int f();", "#include <a.h>"):
            self.assertEqual(cpp(line), [line])

    def test_messages_are_structs(self):
        self.assertEqual(proto("message Pose {\n  repeated a.Vec3 joints = 1;\n}"),
                         ["struct Pose {", "  repeated<a::Vec3> joints;", "};"])
        self.assertEqual(proto("  optional uint32 frames = 2 [json_name = \"x\"];"),
                         ["  optional<uint32> frames;"])

    def test_services_are_classes(self):
        self.assertEqual(
            proto("service S {\n  rpc Get(Request) returns (stream Reply);\n}"),
            ["class S { public:", "  stream<Reply> Get(Request request);", "};"])

    def test_enums_and_packages(self):
        self.assertEqual(proto("package duet.v1;\nenum E {\n  E_A = 0;\n}"),
                         ["namespace duet::v1 {", "enum E {", "  E_A = 0,", "};"])

    def test_what_is_for_the_compiler_alone_is_dropped(self):
        self.assertEqual(proto('syntax = "proto3";\nimport "a.proto";\n  reserved 3;'), [""] * 3)


if __name__ == "__main__":
    unittest.main()
