"""The small changes that mutate.py makes to a C++ file, found by the text alone.

The sources are laid out by clang-format, so an operator with a space on either side is an operator:
templates, pointers and references have none. What does not compile is not counted.
"""

import dataclasses
import re


@dataclasses.dataclass(frozen=True)
class Mutation:
    start: int
    end: int
    replacement: str
    kind: str

    def apply(self, text):
        return text[:self.start] + self.replacement + text[self.end:]

    def line(self, text):
        return text.count("\n", 0, self.start) + 1


# What replaces an operator: the other side of the boundary, the opposite.
RELATIONS = {"<": ("<=", ">="), "<=": ("<", ">"), ">": (">=", "<="), ">=": (">", "<"),
             "==": ("!=",), "!=": ("==",)}
ARITHMETIC = {"+": "-", "-": "+", "*": "/", "/": "*", "%": "*",
              "+=": "-=", "-=": "+=", "*=": "/=", "/=": "*="}
LOGIC = {"&&": "||", "||": "&&", "&": "|", "|": "&", "&=": "|=", "|=": "&="}

NOT_CODE = re.compile(
    r'//[^\n]*|/\*.*?\*/|R"(?P<end>[^(\s]*)\(.*?\)(?P=end)"|"(?:\\.|[^"\\\n])*"'
    r"|'(?:\\.|[^'\\\n])+'(?!\w)|^[ \t]*#(?:\\\n|[^\n])*", re.DOTALL | re.MULTILINE)
OPERATOR = re.compile(r"(?<= )(?:[<>=!+\-*/&|]=|&&|\|\||[<>+\-*/%&|])(?=\s)")
NUMBER = re.compile(r"(?<![\w.'])(?:\d+\.\d*|\.\d+|\d+)(?:e[+-]?\d+)?(?:[fFuUlL]*)(?![\w.'])")
NEGATION = re.compile(r"!(?=[A-Za-z_(*])")
BOOLEAN = re.compile(r"\b(?:true|false)\b")
RETURN = re.compile(r"\breturn\s[^;{}]+;")
CONDITION = re.compile(r"\bif \(")
CONTROL = re.compile(r"\s*(?:else\b|(?:if|for|while|switch)\s*(?=\())")
# Statements that may go: calls, assignments, steps, jumps. A declaration has a space in front of
# the name that it declares and so is none of them.
PLACE = r"\(?\*?[A-Za-z_][\w.:\[\]\-+>()*]*"
STATEMENT = re.compile(
    rf"(?:{PLACE} [+\-*/|&]?=\s.*|[A-Za-z_][\w:.\->\[\]]*\(.*\)|(?:\+\+|--)[\w.\->\[\]]+"
    r"|[\w.\->\[\]]+(?:\+\+|--)|break|continue)", re.DOTALL)
SAVES_TIME_ONLY = re.compile(r"[\w.\->\[\]]*(?:\.|->)reserve\(")  # nothing to notice
DEFAULTS = {"absl::OkStatus()", "std::nullopt", "nullptr", "false", "true", "0", "0.0", '""',
            "std::string()"}


def code_of(text):
    """The text with comments, literals and preprocessor lines blanked out, as long as before."""
    return NOT_CODE.sub(lambda match: re.sub(r"[^\n]", " ", match[0]), text)


def closing(code, opening):
    """Where the bracket at `opening` ends."""
    depth = 0
    for place in range(opening, len(code)):
        depth += {"(": 1, ")": -1}.get(code[place], 0)
        if depth == 0:
            return place
    return len(code)


def operators(code):
    for match in OPERATOR.finditer(code):
        symbol = match[0]
        for other in RELATIONS.get(symbol, ()):
            yield Mutation(*match.span(), other, "relation")
        if symbol in ARITHMETIC:
            yield Mutation(*match.span(), ARITHMETIC[symbol], "arithmetic")
        if symbol in LOGIC:
            yield Mutation(*match.span(), LOGIC[symbol], "logic")


def constants(code):
    for match in NUMBER.finditer(code):
        yield Mutation(*match.span(), f"({match[0]} + 1)", "constant")
    for match in BOOLEAN.finditer(code):
        yield Mutation(*match.span(), "false" if match[0] == "true" else "true", "constant")


def conditions(code):
    for match in NEGATION.finditer(code):
        yield Mutation(*match.span(), "", "condition")
    for match in CONDITION.finditer(code):
        start, end = match.end(), closing(code, match.end() - 1)
        condition = code[start:end]
        # With an operator or a negation in it there are changes enough.
        if not re.search(r"[;!]| (?:[<>=!]=|[<>]|&&|\|\|) ", condition):
            yield Mutation(start, end, None, "condition")


def returns(code, text):
    for match in RETURN.finditer(code):
        value = text[match.start() + len("return"):match.end() - 1].strip()
        if value not in DEFAULTS:
            yield Mutation(*match.span(), "return {};", "return")


def statements(code):
    """Statements that stand alone: from the end of the one before to the semicolon."""
    start, depth = 0, 0
    for place, character in enumerate(code):
        if character in "()":
            depth += 1 if character == "(" else -1
        elif character in "{}":
            start = place + 1
        elif character == ";" and depth == 0:
            first = after_control(code, start)
            first += len(code[first:place]) - len(code[first:place].lstrip())
            if STATEMENT.fullmatch(code[first:place]) and not SAVES_TIME_ONLY.match(code, first):
                yield Mutation(first, place, "", "deletion")
            start = place + 1


def after_control(code, start):
    """Where the statement begins that an if, else or loop in front of it governs."""
    while match := CONTROL.match(code, start):
        start = match.end()
        if start < len(code) and code[start] == "(":
            start = closing(code, start) + 1
    return start


def mutations(text):
    """Every change to a file, in the order of the text."""
    code = code_of(text)
    found = []
    for mutation in (*operators(code), *constants(code), *conditions(code), *returns(code, text),
                     *statements(code)):
        if mutation.replacement is None:  # a negated condition keeps its text
            mutation = dataclasses.replace(
                mutation, replacement=f"!({text[mutation.start:mutation.end]})")
        found.append(mutation)
    return sorted(found, key=lambda m: (m.start, m.end, m.replacement))
