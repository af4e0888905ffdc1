"""Finds the names that a C++ file keeps to itself, and those that it mentions. Knows declarations by their form; it is no parser."""

import dataclasses
import functools
import re

_NOISE = re.compile(r'//[^\n]*|/\*.*?\*/|R"(?P<end>\w*)\(.*?\)(?P=end)"|"(?:\\.|[^"\\\n])*"'
                    r"|(?<!\w)'(?:\\.|[^'\\\n])+'", re.DOTALL)
_DIRECTIVE = re.compile(r"^[ \t]*#[ \t]*(\w+)(?:\\\n|[^\n])*", re.MULTILINE)
_MENTION = re.compile(r"(?<![\w.])(?<!->)(?<!std::)(?<!absl::)[A-Za-z_]\w*")

# Forms of declarations, without template arguments.
_NAMESPACE = re.compile(r'(?:inline\s+)?(?P<space>namespace)(?P<name>\s+[\w:]+)?$|extern\s+0$')
_INTERNAL = re.compile(r"(?:inline\s+)?(?:static|constexpr|const)\b")  # without an anonymous namespace
_ALIAS = re.compile(r"(?:using|namespace)\s+(\w+)\s*=|using\s+(?:typename\s+)?(?:\w*::\s*)*(\w+)$")
_MATCHER = re.compile(r"(?:MATCHER|ACTION)(?:_P\d*)?\s*\(\s*(\w+)")
_TEST = re.compile(r"[A-Z_]+\s*\(")  # GoogleTest keeps the names of tests apart
_ENUMERATION = re.compile(r"enum\b(?!\s+(?:class|struct)\b)")
_TYPE = re.compile(r"(?:enum\s+(?:class|struct)|struct|class|enum|union)\s+(\w+)\s*(?:final\s*)?(?::.*)?$", re.DOTALL)
_FUNCTION = re.compile(r"[^()]*?([\w:~]+)\s*\(")
_FURTHER_VALUE = re.compile(r",\s*[*&]*(\w+)\s*(?=[=\[,]|$)")  # int a = 1, b = 2
_VALUE = re.compile(r"(?!enum$)(?:.*[\s*&])?(\w+)\s*(?:\[[^\]]*\]\s*)*$", re.DOTALL)


@dataclasses.dataclass
class Names:
    own: dict = dataclasses.field(default_factory=dict)  # name -> its declaration if that is an alias, else None
    mentioned: frozenset = frozenset()  # identifiers, except members of objects and names of std and absl
    alone: bool = False  # changes what follows in a way that no name shows, such as a macro or an operator


def read_names(text):
    """The names of a source file."""
    code = _without_noise(text)
    names = Names(alone=bool({"define", "undef", "pragma"} & set(_DIRECTIVE.findall(code))))
    code = _DIRECTIVE.sub("", code)
    names.alone |= code.count("{") != code.count("}")  # of branches of a condition, so that scopes are unclear
    names.mentioned = mentioned_names(code)
    for head, scopes, body in _declarations(code):
        _enter(head, scopes, body, names)
    return names


@functools.lru_cache(maxsize=None)
def mentioned_in(header):
    """The identifiers that a header mentions."""
    return mentioned_names(_DIRECTIVE.sub("", _without_noise(header.read_text(encoding="utf-8"))))


def mentioned_names(code):
    return frozenset(_MENTION.findall(code))


def _without_noise(text):
    """The text without comments; each literal is a 0."""
    return _NOISE.sub(lambda match: " " if match[0].startswith("/") else " 0 ", text)


def _declarations(code):
    """Yields each declaration at namespace scope up to its body or end, the namespaces around it, and what follows it."""
    scopes, start = [], 0  # of the open braces: "named", "anonymous" (namespaces) or "body"
    for brace in re.finditer("[{};]", code):
        head = code[start:brace.start()].strip()
        if "body" not in scopes:
            space = _NAMESPACE.search(head) if brace[0] == "{" else None
            if head and not space:
                yield head, tuple(scopes), code[brace.end():]
            if brace[0] == "{":
                anonymous = space and space["space"] and not space["name"]
                scopes.append("body" if not space else "anonymous" if anonymous else "named")
            elif brace[0] == "}":
                scopes[-1:] = []
        elif brace[0] == "{":
            scopes.append("body")
        elif brace[0] == "}":
            scopes.pop()
        if "body" not in scopes:
            start = brace.end()


def _enter(head, scopes, body, names):
    """Enters a declaration, if it is the file's own."""
    head = re.sub(r"\[\[.*?\]\]", "", head)
    while re.search("<[^<>]*>", head):
        head = re.sub("<[^<>]*>", " ", head)
    head = re.sub(r"^(?:template\s+)+", "", head.strip())
    at_top = "named" not in scopes  # where the headers of libraries would see it
    if alias := _ALIAS.match(head):
        names.own[alias[alias.lastindex]] = " ".join(head.split())
    elif re.match(r"using\s+namespace\b", head):
        names.alone = True
    elif "anonymous" in scopes or _INTERNAL.match(head):
        names.alone = names.alone or at_top or bool(re.search(r"\boperator\b", head))
        names.own.update(dict.fromkeys(_own_names(head, body)))


def _own_names(head, body):
    if macro := _MATCHER.match(head):
        return [macro[1]]
    if _TEST.match(head):
        return []
    declared = head.split("=")[0].strip()
    if match := _TYPE.match(declared) or _FUNCTION.match(declared):
        found = [] if "::" in match[1] else [match[1]]
    else:
        found = [match[1] for match in [_VALUE.match(declared)] if match] + _FURTHER_VALUE.findall(head)
    if _ENUMERATION.match(head):
        found += re.findall(r"\b[A-Za-z_]\w*", body[:body.find("}")])
    return found
