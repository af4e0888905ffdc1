"""Reads text USD as far as animated skeletons need it: prims, their metadata, attributes with time
samples, relationships. Written from the format's description, not from the writer.

https://openusd.org/release/spec_usdpreviewsurface.html, .../api/_usd_skel__schemas.html
"""

import dataclasses
import re

TOKEN = re.compile(r'\s*(?:#[^\n]*\s*)*("(?:[^"\\\n]|\\.)*"|<[^>]*>|[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?'
                   r"|[A-Za-z_][\w:.]*(?:\[\])?|[()\[\]{}=,:])")
ESCAPE = re.compile(r"\\(x[0-9a-fA-F]{2}|.)")


@dataclasses.dataclass
class Attribute:
    type: str
    value: object = None
    samples: dict = None  # by time code
    metadata: dict = dataclasses.field(default_factory=dict)


@dataclasses.dataclass
class Prim:
    type: str
    name: str
    path: str
    metadata: dict
    attributes: dict = dataclasses.field(default_factory=dict)
    children: list = dataclasses.field(default_factory=list)

    def child(self, name):
        (found,) = [prim for prim in self.children if prim.name == name]
        return found

    def __getitem__(self, name):
        return self.attributes[name].value

    def all(self):
        yield self
        for prim in self.children:
            yield from prim.all()


class Reader:
    def __init__(self, text):
        header, _, rest = text.partition("\n")
        assert header == "#usda 1.0", header
        self.tokens = []
        at = 0
        while rest[at:].strip():
            match = TOKEN.match(rest, at)
            assert match, f"what is {rest[at:at + 40]!r}?"
            self.tokens.append(match[1])
            at = match.end()
        self.at = 0

    @property
    def next(self):
        return self.tokens[self.at] if self.at < len(self.tokens) else None

    def take(self, wanted=None):
        token = self.tokens[self.at]
        assert wanted in (None, token), f"got {token} after {self.tokens[self.at - 8:self.at]}, expected {wanted}"
        self.at += 1
        return token

    def stage(self):
        """The layer's metadata and the prims at the top."""
        metadata = self.metadata()
        prims = []
        while self.next:
            prims.append(self.prim(""))
        return metadata, prims

    def metadata(self):
        values = {}
        if self.next != "(":
            return values
        self.take("(")
        while self.next != ")":
            if self.next == "prepend":
                self.take()
            name = self.take()
            self.take("=")
            values[name] = self.dictionary() if self.next == "{" else self.value()
        self.take(")")
        return values

    def dictionary(self):
        values = {}
        self.take("{")
        while self.next != "}":
            kind, name = self.take(), self.take()
            self.take("=")
            key = unquoted(name) if name.startswith('"') else name
            values[key] = self.dictionary() if kind == "dictionary" else self.value()
        self.take("}")
        return values

    def prim(self, above):
        self.take("def")
        kind, name = self.take(), unquoted(self.take())
        assert re.fullmatch(r"[A-Za-z_]\w*", name), name
        prim = Prim(kind, name, f"{above}/{name}", self.metadata())
        self.take("{")
        while self.next != "}":
            if self.next == "def":
                prim.children.append(self.prim(prim.path))
            else:
                self.property(prim)
        self.take("}")
        return prim

    def property(self, prim):
        if self.next == "uniform":
            self.take()
        kind, name = self.take(), self.take()
        samples = name.endswith(".timeSamples")
        attribute = prim.attributes.setdefault(name.removesuffix(".timeSamples"), Attribute(kind))
        if self.next == "=":
            self.take()
            if samples:
                attribute.samples = self.samples()
            else:
                attribute.value = self.value()
        attribute.metadata.update(self.metadata())

    def samples(self):
        values = {}
        self.take("{")
        while self.next != "}":
            time = float(self.take())
            self.take(":")
            values[time] = self.value()
            self.take(",")
        self.take("}")
        return values

    def value(self):
        token = self.take()
        if token in "([":
            values = []
            while self.next not in (")", "]"):
                values.append(self.value())
                if self.next == ",":
                    self.take()
            self.take(")" if token == "(" else "]")
            return values
        if token.startswith('"'):
            return unquoted(token)
        if token.startswith("<"):
            return token[1:-1]
        if token in ("true", "false"):
            return token == "true"
        return float(token) if re.search("[.eE]", token) else int(token)


def unquoted(token):
    return ESCAPE.sub(lambda escape: chr(int(escape[1][1:], 16)) if len(escape[1]) == 3 else escape[1],
                      token[1:-1])


def read(path):
    return Reader(path.read_text(encoding="utf-8")).stage()
