#!/usr/bin/env python3
"""Prepares the project's sources for Doxygen: converts plain comments to Doxygen's, and proto to C++.

Doxygen calls it for each header and each .proto file (docs/Doxyfile) and reads what it prints.
Text that is laid out in columns stays as it is laid out.
"""

import pathlib
import re
import sys

COMMENT = re.compile(r"^(\s*)//(?!/)( ?)(.*)$")
TRAILING = re.compile(r"^(\s*[^\s/].*?[;,({])\s+// (.*)$")
COLUMNS = re.compile(r"^\s{2,}|^[A-Z][\w ]*: {2,}|\S {3,}\S")


def paragraph(lines):
    """A paragraph of a comment; a paragraph with columns keeps its layout."""
    if any(map(COLUMNS.search, lines)):
        return ["<pre>", *(entities(line) for line in lines), "</pre>"]
    return [entities(line) for line in lines]


def entities(text):
    """Text in which Doxygen finds no command, and no markup except `code`."""
    text = "".join(f"&#{ord(c)};" if c in "&<>\\@#%\"" else c for c in text)
    return re.sub(r"`([^`]+)`", r"<tt>\1</tt>", text)


def comment_block(lines, is_file):
    """A separate comment in Doxygen's form; `is_file`: it describes the file, not the next declaration."""
    paragraphs, current = [], []
    for line in [*lines, ""]:
        if line.strip():
            current.append(line)
        elif current:
            paragraphs.append(paragraph(current))
            current = []
    text = "\n\n".join("\n".join(lines) for lines in paragraphs).split("\n")
    return ["///" + (" \\file" if is_file else ""), *(f"/// {line}".rstrip() for line in text)]


def translate(lines):
    """C++ with Doxygen's comments."""
    out, place = [], 0
    while place < len(lines):
        if COMMENT.match(lines[place]):
            end = place
            while end < len(lines) and COMMENT.match(lines[end]):
                end += 1
            is_file = end < len(lines) and not lines[end].strip()
            out += comment_block([COMMENT.match(line)[3] for line in lines[place:end]], is_file)
            place = end
            continue
        trailing = TRAILING.match(lines[place])
        if not trailing:
            out.append(lines[place])
            place += 1
            continue
        text = [trailing[2]]
        indent = len(lines[place]) - len(lines[place].lstrip())
        while place + len(text) < len(lines):  # the same comment, on lines of its own further right
            more = COMMENT.match(lines[place + len(text)])
            if not more or len(more[1]) < indent + 8:
                break
            text.append(more[3])
        out.append(f"{trailing[1]}  ///< {entities(' '.join(text))}")
        place += len(text)
    return out


PROTO = (
    (re.compile(r"^\s*(syntax|import|option|reserved)\b.*;"), ""),
    (re.compile(r"^package ([\w.]+);"), lambda m: f"namespace {m[1].replace('.', '::')} {{"),
    (re.compile(r"\bservice (\w+) \{"), r"class \1 { public:"),
    (re.compile(r"\bmessage (\w+) \{\}"), r"struct \1 {};"),
    (re.compile(r"\bmessage (\w+) \{"), r"struct \1 {"),
    (re.compile(r"^(\s*)rpc (\w+)\((stream )?(\w+)\) returns \((stream )?([\w.]+)\)(;| \{\})"),
     lambda m: f"{m[1]}{wrapped(m[5], m[6])} {m[2]}({wrapped(m[3], m[4])} request);"),
    (re.compile(r"^(\s*)oneof (\w+) \{"), r"\1union {"),
    (re.compile(r"^(\s*)(repeated|optional) ([\w.]+) (\w+) = (\d+)[^;]*;"),
     lambda m: f"{m[1]}{m[2]}<{scoped(m[3])}> {m[4]};"),
    (re.compile(r"^(\s*)([\w.]+) (\w+) = (\d+)[^;]*;"), lambda m: f"{m[1]}{scoped(m[2])} {m[3]};"),
    (re.compile(r"^(\s*[A-Z][A-Z0-9_]*) = (\d+)[^;]*;"), r"\1 = \2,"),
    (re.compile(r"^(\s*)\}$"), r"\1};"),
)


def scoped(name):
    return name.replace(".", "::")


def wrapped(stream, name):
    return f"stream<{scoped(name)}>" if stream else scoped(name)


def proto_as_cpp(lines):
    """A proto file as declarations that Doxygen understands: messages as structs."""
    out = []
    for line in lines:
        code, slashes, comment = line.partition("//")
        if not slashes or code.strip():
            for pattern, replacement in PROTO:
                code, found = pattern.subn(replacement, code)
                if found:
                    break
        out.append(code + slashes + comment)
    return [*out, "}"]


def main(arguments):
    if len(arguments) != 1:
        sys.exit(__doc__)
    path = pathlib.Path(arguments[0])
    lines = path.read_text(encoding="utf-8").splitlines()
    print("\n".join(translate(proto_as_cpp(lines) if path.suffix == ".proto" else lines)))


if __name__ == "__main__":
    main(sys.argv[1:])
