"""The code for Unity and Unreal (contrib/studio/engines): its conversions are compared with the tables of
numbers in the guides. The live partners are compiled against stubs of the engines (folder engines):
Unity's holds a session with a real server; Unreal's writes messages for one, and reads its answers."""

import asyncio
import importlib.util
import os
import pathlib
import re
import shutil
import sys
import tempfile
import unittest

import gateways
import tools

STUBS = pathlib.Path(__file__).parent / "engines"
UNITY, UNREAL = (pathlib.Path(__file__).parents[1] / "engines" / name for name in ("unity", "unreal"))
FRAMES = 40  # of a live session
# The joints of the model in the order of the live partners, and bones that lie between two of them.
JOINTS = ("torso neck head left_shoulder left_elbow left_hand right_shoulder right_elbow right_hand "
          "left_hip left_knee left_foot right_hip right_knee right_foot").split()
UNREAL_LIMBS = {f"{bone}_{end}": (f"{side}_{joint}", f"{next_bone}_{end}", f"{side}_{to}")
                for side, end in (("left", "l"), ("right", "r")) for bone, joint, next_bone, to in (
                    ("upperarm", "shoulder", "lowerarm", "elbow"), ("lowerarm", "elbow", "hand", "hand"),
                    ("thigh", "hip", "calf", "knee"), ("calf", "knee", "foot", "foot"))}
UNREAL_HEADERS = ("CoreMinimal.h", "IWebSocket.h", "WebSocketsModule.h", "Components/PoseableMeshComponent.h",
                  "Components/SkeletalMeshComponent.h", "GameFramework/Actor.h", "DuetPartner.generated.h")
UNITY_LIMBS = {f"{side}{bone}": (f"{side.lower()}_{joint}", f"{side}{end}", f"{side.lower()}_{to}")
               for side in ("Left", "Right") for bone, joint, end, to in (
                   ("UpperArm", "shoulder", "LowerArm", "elbow"), ("LowerArm", "elbow", "Hand", "hand"),
                   ("UpperLeg", "hip", "LowerLeg", "knee"), ("LowerLeg", "knee", "Foot", "foot"))}

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


def rows(text):
    """The numbers of each row of a table that has them in two columns."""
    found = []
    for line in text.splitlines():
        numbers = [[float(value) for value in match.split(",")] for match in NUMBERS.findall(line)]
        if line.startswith("|") and len(numbers) == 2:
            found.append(numbers)
    return found


def leader_of(duet):
    """The first frames of a sample, [frames, JOINTS, 3], metres, y up."""
    hug = duet.read_motion(tools.sample("hug"))
    return hug.positions[:FRAMES, [hug.joint_names.index(joint) for joint in JOINTS]]


async def live_follower(duet, address, leader):
    """The follower of a live session, answered frame by frame."""
    import numpy as np
    found = []
    async with duet.aio.Client(address, wait=tools.RUN_SECONDS) as client:
        async with client.live(JOINTS, 30, {"hug": 1}, rotations=True) as session:
            for frame in leader:
                await session.send(frame)
                found.append((await session.__anext__()).positions)
            await session.finish()
    return np.concatenate(found)


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
        source.write_text((UNITY / "DuetAxes.cs").read_text(encoding="utf-8") + UNITY_STUB, encoding="utf-8")
        tools.run("mcs", f"-out:{program}", source).check_returncode()
        self.check(guide("unity.md"), "mono", program)

    def compile_unity(self):
        """The program of the live partner for Unity."""
        if shutil.which("mcs") is None:
            self.skipTest("no mcs; install the packages mono-mcs and mono-runtime")
        program = self.folder / "live.exe"
        made = tools.run("mcs", "-warnaserror", f"-out:{program}", *UNITY.glob("*.cs"), *STUBS.glob("unity_*.cs"))
        self.assertEqual(made.returncode, 0, made.stdout + made.stderr)
        return program

    def test_unity_keeps_a_distance_and_faces_the_leader(self):
        ran = tools.run("mono", self.compile_unity())
        self.assertEqual(ran.returncode, 0, ran.stderr)
        self.assertEqual(ran.stdout.splitlines(), ["apart 0 1 0.3", "apart 3 1 0", "turn 60 0 0",
                                                   "turn 0 0 0", "turn -60 0 0"])

    def test_unity_shows_a_live_partner(self):
        duet, np = self.modules()
        program = self.compile_unity()
        leader = leader_of(duet)
        lines = self.write_frames(leader)
        with tools.running_server() as server:
            gateway = gateways.Gateway(server.address)
            self.addCleanup(gateway.stop)
            ran = tools.run("mono", program, f"ws://127.0.0.1:{gateway.port}/live", lines)
            self.assertEqual(ran.returncode, 0, ran.stdout[-500:] + ran.stderr)
            wanted = asyncio.run(live_follower(duet, server.address, leader))
        frames = ran.stdout.split("frame ")[1:]
        self.assertEqual(len(frames), FRAMES)
        for frame, text in enumerate(frames):
            bones = self.check_limbs(text, wanted[frame] * (-1, 1, 1), UNITY_LIMBS)
            hips = wanted[frame, [JOINTS.index("left_hip"), JOINTS.index("right_hip")]].mean(axis=0)
            np.testing.assert_allclose(bones["Hips"][[0, 2]], hips[[0, 2]] * (-1, 1), atol=1e-3)

    def modules(self):
        """The Python package and NumPy."""
        for module, package in gateways.NEEDED:
            if importlib.util.find_spec(module) is None:
                self.skipTest(f"no Python module {module}; install the package {package}")
        os.environ["DUET_PROGRAM"] = str(tools.PROGRAMS / "duet")
        sys.path.insert(0, str(tools.SOURCE / "client" / "python"))
        import duet_motion as duet
        import numpy as np
        return duet, np

    def write_frames(self, leader):
        lines = self.folder / "leader.txt"
        lines.write_text("".join(" ".join(map(repr, map(float, frame.ravel()))) + "\n" for frame in leader),
                         encoding="ascii")
        return lines

    def check_limbs(self, text, positions, limbs):
        """Compares the directions of an avatar's limbs with those of a frame; returns its bones."""
        import numpy as np
        bones = {name: np.array([float(value) for value in values]) for name, *values in
                 (line.split() for line in text.splitlines()[1:])}
        joint = dict(zip(JOINTS, positions))
        for bone, (start, end, to) in limbs.items():
            shown, real = bones[end] - bones[bone], joint[to] - joint[start]
            cosine = shown @ real / np.linalg.norm(shown) / np.linalg.norm(real)
            self.assertGreater(cosine, np.cos(np.radians(1)), bone)
        return bones

    def compile_unreal(self):
        """The program of the live partner for Unreal."""
        for header in UNREAL_HEADERS:
            path = self.folder / header
            path.parent.mkdir(exist_ok=True)
            path.write_text('#include "unreal_stub.h"\n', encoding="ascii")
        made = tools.run("g++", "-std=c++17", "-Wall", "-Wextra", "-Werror", f"-I{self.folder}", f"-I{UNREAL}", f"-I{STUBS}",
                         STUBS / "unreal_live.cc", "-o", self.folder / "live")
        self.assertEqual(made.returncode, 0, made.stderr)
        return self.folder / "live"

    def test_unreal_keeps_a_distance_and_faces_the_leader(self):
        ran = tools.run(self.compile_unreal())
        self.assertEqual(ran.returncode, 0, ran.stderr)
        found = [(name, *map(float, values)) for name, *values in map(str.split, ran.stdout.splitlines())]
        self.assertEqual(found, [("apart", 30, 0, 90), ("apart", 300, 0, 90), ("turn", -60, 0, 0),
                                 ("turn", 0, 0, 0), ("turn", 60, 0, 0)])

    def test_unreal_shows_a_live_partner(self):
        duet, np = self.modules()
        program = self.compile_unreal()
        import grpc
        from duet_motion.v1 import live_pb2, synthesis_pb2_grpc
        leader = leader_of(duet)
        lines = self.write_frames(100 * leader[:, :, [0, 2, 1]])
        ran = tools.run(program, lines)
        self.assertEqual(ran.returncode, 0, ran.stderr)
        sent = [live_pb2.SynthesizeLiveRequest.FromString(bytes.fromhex(line)) for line in ran.stdout.split()]
        self.assertEqual(len(sent), FRAMES + 1)
        self.assertEqual(sent[0].start.leader.joint_names, JOINTS)
        wire = np.reshape([message.frames.positions for message in sent[1:]], leader.shape)
        np.testing.assert_allclose(wire, 1000 * leader[:, :, [0, 2, 1]] * (1, -1, 1), atol=0.1)
        with tools.running_server() as server, grpc.insecure_channel(server.address) as channel:
            stub = synthesis_pb2_grpc.MotionSynthesisStub(channel)
            answers = list(stub.SynthesizeLive(iter(sent), timeout=tools.RUN_SECONDS))
        messages = self.folder / "messages.txt"
        messages.write_text("".join(answer.SerializeToString().hex() + "\n" for answer in answers) +
                            b'{"code": 0}'.hex(), encoding="ascii")
        ran = tools.run(program, lines, messages)
        self.assertEqual(ran.returncode, 0, ran.stderr)
        shown = ran.stdout.split("message\n")[1:]
        self.assertEqual(len(shown), len(answers) + 1)
        checked = 0
        for answer, text in zip(answers, shown):
            if answer.WhichOneof("payload") == "frames":
                last = np.reshape(answer.frames.positions, (-1, len(JOINTS), 3))[-1]
                self.check_limbs("\n" + text, last * (0.1, -0.1, 0.1), UNREAL_LIMBS)
                checked += answer.frames.frame_count
        self.assertEqual(checked, FRAMES)

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
        source.write_text(f'{UNREAL_BEFORE}#include "DuetAxes.h"\n{UNREAL_AFTER}', encoding="utf-8")
        tools.run("g++", "-std=c++17", "-Wall", "-Werror", f"-I{UNREAL}", "-o", program, source).check_returncode()
        self.check(guide("unreal.md"), program)


if __name__ == "__main__":
    tools.main()
