"""Finds the names that a C++ file keeps to itself, and those that it mentions. Knows declarations by their form; it is no parser.

A name that a file keeps to itself, in an anonymous namespace of `duet::motion`, can be reached by code in `duet::motion` or in a
namespace within it, and by `motion::Name`. Code in `duet::formats` never looks there, whatever it calls its own names."""

import dataclasses
import functools
import re

_NOISE = re.compile(r'//[^\n]*|/\*.*?\*/|R"(?P<end>\w*)\(.*?\)(?P=end)"|"(?:\\.|[^"\\\n])*"'
                    r"|(?<!\w)'(?:\\.|[^'\\\n])+'", re.DOTALL)
_DIRECTIVE = re.compile(r"^[ \t]*#[ \t]*(\w+)(?:\\\n|[^\n])*", re.MULTILINE)
_MENTION = re.compile(r"(::\s*)?(?<![\w.])(?<!->)([A-Za-z_]\w*)")
_LIBRARIES = ("std", "absl")
_SPACE_ALIAS = re.compile(r"\bnamespace\s+(\w+)\s*=")

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


@dataclasses.dataclass(frozen=True)
class Own:
    alias: str | None = None  # its declaration, if that is an alias
    space: str | None = None  # the namespace that it is seen in; None: arguments of any call can lead to it


@dataclasses.dataclass
class Names:
    own: dict = dataclasses.field(default_factory=dict)  # name -> Own
    mentioned: dict = dataclasses.field(default_factory=dict)  # name -> its qualifiers; not members of objects, nor of libraries
    spaces: frozenset | None = frozenset()  # the namespaces with code; None: unclear
    space_aliases: frozenset = frozenset()
    alone: bool = False  # changes what follows in a way that no name shows, such as a macro or an operator

    def can_reach(self, name, own):
        """Whether a mention of `name` in this file could mean that own name of a file before it."""
        qualifiers = self.mentioned.get(name)
        if qualifiers is None or own.space is None or self.spaces is None:
            return qualifiers is not None
        if own.space.rpartition("::")[2] in qualifiers or not self.space_aliases.isdisjoint(qualifiers):
            return True
        return "" in qualifiers and any(f"{space}::".startswith(f"{own.space}::") for space in self.spaces)


def read_names(text):
    """The names of a source file or header."""
    code = _without_noise(text)
    names = Names(alone=bool({"define", "undef", "pragma"} & set(_DIRECTIVE.findall(code))))
    code = _DIRECTIVE.sub("", code)
    names.mentioned, names.space_aliases = mentioned_names(code), frozenset(_SPACE_ALIAS.findall(code))
    if code.count("{") != code.count("}"):  # of branches of a condition, so that scopes are unclear
        names.alone, names.spaces = True, None
    for head, scopes, body in _declarations(code):
        if names.spaces is not None:
            names.spaces |= {_space(scopes)}
        _enter(head, scopes, body, names)
    return names


@functools.lru_cache(maxsize=None)
def names_of(file):
    return read_names(file.read_text(encoding="utf-8"))


def mentioned_names(code):
    """The names in the code, each with the words before its "::" ("" for none)."""
    found, before = {}, ""
    for colons, name in _MENTION.findall(code):
        qualifier = before if colons else ""
        if qualifier not in _LIBRARIES:
            found.setdefault(name, set()).add(qualifier)
        before = name
    return found


def _space(scopes):
    return "::".join(name for kind, name in scopes if kind == "named" and name)


def _without_noise(text):
    """The text without comments; each literal is a 0."""
    return _NOISE.sub(lambda match: " " if match[0].startswith("/") else " 0 ", text)


def _declarations(code):
    """Yields each declaration at namespace scope up to its body or end, the namespaces around it, and what follows it."""
    scopes, start = [], 0  # of the open braces: (kind, name); kinds are "named", "anonymous" (namespaces) and "body"
    kinds = []
    for brace in re.finditer("[{};]", code):
        head = code[start:brace.start()].strip()
        if "body" not in kinds:
            space = _NAMESPACE.search(head) if brace[0] == "{" else None
            if head and not space:
                yield head, tuple(scopes), code[brace.end():]
            if brace[0] == "{":
                anonymous = space and space["space"] and not space["name"]
                kinds.append("body" if not space else "anonymous" if anonymous else "named")
                scopes.append((kinds[-1], (space and space["name"] or "").strip()))
            elif brace[0] == "}":
                kinds[-1:], scopes[-1:] = [], []
        elif brace[0] == "{":
            kinds.append("body")
            scopes.append(("body", ""))
        elif brace[0] == "}":
            kinds.pop()
            scopes.pop()
        if "body" not in kinds:
            start = brace.end()


def _enter(head, scopes, body, names):
    """Enters a declaration, if it is the file's own."""
    head = re.sub(r"\[\[.*?\]\]", "", head)
    while re.search("<[^<>]*>", head):
        head = re.sub("<[^<>]*>", " ", head)
    head = re.sub(r"^(?:template\s+)+", "", head.strip())
    kinds = [kind for kind, _ in scopes]
    at_top = "named" not in kinds  # where the headers of libraries would see it
    if alias := _ALIAS.match(head):
        names.own[alias[alias.lastindex]] = Own(" ".join(head.split()), _space(scopes))
    elif re.match(r"using\s+namespace\b", head):
        names.alone = True
    elif "anonymous" in kinds or _INTERNAL.match(head):
        names.alone = names.alone or at_top or bool(re.search(r"\boperator\b", head))
        # The arguments of a call lead to a static function of their namespace, but not to what is anonymous.
        own = Own(space=_space(scopes) if "anonymous" in kinds else None)
        names.own.update(dict.fromkeys(_own_names(head, body), own))


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
