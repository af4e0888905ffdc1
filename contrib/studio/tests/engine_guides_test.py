"""The guides for Unity and Unreal: the numbers in their tables, and the names of messages in their examples."""

import pathlib
import re
import tempfile
import unittest

import tools

NUMBERS = re.compile(r"\(((?:-?[\d.]+, )+-?[\d.]+)\)")
# From points and quaternions on the wire to those of the engine, as the guides and docs/rotations.md state.
UNITY = {3: lambda x, y, z: [-x, y, z], 4: lambda x, y, z, w: [x, -y, -z, w]}
UNREAL = {3: lambda x, y, z: [x / 10, -y / 10, z / 10], 4: lambda x, y, z, w: [-x, y, -z, w]}
MESSAGES = ("motion", "model", "reaction", "live", "synthesis")


def guide(name):
    return (tools.SOURCE / "docs" / "guides" / name).read_text(encoding="utf-8")


def rows(text):
    """The numbers of each row of a table that has them in two columns."""
    found = []
    for line in text.splitlines():
        numbers = [[float(value) for value in match.split(",")] for match in NUMBERS.findall(line)]
        if line.startswith("|") and len(numbers) == 2:
            found.append(numbers)
    return found


class EngineGuidesTest(unittest.TestCase):
    def test_tables_have_the_converted_numbers(self):
        for name, convert in (("unity.md", UNITY), ("unreal.md", UNREAL)):
            found = rows(guide(name))
            self.assertEqual(len(found), 4, name)
            for wire, engine in found:
                self.assertEqual(convert[len(wire)](*wire), engine, name)

    def test_examples_use_the_names_of_generated_messages(self):
        with tempfile.TemporaryDirectory() as folder:
            tools.run("protoc", f"--csharp_out={folder}", f"-I{tools.SOURCE / 'proto'}",
                      *(f"duet/v1/{name}.proto" for name in MESSAGES)).check_returncode()
            made = "".join(path.read_text(encoding="utf-8") for path in pathlib.Path(folder).glob("*.cs"))
        for name in ("SynthesizeRequest", "FrameRateHz", "LengthUnit", "UpAxis", "YUp", "FrameCount", "JointNames",
                     "Positions", "LabelVector", "InteractionClass", "FirstFrame", "SynthesizeLiveRequest",
                     "SynthesizeLiveResponse", "LiveStart", "ReplyRotations", "LeaderFrames", "LabelChange",
                     "Rotations", "Rig"):
            self.assertRegex(guide("unity.md"), rf"\b{name}\b")
            self.assertRegex(made, rf"\b{name}\b")


if __name__ == "__main__":
    tools.main()
