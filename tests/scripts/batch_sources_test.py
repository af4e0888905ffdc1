#!/usr/bin/env python3
"""Shows which names cpp_names.py finds, and that batch_sources.py keeps files apart that would change each other's meaning."""

import contextlib
import io
import unittest

import batch_sources
import cpp_names
import source_tree
import test_project


def outside(code, space="duet::motion"):
    return f"namespace {space} {{\n{code}\n}}  // namespace {space}\n"


def inside(code, space="duet::motion"):
    return outside(f"namespace {{\n{code}\n}}  // namespace", space)


class NamesTest(unittest.TestCase):
    def own(self, code):
        return set(cpp_names.read_names(code).own)

    def test_every_kind_of_declaration_is_found(self):
        for code, names in (("constexpr double kUp = 1;", {"kUp"}),
                            ("constexpr std::array<int, 2> kPair = {1, 2};\nconst char* const kNames[] = {\"a\"};", {"kPair", "kNames"}),
                            ("const int kBraced{3};\nconstexpr int kByte = 1, kShort = F(2, 3),\n              kFloat = 4;", {"kBraced", "kByte", "kShort", "kFloat"}),
                            ("std::map<int, std::function<void(int)>> Table(int a, Row b) {\n  return Inner(a);\n}", {"Table"}),
                            ("template <typename T>\nT Twice(T x) { return x + x; }", {"Twice"}),
                            ("bool Declared(int x);", {"Declared"}),
                            ("[[maybe_unused]] void Marked() {}", {"Marked"}),
                            ("struct Row {\n  int cells;\n  void Fill();\n};\nclass Table final : public Base {};", {"Row", "Table"}),
                            ("struct sigaction before;\nstruct Later;\nstruct Row Made(int x) { return {}; }", {"before", "Later", "Made"}),
                            ("enum class Kind { kA };\nenum { kOld, kOlder = 2 };", {"Kind", "kOld", "kOlder"}),
                            ("using Json = nlohmann::json;\nusing motion::Vec3;\nnamespace v1 = duet::v1;", {"Json", "Vec3", "v1"}),
                            ("MATCHER_P(IsNear, x, \"\") { return true; }", {"IsNear"}),
                            ("TEST(ClipTest, Reads) { int local = 0; }\nclass ClipTest : public Test {};", {"ClipTest"}),
                            ("void A() { if (x) { y(); } }\nvoid B() {}", {"A", "B"})):
            with self.subTest(code):
                self.assertEqual(self.own(inside(code)), names)

    def test_text_and_comments_declare_nothing(self):
        self.assertEqual(self.own(inside('// int a;\n/* int b; */ const char* kText = "{ int c; ";\nconst char* kRaw = R"x(int d; {)x";\n'
                                         "const char kBrace = '{';\nconst int kMany = 1'000;")), {"kText", "kRaw", "kBrace", "kMany"})

    def test_effects_that_no_name_shows_set_a_file_alone(self):
        for code in ("#define MACRO 1\n", "#pragma GCC diagnostic push\n", inside("Vec operator+(Vec a, Vec b) { return a; }"),
                     "#ifdef X\nvoid F() {\n#else\nvoid G() {\n#endif\n}\n", "using namespace std;\n", "namespace {\nint at_top;\n}  // namespace\n"):
            with self.subTest(code):
                self.assertTrue(cpp_names.read_names(code).alone)
        self.assertFalse(cpp_names.read_names('#include "a.h"\n#ifdef X\n#endif\n' + inside("void F() { using namespace x; }")).alone)

    def test_mentions_have_their_qualifiers(self):
        self.assertEqual(cpp_names.mentioned_names("f(motion::f, engine:: f, Table<int>::g, ::h)"),
                         {"f": {"", "motion", "engine"}, "motion": {""}, "engine": {""}, "Table": {""}, "int": {""}, "g": {"int"}, "h": {"g"}})


class BatchesTest(test_project.ProjectTestCase):
    def batches(self, size=8):
        tree = source_tree.SourceTree(self.root)
        return [[source.removeprefix("model/") for source in batch]
                for batch in batch_sources.Batches(tree, size).of(tree.files(".cc"))]

    def test_files_that_would_change_each_other_are_kept_apart(self):
        length = inside("int Length(int x) { return x; }")
        call = outside("int F() { return Length(1); }")
        together, apart = [["a.cc", "b.cc"]], [["a.cc"], ["b.cc"]]
        for first, second, expected in (
                (inside("constexpr int kUp = 1;"), inside("constexpr int kDown = 1;"), together),
                (inside("constexpr int kUp = 1;"), inside("constexpr int kUp = 2;"), apart),
                (length, call, apart),
                (length, outside("int F() { return motion::Length(1); }"), apart),
                (length, outside("int F() { return Length(1); }", "duet::motion::inner"), apart),
                (length, outside("namespace m = duet::motion;\nint F() { return m::Length(1); }", "duet::other"), apart),
                (length, inside("int Length(int x) { return x + 1; }", "duet::formats"), together),
                (length, outside("int F() { return formats::Length(1); }"), together),
                (call, length, together),  # an own name is not seen by the files before
                # A static function is reached from every namespace, through the arguments of a call.
                (outside("static int Length(Clip x) { return 1; }"),
                 outside("int F(motion::Clip x) { return Length(x); }", "duet::formats"), apart),
                (inside("using Json = nlohmann::json;"), inside("using Json = nlohmann::json;"), together),
                (inside("using Json = nlohmann::json;"), inside("using Json = other::json;"), apart)):
            with self.subTest(first=first, second=second):
                self.write("model/a.cc", text=first)
                self.write("model/b.cc", text=second)
                self.assertEqual(self.batches(), expected)

    def test_header_after_an_own_name_counts(self):
        self.write("model/deep.h", text=outside("inline int Deep() { return Length(1); }"))
        self.write("model/wide.h", "model/deep.h")
        self.write("model/a.cc", text=inside("int Length(int x) { return x; }"))
        self.write("model/b.cc", "model/wide.h")
        self.assertEqual(self.batches(), [["a.cc"], ["b.cc"]])

    def test_batch_has_at_most_its_size_and_a_macro_none(self):
        for name in "abcd":
            self.write(f"model/{name}.cc", text="#define X 1\n" if name == "b" else "")
        self.assertEqual(self.batches(size=2), [["a.cc", "c.cc"], ["b.cc"], ["d.cc"]])

    def test_cmake_gets_a_group_for_each_batch_of_several(self):
        for name in "abc":
            self.write(f"model/{name}.cc", text="#define X 1\n" if name == "c" else "")
        self.target("duet_model", ["model/a.cc", "model/b.cc", "model/c.cc", "build/release/x.pb.cc", "model/x.S"])
        output = io.StringIO()
        with contextlib.redirect_stdout(output):
            batch_sources.main([str(self.build_dir), "duet_model"])
        self.assertEqual(output.getvalue(), f'set_source_files_properties("{self.root}/model/a.cc" "{self.root}/model/b.cc" '
                                            "TARGET_DIRECTORY duet_model PROPERTIES UNITY_GROUP 0)\n")


if __name__ == "__main__":
    unittest.main()
