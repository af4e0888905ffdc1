"""The small changes that mutate.py makes to a C++ file, found in its text by regular expressions.

clang-format lays out the sources, so an operator with a space on either side is an operator: templates,
pointers and references have none. Changes that do not compile do not count.
"""

import re
import typing


class Mutation(typing.NamedTuple):
    start: int
    end: int
    replacement: str
    line: int

    def apply(self, text):
        return text[:self.start] + self.replacement + text[self.end:]


# The replacements of each operator: the other side of the boundary, the opposite.
OPERATORS = {
    "<": ("<=", ">="), "<=": ("<", ">"), ">": (">=", "<="), ">=": (">", "<"), "==": ("!=",), "!=": ("==",),
    "+": ("-",), "-": ("+",), "*": ("/",), "/": ("*",), "%": ("*",),
    "+=": ("-=",), "-=": ("+=",), "*=": ("/=",), "/=": ("*=",),
    "&&": ("||",), "||": ("&&",), "&": ("|",), "|": ("&",), "&=": ("|=",), "|=": ("&=",)}
BOOLEANS = {"true": ("false",), "false": ("true",)}
NOT_CODE = re.compile(
    r'//[^\n]*|/\*.*?\*/|R"(?P<end>[^(\s]*)\(.*?\)(?P=end)"|"(?:\\.|[^"\\\n])*"'
    r"|'(?:\\.|[^'\\\n])+'(?!\w)|^[ \t]*#(?:\\\n|[^\n])*", re.DOTALL | re.MULTILINE)
DEFAULT = r"absl::OkStatus\(\)|std::nullopt|nullptr|false|true|0|0\.0|\"\"|std::string\(\)"
# Calls, assignments, steps and jumps. A declaration has a space in front of the name that it declares, so it is
# none of them. A call of reserve() only saves time, which no test can notice.
STATEMENT = (r"\(?\*?[A-Za-z_][\w.:\[\]\-+>()*]* [+\-*/|&]?=\s[^;{}]*|[A-Za-z_][\w:.\->\[\]]*(?<!\breserve)\([^;{}]*\)"
             r"|(?:\+\+|--)[\w.\->\[\]]+|[\w.\->\[\]]+(?:\+\+|--)|break|continue")
# What changes (group 1 of a pattern), and its replacements.
KINDS = (
    (r"(?<= )((?:[<>=!+\-*/&|]=|&&|\|\||[<>+\-*/%&|]))(?=\s)", lambda code: OPERATORS.get(code, ())),
    (r"(?<![\w.'])((?:\d+\.\d*|\.\d+|\d+)(?:e[+-]?\d+)?[fFuUlL]*)(?![\w.'])", lambda code: (f"({code} + 1)",)),
    (r"\b(true|false)\b", BOOLEANS.get),
    (r"(!)(?=[A-Za-z_(*])", lambda _: ("",)),
    # A condition without an operator.
    (r"\bif \(()(?=[A-Za-z_][\w.:>\[\]\-]*(?:\([^!<>=&|;]*\))?\))", lambda _: ("!",)),
    (rf"\b(return\s(?!(?:{DEFAULT});)[^;{{}}]+;)", lambda _: ("return {};",)),
    (rf"(?:\A|(?<=[;{{}}]))\s*(?:else |(?:if|for|while) \(.*\) )*({STATEMENT})(?=;)", lambda _: ("",)))


def mutations(text):
    """Every change to a file, in the order of the text."""
    # Comments, literals and preprocessor lines become blanks, so places stay the same. Quotes stay.
    code = NOT_CODE.sub(lambda match: re.sub(r'[^\n"]', " ", match[0]), text)
    return sorted(Mutation(*match.span(1), replacement, text.count("\n", 0, match.start(1)) + 1)
                  for pattern, replacements in KINDS for match in re.finditer(pattern, code, re.MULTILINE)
                  for replacement in replacements(match[1]))
