#!/usr/bin/env python3
"""Shows which changes mutations.py finds in a C++ text, and which it leaves alone."""

import unittest

import mutations


def changes(text, kind=None):
    """The changed texts as (what was there, what stands there now)."""
    return [(text[m.start:m.end], m.replacement) for m in mutations.mutations(text)
            if kind in (None, m.kind)]


class MutationsTest(unittest.TestCase):
    def test_relations_move_their_boundary_and_turn_round(self):
        self.assertEqual(changes("a < b", "relation"), [("<", "<="), ("<", ">=")])
        self.assertEqual(changes("a == b", "relation"), [("==", "!=")])

    def test_arithmetic_and_logic_are_swapped(self):
        self.assertEqual(changes("x = a + b * c;", "arithmetic"), [("+", "-"), ("*", "/")])
        self.assertEqual(changes("a && b || c", "logic"), [("&&", "||"), ("||", "&&")])

    def test_operator_at_the_end_of_a_line_counts(self):
        self.assertEqual(changes("x = a +\n    b;", "arithmetic"), [("+", "-")])

    def test_templates_pointers_references_and_signs_are_no_operators(self):
        for text in ("std::vector<int> v", "Clip* c", "const Clip& c", "T&& t", "f(-x)", "a->b",
                     "template <typename T>", "std::cout << x"):
            self.assertEqual(changes(text), [], text)

    def test_constants_grow_by_one_and_truths_turn(self):
        self.assertEqual(changes("f(3, 0.5f, 1e-6, true)", "constant"),
                         [("3", "(3 + 1)"), ("0.5f", "(0.5f + 1)"), ("1e-6", "(1e-6 + 1)"),
                          ("true", "false")])

    def test_digits_in_names_are_no_constants(self):
        self.assertEqual(changes("p0 = t2.x1"), [])

    def test_conditions_without_an_operator_are_negated(self):
        self.assertEqual(changes("if (a.empty()) b();", "condition"),
                         [("a.empty()", "!(a.empty())")])
        self.assertEqual(changes("if (!a.ok()) b();", "condition"), [("!", "")])
        self.assertEqual(changes("if (a < b) b();", "condition"), [])

    def test_returns_give_the_default(self):
        self.assertEqual(changes("return f(x);", "return"), [("return f(x);", "return {};")])
        self.assertEqual(changes('return "a";', "return"), [('return "a";', "return {};")])
        for default in ("absl::OkStatus()", "nullptr", "{}", '""'):
            self.assertEqual(changes(f"return {default};", "return"), [], default)

    def test_statements_are_deleted(self):
        for statement in ("f(x)", "a.b = c", "a[i] += c", "++n", "n--", "*out = 1", "break",
                          "a::b(c)->d(e)"):
            self.assertIn((statement, ""), changes(f"{{ {statement}; }}"), statement)

    def test_statement_behind_a_condition_is_deleted_alone(self):
        self.assertEqual(changes("if (f(x)) g(y);", "deletion"), [("g(y)", "")])
        self.assertEqual(changes("for (int i = 0; i < n; ++i) g(i);", "deletion"), [("g(i)", "")])
        self.assertEqual(changes("if (a) { b(); } else c();", "deletion"),
                         [("b()", ""), ("c()", "")])

    def test_declarations_stay(self):
        for text in ("int x = 3;", "MutexLock lock(mutex_);", "using a::b;", "Clip clip;",
                     "const auto it = f(x);", "return x;"):
            self.assertEqual(changes("{" + text + "}", "deletion"), [], text)

    def test_room_made_ahead_only_saves_time(self):
        for text in ("v.reserve(n);", "out->names.reserve(n);", "if (a) v.reserve(f(n));"):
            self.assertEqual(changes("{" + text + "}", "deletion"), [], text)
        self.assertEqual(changes("{ seats.reserved(n); }", "deletion"),
                         [("seats.reserved(n)", "")])

    def test_comments_literals_and_directives_are_not_code(self):
        for text in ('// a < b', '/* x = 1; */', '"a && b"', "'<'", '#if A == 1\n',
                     'R"(if (a) b();)"'):
            self.assertEqual(changes(text), [], text)

    def test_digit_separators_do_not_open_a_literal(self):
        self.assertIn((">", ">="), changes("a = 1'000; b > c; d = 2'000;"))

    def test_change_is_applied_and_its_line_told(self):
        text = "int f(int a) {\n  return a < 3;\n}\n"
        mutation = mutations.mutations(text)[0]
        self.assertEqual(mutation.line(text), 2)
        self.assertEqual(mutation.apply(text), "int f(int a) {\n  return {};\n}\n")


if __name__ == "__main__":
    unittest.main()
