"""Rounds in a file, so that what the server received can be sent again."""

import json
import pathlib


def write(path, header, rounds):
    """`header`: what to know about them, as an object. Bytes become hexadecimal text."""
    def encoded(step):
        return [step[0], step[1].hex()] if step[0] == "send" else step
    kept = [[{**connection, "steps": [encoded(step) for step in connection["steps"]]}
             for connection in connections] for connections in rounds]
    pathlib.Path(path).write_text(json.dumps({**header, "rounds": kept}, indent=1) + "\n",
                                  encoding="utf-8")


def read(path):
    """The rounds of a file that write() wrote."""
    def decoded(step):
        return [step[0], bytes.fromhex(step[1])] if step[0] == "send" else step
    rounds = json.loads(pathlib.Path(path).read_text(encoding="utf-8"))["rounds"]
    return [[{**connection, "steps": [decoded(step) for step in connection["steps"]]}
             for connection in connections] for connections in rounds]
