"""duet_fbx.py: FBX that Blender's exporter writes, with other names, rates, units and axes, is read as its source."""

import json
import pathlib
import shutil
import tempfile

import guides
import numpy as np
import tools

BLENDER = shutil.which("blender")
MAKE_FBX = tools.SOURCE / "contrib/formats/tests/make_fbx.py"
DUET_FBX = tools.SOURCE / "contrib/formats/fbx/duet_fbx.py"
NEAR = 0.003  # metres; a part of it is from the import of the sources into Blender


class FbxTest(guides.GuideTest):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.made = pathlib.Path(folder.name)
        for sample in ("kick", "punch"):
            done = tools.duet("convert", tools.sample(sample), "--out", cls.made / f"{sample}.glb")
            assert done.returncode == 0, done.stderr
        done = tools.run(BLENDER, "--background", "--factory-startup", "--python-exit-code", "1", "--python", MAKE_FBX,
                         "--", cls.made / "kick.glb", cls.made / "punch.glb", cls.made)
        assert done.returncode == 0, done.stdout + done.stderr

    def convert(self, name):
        """Converts a made file to glTF."""
        done = tools.run(DUET_FBX, self.made / f"{name}.fbx", self.made / f"{name}.glb")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return self.made / f"{name}.glb"

    def read(self, file, *flags):
        """The rate, the joints' names and the positions of a motion."""
        out = self.made / "read.json"
        done = tools.duet("convert", file, *flags, "--out", out, "--quiet")
        self.assertEqual(done.returncode, 0, f"{file.name}: {done.stderr}")
        motion = json.loads(out.read_text(encoding="utf-8"))
        return motion["frame_rate_hz"], motion["joint_names"], np.array(motion["leader"])

    def source(self, sample, names):
        """The sample with a rig's names, which decide how its joints are mapped."""
        text = tools.sample(sample).read_text(encoding="utf-8")
        for joint, name in names.items():
            for word in ("ROOT", "JOINT"):
                text = text.replace(f"{word} {joint}\n", f"{word} {name}\n")
        file = self.made / "source.bvh"
        file.write_text(text, encoding="utf-8")
        return self.read(file)[2]

    def assert_same(self, positions, source, joints, metres=NEAR):
        # The head's end has no usual name in the files, so head and neck are placed otherwise.
        kept = [joint for joint, name in enumerate(joints) if name not in ("head", "neck")]
        self.assertGreater(len(positions), 10)
        apart = np.linalg.norm(positions - source[:len(positions)], axis=2)
        self.assertLess(apart[:, kept].max(), metres)

    def test_every_rig_rate_unit_and_axis_gives_the_sources_positions(self):
        made = json.loads((self.made / "cases.json").read_text(encoding="utf-8"))
        for case in made["cases"]:
            with self.subTest(**case):
                rate, joints, positions = self.read(self.convert(case["name"]))
                self.assertEqual(rate, case["rate"])
                source = self.source("kick", made["names"][case["rig"]])
                self.assert_same(positions[::case["rate"] // 30], source, joints)

    def test_each_take_is_an_animation(self):
        file = self.convert("takes")
        # The punch has the bones of the kick, which are up to 5 mm longer.
        for sample, metres in (("kick", NEAR), ("punch", 0.01)):
            _, joints, positions = self.read(file, "--animation", f"kick|{sample}")
            self.assert_same(positions, self.source(sample, {}), joints, metres)

    def test_both_people_move(self):
        file = self.convert("people")
        for sample, side in (("kick", "left"), ("punch", "right")):
            _, joints, positions = self.read(file, "--side", side)
            self.assert_same(positions, self.source(sample, {}), joints)

    def test_what_blender_rejects_is_an_error(self):
        text = self.made / "text.fbx"
        text.write_text("; FBX 7.5.0 project file\n", encoding="utf-8")
        done = tools.run(DUET_FBX, text, self.made / "text.glb")
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("ASCII FBX files are not supported", done.stdout + done.stderr)
        self.assertEqual(tools.run(DUET_FBX, text, self.made / "text.bvh").returncode, 1)

    def test_the_commands_of_the_guide(self):
        self.assertEqual(self.run_blocks("contrib/formats/fbx.md", files={
            "kick.fbx": self.made / "takes.fbx", "character.fbx": self.made / "still.fbx"}), 3)


if __name__ == "__main__":
    if BLENDER is None:
        tools.skip("no blender; install the package blender")
    tools.main()
