"""USD that `duet-usd` writes, read by a reader of its own (usd_reader.py): every joint stands where the
motion has it, at rest and in every frame, and the mannequins go with them. And by three.js, where
npm's is there:

    npm install --prefix FOLDER three
    DUET_NODE_MODULES=FOLDER/node_modules
"""

import json
import math
import os
import pathlib
import shutil
import unittest

import tools
import usd_reader


NODE = shutil.which("node")
MODULES = pathlib.Path(os.environ.get("DUET_NODE_MODULES", "/nonexistent"))


def rotate(turn, vector):
    """By a quaternion with its real part first."""
    w, (x, y, z) = turn[0], turn[1:]
    a, b, c = vector
    tx, ty, tz = 2 * (y * c - z * b), 2 * (z * a - x * c), 2 * (x * b - y * a)
    return (a + w * tx + y * tz - z * ty, b + w * ty + z * tx - x * tz, c + w * tz + x * ty - y * tx)


def times(a, b):
    """First b, then a."""
    (w, x, y, z), (p, q, r, s) = a, b
    return (w * p - x * q - y * r - z * s, w * q + x * p + y * s - z * r,
            w * r - x * s + y * p + z * q, w * s + x * r - y * q + z * p)


def plus(a, b):
    return tuple(i + j for i, j in zip(a, b))


def translation(matrix):
    """Of a matrix of row vectors that does nothing else."""
    assert [row[:3] for row in matrix[:3]] == [[1, 0, 0], [0, 1, 0], [0, 0, 1]], matrix
    assert [row[3] for row in matrix] == [0, 0, 0, 1], matrix
    return matrix[3][:3]


def places(joints, turns, moves):
    """Where every joint stands, and how it is turned, in the world; joints are paths."""
    world = {}
    for path, turn, move in zip(joints, turns, moves):
        above = world.get(path.rpartition("/")[0], ((0, 0, 0), (1, 0, 0, 0)))
        world[path] = (plus(above[0], rotate(above[1], move)), times(above[1], turn))
    return world


class UsdTest(tools.FolderTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        leader = tools.SOURCE / "samples" / "kick.bvh"
        tools.duet("convert", leader, "--out", cls.folder / "one.json").check_returncode()
        pair = json.loads((cls.folder / "one.json").read_text(encoding="utf-8"))
        pair["follower"] = [[[x, y, z + 1.5] for x, y, z in pose] for pose in reversed(pair["leader"])]
        (cls.folder / "pair.json").write_text(json.dumps(pair), encoding="utf-8")
        cls.convert("pair.json", "pair.usda").check_returncode()
        cls.metadata, (cls.top,) = usd_reader.read(cls.folder / "pair.usda")
        cls.motion = json.loads((cls.folder / "pair.json").read_text(encoding="utf-8"))

    @classmethod
    def convert(cls, *names):
        return tools.run(tools.PROGRAMS / "duet-usd", *(cls.folder / name for name in names))

    def test_layer_states_unit_axis_and_times(self):
        rate, frames = self.motion["frame_rate_hz"], len(self.motion["leader"])
        self.assertEqual({name: self.metadata[name] for name in (
            "metersPerUnit", "upAxis", "startTimeCode", "endTimeCode", "timeCodesPerSecond",
            "framesPerSecond", "defaultPrim")},
            {"metersPerUnit": 1, "upAxis": "Y", "startTimeCode": 0, "endTimeCode": frames - 1,
             "timeCodesPerSecond": rate, "framesPerSecond": rate, "defaultPrim": "pair"})

    def test_every_joint_has_the_motions_position(self):
        largest = 0
        for person in ("leader", "follower"):
            skeleton = self.top.child(person).child("skeleton")
            animation = skeleton.child("animation")
            self.assertEqual(skeleton["skel:animationSource"], animation.path)
            self.assertEqual(animation["joints"], skeleton["joints"])
            turns = animation.attributes["rotations"].samples
            moves = animation.attributes["translations"].samples
            self.assertEqual(list(turns), [float(i) for i in range(len(self.motion[person]))])
            self.assertEqual(list(moves), list(turns))
            for frame, pose in enumerate(self.motion[person]):
                world = places(animation["joints"], turns[frame], moves[frame])
                named = dict(zip(skeleton["jointNames"], (at for at, _ in world.values())))
                for joint, wanted in zip(self.motion["joint_names"], pose):
                    largest = max(largest, math.dist(named[joint], wanted))
        self.assertLess(largest, 1e-4)  # metres

    @unittest.skipUnless(NODE and (MODULES / "three" / "examples" / "jsm" / "loaders" / "usd").is_dir(),
                         "no three.js of npm that reads USD; see the head of usd_test.py")
    def test_three_js_reads_the_same_positions(self):
        frames = len(self.motion["leader"])
        script = pathlib.Path(__file__).parent / "usd" / "positions.mjs"
        found = tools.run(NODE, script, MODULES, self.folder / "pair.usda", frames)
        self.assertEqual(found.returncode, 0, found.stderr)
        there = json.loads(found.stdout)
        largest = max(math.dist(there[person][joint][frame], self.motion[person][frame][k])
                      for person in ("leader", "follower") for frame in range(frames)
                      for k, joint in enumerate(self.motion["joint_names"]))
        self.assertLess(largest, 0.001)

    def test_bind_and_rest_transforms_are_the_same_pose(self):
        for person in ("leader", "follower"):
            skeleton = self.top.child(person).child("skeleton")
            joints = skeleton["joints"]
            rest = places(joints, [(1, 0, 0, 0)] * len(joints),
                          map(translation, skeleton["restTransforms"]))
            for path, bound in zip(joints, map(translation, skeleton["bindTransforms"])):
                self.assertLess(math.dist(rest[path][0], bound), 1e-5, path)
            heights = [at[1] for at, _ in rest.values()]
            self.assertTrue(-0.01 < min(heights) < 0.2 and 1.2 < max(heights) < 2.2, heights)

    def test_mannequins_follow_their_skeletons(self):
        for person in ("leader", "follower"):
            root = self.top.child(person)
            self.assertEqual(root.type, "SkelRoot")
            skeleton = root.child("skeleton")
            bound = [translation(matrix) for matrix in skeleton["bindTransforms"]]
            for mesh in (root.child("mannequin"), root.child("visor")):
                points = mesh["points"]
                self.assertEqual(mesh["skel:skeleton"], skeleton.path)
                self.assertEqual(set(mesh["faceVertexCounts"]), {3})
                self.assertEqual(len(mesh["faceVertexIndices"]), 3 * len(mesh["faceVertexCounts"]))
                self.assertEqual((min(mesh["faceVertexIndices"]), max(mesh["faceVertexIndices"])),
                                 (0, len(points) - 1))
                for name in ("primvars:skel:jointIndices", "primvars:skel:jointWeights"):
                    self.assertEqual(mesh.attributes[name].metadata,
                                     {"elementSize": 1, "interpolation": "vertex"})
                    self.assertEqual(len(mesh[name]), len(points))
                self.assertEqual(set(mesh["primvars:skel:jointWeights"]), {1})
                for point, joint in zip(points, mesh["primvars:skel:jointIndices"]):
                    self.assertLess(math.dist(point, bound[joint]), 0.6)
                for normal in mesh["normals"]:
                    self.assertAlmostEqual(math.hypot(*normal), 1, delta=1e-3)

    def test_every_path_that_is_referenced_exists(self):
        prims = {prim.path: prim for prim in self.top.all()}
        for prim in prims.values():
            for name, attribute in prim.attributes.items():
                if attribute.type == "rel":
                    self.assertIn(attribute.value, prims, f"{prim.path}.{name}")
        for person in ("leader", "follower", "visor"):
            material = prims[f"/pair/materials/{person}"]
            self.assertEqual(material["outputs:surface.connect"],
                             f"{material.path}/surface.outputs:surface")
            self.assertEqual(material.child("surface")["info:id"], "UsdPreviewSurface")
        self.assertEqual(prims["/pair/follower/mannequin"]["material:binding"],
                         "/pair/materials/follower")

    def test_one_person_is_written_alone(self):
        self.convert("one.json", "alone.usda").check_returncode()
        _, (top,) = usd_reader.read(self.folder / "alone.usda")
        self.assertEqual([prim.name for prim in top.children], ["person", "materials"])

    def test_what_is_no_motion_is_an_error(self):
        done = self.convert("pair.usda", "again.usda")
        self.assertEqual(done.returncode, 1)
        self.assertIn("extension: expected", done.stderr)


if __name__ == "__main__":
    tools.main()
