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

    def test_public_declarations_are_not_own(self):
        code = "namespace duet {\nint Public(int x) { return x; }\nvoid Clip::Read() {}\nstatic int Hidden() { return 1; }\n}  // namespace duet\n"
        self.assertEqual(self.own(code), {"Hidden"})

    def test_effects_that_no_name_shows_set_a_file_alone(self):
        for code in ("#define MACRO 1\n", "#pragma GCC diagnostic push\n", inside("Vec operator+(Vec a, Vec b) { return a; }"),
                     "#ifdef X\nvoid F() {\n#else\nvoid G() {\n#endif\n}\n", "using namespace std;\n", "namespace {\nint at_top;\n}  // namespace\n"):
            with self.subTest(code):
                self.assertTrue(cpp_names.read_names(code).alone)
        self.assertFalse(cpp_names.read_names('#include "a.h"\n#ifdef X\n#endif\n' + inside("void F() { using namespace x; }")).alone)

    def test_members_and_names_of_the_library_are_not_mentions(self):
        self.assertEqual(set(cpp_names.mentioned_names("a.b(c->d, std::e, motion::f)")), {"a", "c", "std", "motion", "f"})

    def test_mentions_have_their_qualifiers(self):
        self.assertEqual(cpp_names.mentioned_names("f(motion::f, engine:: f, Table<int>::g, ::h)"),
                         {"f": {"", "motion", "engine"}, "motion": {""}, "engine": {""}, "Table": {""}, "int": {""}, "g": {"int"}, "h": {"g"}})


class BatchesTest(test_project.ProjectTestCase):
    def batches(self, size=8):
        tree = source_tree.SourceTree(self.root)
        return [[source.removeprefix("model/") for source in batch]
                for batch in batch_sources.Batches(tree, size).of(tree.files(".cc"))]

    def test_files_that_keep_names_apart_share_a_batch(self):
        self.write("model/a.cc", text=inside("constexpr int kUp = 1;"))
        self.write("model/b.cc", text=inside("constexpr int kDown = 1;"))
        self.assertEqual(self.batches(), [["a.cc", "b.cc"]])

    def test_same_own_name_sets_files_apart(self):
        self.write("model/a.cc", text=inside("constexpr int kUp = 1;"))
        self.write("model/b.cc", text=inside("constexpr int kUp = 2;"))
        self.write("model/c.cc", text=inside("void C();"))
        self.assertEqual(self.batches(), [["a.cc", "c.cc"], ["b.cc"]])

    def test_call_that_could_reach_an_overload_of_another_file_sets_apart(self):
        self.write("model/a.cc", text=inside("int Length(int x) { return x; }"))
        for code in (outside("int F() { return Length(1); }"), outside("int F() { return motion::Length(1); }"),
                     outside("int F() { return Length(1); }", "duet::motion::inner"),
                     outside("int F() { return motion::Length(1); }", "duet::other"),
                     outside("namespace m = duet::motion;\nint F() { return m::Length(1); }", "duet::other")):
            with self.subTest(code):
                self.write("model/b.cc", text=code)
                self.assertEqual(self.batches(), [["a.cc"], ["b.cc"]])

    def test_names_of_other_namespaces_share_a_batch(self):
        self.write("model/a.cc", text=inside("int Length(int x) { return x; }"))
        for code in (inside("int Length(int x) { return x + 1; }", "duet::formats"), inside("int F() { return Length(1); }", "duet"),
                     outside("int F() { return formats::Length(1); }")):
            with self.subTest(code):
                self.write("model/b.cc", text=code)
                self.assertEqual(self.batches(), [["a.cc", "b.cc"]])

    def test_static_function_is_reached_from_every_namespace(self):  # through the arguments of a call
        self.write("model/a.cc", text=outside("static int Length(Clip x) { return 1; }"))
        self.write("model/b.cc", text=outside("int F(motion::Clip x) { return Length(x); }", "duet::formats"))
        self.assertEqual(self.batches(), [["a.cc"], ["b.cc"]])

    def test_own_name_is_not_seen_by_files_before(self):
        self.write("model/a.cc", text="namespace duet::motion {\nint F() { return Length(1); }\n}  // namespace duet::motion\n")
        self.write("model/b.cc", text=inside("int Length(int x) { return x; }"))
        self.assertEqual(self.batches(), [["a.cc", "b.cc"]])

    def test_header_after_an_own_name_counts(self):
        self.write("model/deep.h", text=outside("inline int Deep() { return Length(1); }"))
        self.write("model/wide.h", "model/deep.h")
        self.write("model/a.cc", text=inside("int Length(int x) { return x; }"))
        self.write("model/b.cc", "model/wide.h")
        self.assertEqual(self.batches(), [["a.cc"], ["b.cc"]])
        self.write("model/a.cc", "model/deep.h", text=inside("int Length(int x) { return x; }"))  # before its own name
        self.assertEqual(self.batches(), [["a.cc", "b.cc"]])

    def test_equal_aliases_share_a_batch(self):
        self.write("model/a.cc", text=inside("using Json = nlohmann::json;"))
        self.write("model/b.cc", text=inside("using Json = nlohmann::json;"))
        self.write("model/c.cc", text=inside("using Json = other::json;"))
        self.assertEqual(self.batches(), [["a.cc", "b.cc"], ["c.cc"]])

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
