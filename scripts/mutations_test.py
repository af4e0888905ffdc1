#!/usr/bin/env python3
"""Shows which changes mutations.py finds in a C++ text, and which texts it skips."""

import unittest

import mutations


def changes(text):
    """The changes as (before, after)."""
    return [(text[m.start:m.end], m.replacement) for m in mutations.mutations(text)]


class MutationsTest(unittest.TestCase):
    def test_each_kind_of_change_is_found(self):
        for text, expected in {
                "a < b": [("<", "<="), ("<", ">=")], "a == b": [("==", "!=")],
                "x = a + b * c": [("+", "-"), ("*", "/")], "a +\n    b": [("+", "-")],
                "a && b || c": [("&&", "||"), ("||", "&&")],
                "f(3, 0.5f, 1e-6, true)": [("3", "(3 + 1)"), ("0.5f", "(0.5f + 1)"),
                                           ("1e-6", "(1e-6 + 1)"), ("true", "false")],
                "if (a.empty()) {}": [("", "!")], "if (!a) {}": [("!", "")],
                "return f(x);": [("return f(x);", "return {};")],
                'return "a";': [('return "a";', "return {};")],
                "if (f(x) > 0) g(y);": [(">", "<="), (">", ">="), ("0", "(0 + 1)"), ("g(y)", "")],
                "for (T t : n) g(i);": [("g(i)", "")],
                "if (!a) { b(); } else c();": [("!", ""), ("b()", ""), ("c()", "")],
                "a = 1'000; b > c; d = 2'000;": [("a = 1'000", ""), (">", "<="), (">", ">="),
                                                 ("d = 2'000", "")]}.items():
            self.assertEqual(changes(text), expected, text)

    def test_statements_are_deleted(self):
        for statement in ("f(x)", "a.b = c", "a[i] += c", "++n", "n--", "*out = c", "break",
                          "a::b(c)->d(e)", "seats.reserved(n)"):
            self.assertIn((statement, ""), changes(f"{{ {statement}; }}"), statement)

    def test_text_without_effect_is_left_alone(self):
        for text in ("std::vector<int> v", "Clip* c", "const Clip& c", "T&& t", "f(-x)", "a->b",
                     "template <typename T>", "std::cout << x", "p0 = t2.x1",  # no operators, no numbers
                     "{int x{};}", "{MutexLock lock(mutex_);}", "{using a::b;}", 
                     "{const auto it{f(x)};}", "{ v.reserve(n); }", "{ out->names.reserve(n); }",
                     "return absl::OkStatus();", "return nullptr;", "return {};", 'return "";',
                     '// a < b', '/* x = 1; */', '"a && b"', "'<'", '#if A == 1\n', 'R"(if (a) b();)"'):
            self.assertEqual(changes(text), [], text)

    def test_mutation_has_its_line_and_is_applied(self):
        text = "int f(int a) {\n  return a < 3;\n}\n"
        mutation = mutations.mutations(text)[0]
        self.assertEqual((mutation.line, mutation.apply(text)),
                         (2, "int f(int a) {\n  return {};\n}\n"))


if __name__ == "__main__":
    unittest.main()
