"""The pages for Unity and Unreal: their conversions are compiled as they stand there and compared
with the tables of numbers beside them."""

import pathlib
import re
import shutil
import tempfile
import unittest

import tools

UNITY_STUB = """
namespace UnityEngine {
  public struct Vector3 {
    public float x, y, z;
    public Vector3(float x, float y, float z) { this.x = x; this.y = y; this.z = z; }
  }
  public struct Quaternion {
    public float x, y, z, w;
    public Quaternion(float x, float y, float z, float w) {
      this.x = x; this.y = y; this.z = z; this.w = w;
    }
  }
}
public static class Program {
  public static void Main(string[] words) {
    var c = System.Globalization.CultureInfo.InvariantCulture;
    var v = System.Array.ConvertAll(words, word => float.Parse(word, c));
    if (v.Length == 4) {
      var q = DuetAxes.ToUnity(v[0], v[1], v[2], v[3]);
      System.Console.WriteLine(string.Format(c, "{0} {1} {2} {3}", q.x, q.y, q.z, q.w));
      return;
    }
    var p = DuetAxes.ToUnity(v[0], v[1], v[2]);
    var flat = new System.Collections.Generic.List<float> {7, 7, 7};
    DuetAxes.Append(p, flat);
    var back = DuetAxes.Read(flat, 1, 0, 1);
    System.Console.WriteLine(string.Format(c, "{0} {1} {2}", p.x, p.y, p.z));
    System.Console.WriteLine(string.Format(c, "{0} {1} {2}", flat[3], flat[4], flat[5]));
    System.Console.WriteLine(string.Format(c, "{0} {1} {2}", back.x, back.y, back.z));
  }
}
"""
UNREAL_BEFORE = """
#include <cstdio>
#include <cstdlib>
#include <vector>
struct FVector { double X, Y, Z; FVector(double X, double Y, double Z) : X(X), Y(Y), Z(Z) {} };
struct FQuat {
  double X, Y, Z, W;
  FQuat(double X, double Y, double Z, double W) : X(X), Y(Y), Z(Z), W(W) {}
};
struct Floats { std::vector<float> all; void Add(float value) { all.push_back(value); } };
"""
UNREAL_AFTER = """
int main(int count, char** words) {
  float v[4] = {};
  for (int i = 1; i < count; ++i) v[i - 1] = std::strtof(words[i], nullptr);
  if (count == 5) {
    const FQuat q = DuetAxes::ToUnreal(v[0], v[1], v[2], v[3]);
    std::printf("%g %g %g %g\\n", q.X, q.Y, q.Z, q.W);
    return 0;
  }
  const FVector p = DuetAxes::ToUnreal(v[0], v[1], v[2]);
  Floats flat;
  DuetAxes::Append(p, flat);
  std::printf("%g %g %g\\n%g %g %g\\n", p.X, p.Y, p.Z, flat.all[0], flat.all[1], flat.all[2]);
}
"""
NUMBERS = re.compile(r"\(((?:-?[\d.]+, )+-?[\d.]+)\)")


def guide(name):
    return (tools.SOURCE / "docs" / "guides" / name).read_text(encoding="utf-8")


def block(text, language):
    return re.search(rf"^```{language}\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)[1]


def rows(text):
    """The numbers of each row of a table that has them in two columns."""
    found = []
    for line in text.splitlines():
        numbers = [[float(value) for value in match.split(",")] for match in NUMBERS.findall(line)]
        if line.startswith("|") and len(numbers) == 2:
            found.append(numbers)
    return found


class EngineGuidesTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def check(self, text, *program):
        found = rows(text)
        self.assertEqual(len(found), 4)
        for wire, engine in found:
            ran = tools.run(*program, *wire)
            self.assertEqual(ran.returncode, 0, ran.stderr)
            there, *back = [[float(word) for word in line.split()]
                            for line in ran.stdout.splitlines()]
            self.assertEqual(there, engine)
            if len(wire) == 3:  # points come back as they went, and are read as they were
                for value, wanted in zip(back[0], wire):
                    self.assertAlmostEqual(value, wanted, places=3)
                self.assertEqual(back[1:], [engine] * len(back[1:]))

    def test_unity(self):
        if shutil.which("mcs") is None:
            self.skipTest("no mcs; install the packages mono-mcs and mono-runtime")
        source, program = self.folder / "axes.cs", self.folder / "axes.exe"
        source.write_text(block(guide("unity.md"), "csharp") + UNITY_STUB, encoding="utf-8")
        tools.run("mcs", f"-out:{program}", source).check_returncode()
        self.check(guide("unity.md"), "mono", program)

    def test_messages_for_unity_are_made(self):
        tools.run("protoc", f"--csharp_out={self.folder}", f"-I{tools.SOURCE / 'proto'}",
                  *(f"duet/v1/{name}.proto" for name in ("motion", "model", "reaction", "live",
                                                         "synthesis")),
                  ).check_returncode()
        made = "".join(path.read_text(encoding="utf-8") for path in self.folder.glob("*.cs"))
        # What the page's call uses is there, by these names.
        for name in ("FrameRateHz", "LengthUnit", "UpAxis", "YUp", "FrameCount", "JointNames",
                     "Positions", "LabelVector", "InteractionClass", "FirstFrame"):
            self.assertIn(name, guide("unity.md"))
            self.assertRegex(made, rf"\b{name}\b")

    def test_unreal(self):
        source, program = self.folder / "axes.cc", self.folder / "axes"
        source.write_text(UNREAL_BEFORE + block(guide("unreal.md"), "cpp") + UNREAL_AFTER,
                          encoding="utf-8")
        tools.run("g++", "-std=c++17", "-Wall", "-Werror", "-o", program,
                  source).check_returncode()
        self.check(guide("unreal.md"), program)


if __name__ == "__main__":
    tools.main()
