"""Other people's readers of the .glb that Duet writes: Khronos' validator, Blender.

The validator comes from npm, into any folder outside the repository:

    npm install --prefix FOLDER gltf-validator
    DUET_NODE_MODULES=FOLDER/node_modules

A missing reader is skipped and named; without any reader the test is skipped.
"""

import json
import os
import pathlib
import shutil
import unittest

import tools

TOLERANCE_METRES = 0.001
FOLDER = pathlib.Path(__file__).parent / "gltf"
NODE = shutil.which("node")
MODULES = pathlib.Path(os.environ.get("DUET_NODE_MODULES", "/nonexistent"))
BLENDER = shutil.which("blender")


HAS_VALIDATOR = NODE is not None and (MODULES / "gltf-validator").is_dir()
NO_VALIDATOR = "no gltf-validator; see the head of gltf_test.py"
NO_BLENDER = "no blender; install the package blender"


class GltfTest(tools.FolderTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.pair = cls._write_pair()

    @classmethod
    def _write_pair(cls):
        """Two samples as a pair, as JSON and through `duet convert` as glTF."""
        people = []
        for name in ("kick", "punch"):
            file = cls.folder / f"{name}.json"
            cls._convert(tools.sample(name), file)
            people.append(json.loads(file.read_text(encoding="utf-8")))
        leader, follower = people
        frames = min(len(leader["leader"]), len(follower["leader"]))
        leader["follower"] = [[[-x, y, 1.5 - z] for x, y, z in pose]
                              for pose in follower["leader"][:frames]]
        leader["leader"] = leader["leader"][:frames]
        source = cls.folder / "pair.json"
        source.write_text(json.dumps(leader), encoding="utf-8")
        for name in ("pair.glb", "pair.gltf"):
            cls._convert(source, cls.folder / name)
        return leader

    @staticmethod
    def _convert(source, out):
        done = tools.duet("convert", source, "--out", out)
        assert done.returncode == 0, done.stderr

    def expect_our_positions(self, armatures):
        """armatures: {"leader": {joint: [[x, y, z], ... frames]}, "follower": ...}."""
        self.assertEqual(sorted(armatures), ["follower", "leader"])
        for role, joints in armatures.items():
            for joint, name in enumerate(self.pair["joint_names"]):
                for frame, pose in enumerate(self.pair[role]):
                    distance = max(abs(a - b) for a, b in zip(joints[name][frame], pose[joint]))
                    self.assertLess(distance, TOLERANCE_METRES, f"{role} {name}, frame {frame}")

    @unittest.skipUnless(HAS_VALIDATOR, NO_VALIDATOR)
    def test_validator_reports_no_problem(self):
        for name in ("pair.glb", "pair.gltf"):
            done = tools.run(NODE, FOLDER / "validate.js", self.folder / name,
                             env={**os.environ, "NODE_PATH": str(MODULES)})
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertEqual(json.loads(done.stdout)["issues"]["messages"], [])

    @unittest.skipUnless(BLENDER, NO_BLENDER)
    def test_blender_reads_the_same_positions(self):
        out = self.folder / "blender.json"
        done = tools.run(BLENDER, "--background", "--factory-startup", "--python",
                         FOLDER / "blender_positions.py", "--", self.folder / "pair.glb",
                         len(self.pair["leader"]), self.pair["frame_rate_hz"], out)
        self.assertTrue(out.exists(), done.stdout + done.stderr)
        self.expect_our_positions(json.loads(out.read_text(encoding="utf-8")))


if __name__ == "__main__":
    if not (HAS_VALIDATOR or BLENDER):
        tools.skip(f"{NO_VALIDATOR}; {NO_BLENDER}")
    tools.main()
