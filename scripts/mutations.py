"""The small changes that mutate.py makes to a C++ file, found in its text.

clang-format lays out the sources, so an operator with a space on either side is an operator: templates,
pointers and references have none. Changes that do not compile do not count.
"""

import re
import typing


class Mutation(typing.NamedTuple):
    start: int
    end: int
    replacement: str

    def apply(self, text):
        return text[:self.start] + self.replacement + text[self.end:]

    def line(self, text):
        return text.count("\n", 0, self.start) + 1


# The replacements of each operator: the other side of the boundary, the opposite.
OPERATORS = {
    "<": ("<=", ">="), "<=": ("<", ">"), ">": (">=", "<="), ">=": (">", "<"), "==": ("!=",), "!=": ("==",),
    "+": ("-",), "-": ("+",), "*": ("/",), "/": ("*",), "%": ("*",),
    "+=": ("-=",), "-=": ("+=",), "*=": ("/=",), "/=": ("*=",),
    "&&": ("||",), "||": ("&&",), "&": ("|",), "|": ("&",), "&=": ("|=",), "|=": ("&=",)}
BOOLEANS = {"true": "false", "false": "true"}
NOT_CODE = re.compile(
    r'//[^\n]*|/\*.*?\*/|R"(?P<end>[^(\s]*)\(.*?\)(?P=end)"|"(?:\\.|[^"\\\n])*"'
    r"|'(?:\\.|[^'\\\n])+'(?!\w)|^[ \t]*#(?:\\\n|[^\n])*", re.DOTALL | re.MULTILINE)
OPERATOR = re.compile(r"(?<= )(?:[<>=!+\-*/&|]=|&&|\|\||[<>+\-*/%&|])(?=\s)")
NUMBER = re.compile(r"(?<![\w.'])(?:\d+\.\d*|\.\d+|\d+)(?:e[+-]?\d+)?(?:[fFuUlL]*)(?![\w.'])")
BOOLEAN = re.compile(r"\b(?:true|false)\b")
NEGATION = re.compile(r"!(?=[A-Za-z_(*])")
CONDITION = re.compile(r"\bif \(")
BRANCHES = re.compile(r"[;!]| (?:[<>=!]=|[<>]|&&|\|\|) ")  # a condition with other changes in it
RETURN = re.compile(r"\breturn\s[^;{}]+;")
DEFAULTS = {"absl::OkStatus()", "std::nullopt", "nullptr", "false", "true", "0", "0.0", '""',
            "std::string()"}
CONTROL = re.compile(r"\s*(?:else\b|(?:if|for|while|switch)\s*(?=\())")
# Statements that can be deleted: calls, assignments, steps, jumps. A declaration has a space in front of
# the name that it declares, so it is none of them.
PLACE = r"\(?\*?[A-Za-z_][\w.:\[\]\-+>()*]*"
STATEMENT = re.compile(
    rf"(?:{PLACE} [+\-*/|&]?=\s.*|[A-Za-z_][\w:.\->\[\]]*\(.*\)|(?:\+\+|--)[\w.\->\[\]]+"
    r"|[\w.\->\[\]]+(?:\+\+|--)|break|continue)", re.DOTALL)
SAVES_TIME_ONLY = re.compile(r"[\w.\->\[\]]*(?:\.|->)reserve\(")  # no test can notice


def mutations(text):
    """Every change to a file, in the order of the text."""
    # Comments, literals and preprocessor lines become blanks, so places stay the same.
    code = NOT_CODE.sub(lambda match: re.sub(r"[^\n]", " ", match[0]), text)
    return sorted(Mutation(*change) for change in (*tokens(code), *conditions(code, text),
                                                   *returns(code, text), *deletions(code)))


def tokens(code):
    for match in OPERATOR.finditer(code):
        for other in OPERATORS.get(match[0], ()):
            yield *match.span(), other
    for match in NUMBER.finditer(code):
        yield *match.span(), f"({match[0]} + 1)"
    for match in BOOLEAN.finditer(code):
        yield *match.span(), BOOLEANS[match[0]]
    for match in NEGATION.finditer(code):
        yield *match.span(), ""


def conditions(code, text):
    for match in CONDITION.finditer(code):
        start, end = match.end(), closing(code, match.end() - 1)
        if not BRANCHES.search(code[start:end]):
            yield start, end, f"!({text[start:end]})"


def returns(code, text):
    for match in RETURN.finditer(code):
        if text[match.start() + len("return"):match.end() - 1].strip() not in DEFAULTS:
            yield *match.span(), "return {};"


def deletions(code):
    """Statements from the end of the previous one to the semicolon."""
    start, depth = 0, 0
    for place, character in enumerate(code):
        depth += {"(": 1, ")": -1}.get(character, 0)
        if character in "{}":
            start = place + 1
        elif character == ";" and depth == 0:
            first = after_control(code, start)
            first += len(code[first:place]) - len(code[first:place].lstrip())
            if STATEMENT.fullmatch(code[first:place]) and not SAVES_TIME_ONLY.match(code, first):
                yield first, place, ""
            start = place + 1


def after_control(code, start):
    """The start of the statement that an if, else or loop at `start` governs."""
    while match := CONTROL.match(code, start):
        start = match.end()
        if code[start:start + 1] == "(":
            start = closing(code, start) + 1
    return start


def closing(code, opening):
    """The place of the bracket that closes the one at `opening`."""
    depth = 0
    for place in range(opening, len(code)):
        depth += {"(": 1, ")": -1}.get(code[place], 0)
        if depth == 0:
            return place
    return len(code)
