#!/usr/bin/env python3
"""Shows what check_links.py lets through and what it reports."""

import unittest

import build_tree
import check_links
import source_tree
import test_project


class CheckLinksTest(test_project.ProjectTestCase):
    def setUp(self):
        super().setUp()
        self.write("model/motion/clip.h", "vector")
        self.write("model/motion/resample.h", "model/motion/clip.h")
        self.write("model/motion/resample.cc", "model/motion/resample.h", "absl/strings/str_cat.h")
        self.write("model/formats/csv.h", "model/motion/clip.h", "absl/status/statusor.h")
        self.write("model/formats/csv.cc", "model/formats/csv.h", "nlohmann/json.hpp")
        self.motion = dict(sources=["model/motion/resample.cc"], private=["absl::strings"])
        self.formats = dict(sources=["model/formats/csv.cc"],
                            public=["duet_motion", "absl::statusor"],
                            private=["nlohmann_json::nlohmann_json"])

    def checker(self):
        self.targets.clear()
        self.target("duet_motion", **self.motion)
        self.target("duet_formats", **self.formats)
        return check_links.LinkCheck(build_tree.read_targets(self.build_dir),
                                     source_tree.SourceTree(self.root))

    def assert_violation(self, *parts):
        violations = list(self.checker().violations())
        self.assertEqual(len(violations), 1, violations)
        for part in parts:
            self.assertIn(part, violations[0])

    def test_links_that_match_pass(self):
        self.assertEqual(list(self.checker().violations()), [])

    def test_missing_link_is_reported_with_an_example(self):
        self.formats["public"].remove("duet_motion")
        self.assert_violation("duet_formats: does not link duet_motion (PUBLIC)",
                              "model/formats/csv.h includes model/motion/clip.h")

    def test_link_that_comes_with_another_must_still_be_declared(self):
        self.motion["public"] = ["absl::statusor"]
        self.write("model/motion/clip.h", "absl/status/statusor.h")
        self.formats["public"].remove("absl::statusor")
        self.assert_violation("duet_formats: does not link absl::statusor (PUBLIC)")

    def test_unused_link_is_reported(self):
        self.motion["private"].append("absl::time")
        self.assert_violation("duet_motion: links absl::time but does not include it")

    def test_private_link_that_a_header_shows_is_reported(self):
        self.write("model/motion/clip.h", "absl/strings/string_view.h")
        self.assert_violation("duet_motion: links absl::strings: expected PUBLIC, got PRIVATE")

    def test_public_link_that_no_header_shows_is_reported(self):
        self.motion["public"] = self.motion.pop("private")
        self.assert_violation("duet_motion: links absl::strings: expected PRIVATE, got PUBLIC")

    def test_internal_headers_count_as_private(self):
        self.write("model/motion/internal/text.h", "absl/strings/string_view.h")
        self.assertEqual(list(self.checker().violations()), [])

    def test_header_without_a_source_belongs_to_the_innermost_library_of_its_folder(self):
        self.write("model/motion/view.cc", "model/motion/clip.h")
        self.targets.clear()
        self.target("duet_motion", **self.motion)
        self.target("duet_view", sources=["model/motion/view.cc"], public=[],
                    private=["duet_motion"])
        owners = check_links.Owners(build_tree.read_targets(self.build_dir))
        self.assertEqual(owners.of("model/motion/clip.h"), {"duet_motion"})
        self.assertEqual(owners.of("model/motion/view.h"), {"duet_view"})
        self.assertEqual(owners.of("model/motion/mocks/clip.h"), {"duet_motion"})

    def test_header_whose_source_is_not_built_needs_nothing(self):
        self.write("model/motion/training.h", "absl/status/statusor.h")
        self.assert_violation("duet_motion: does not link absl::statusor (PUBLIC)")
        self.write("model/motion/training.cc", "model/motion/training.h")
        self.assertEqual(list(self.checker().violations()), [])

    def test_generated_header_belongs_to_the_library_that_makes_it(self):
        self.write("server/wire.cc", "duet/v1/motion.pb.h")
        checker = self.checker()
        self.target("duet_proto", sources=["build/release/proto/gen/duet/v1/motion.pb.h"])
        self.target("duet_wire", sources=["server/wire.cc"], private=["duet_proto"])
        checker = check_links.LinkCheck(build_tree.read_targets(self.build_dir), checker.tree)
        self.assertEqual(list(checker.violations()), [])

    def test_library_linked_by_its_file_is_known(self):
        self.assertEqual(check_links.link_name("/usr/lib/libopenblas.so"), "openblas")
        self.assertEqual(check_links.link_name("absl::status"), "absl::status")

    def test_threads_are_optional(self):
        self.motion["private"].append("Threads::Threads")
        self.assert_violation("links Threads::Threads but does not include it")
        self.write("model/motion/resample.h", "model/motion/clip.h", "mutex")
        self.assertEqual(list(self.checker().violations()), [])

    def test_what_is_wanted_is_suggested(self):
        self.formats.update(public=[], private=["absl::time"])
        checker = self.checker()
        self.assertEqual(checker.wanted(checker.targets["duet_formats"]),
                         (["absl::statusor", "duet_motion"], ["nlohmann_json::nlohmann_json"]))


if __name__ == "__main__":
    unittest.main()
