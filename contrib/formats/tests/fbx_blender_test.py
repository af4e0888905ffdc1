"""FBX files that Blender's exporter writes: every combination of four rigs, three rates, three units and
two axes is read as its source."""

import json
import shutil

import numpy as np
import tools

BLENDER = shutil.which("blender")
SCRIPT = tools.SOURCE / "contrib/formats/tests/fbx/fbx_matrix.py"
MAKE_FILES = tools.SOURCE / "contrib/formats/tests/fbx/make_files.py"
MILLIMETRE = 0.001


class FbxBlenderTest(tools.FolderTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        done = tools.run(BLENDER, "--background", "--factory-startup", "--python-exit-code", "1",
                         "--python", SCRIPT, "--", MAKE_FILES, cls.folder)
        assert done.returncode == 0, done.stdout + done.stderr
        cls.written = json.loads((cls.folder / "cases.json").read_text(encoding="utf-8"))
        cls.sources = {rig: cls.source(rig, names) for rig, names in cls.written["names"].items()}

    @classmethod
    def read(cls, file):
        """The rate, the joints' names and the positions of a motion."""
        if file.suffix == ".fbx":
            done = tools.run(tools.PROGRAMS / "duet-fbx", file, file.with_suffix(".glb"))
            assert done.returncode == 0, f"{file.name}: {done.stderr}"
            file = file.with_suffix(".glb")
        out = file.with_suffix(".json")
        done = tools.duet("convert", file, "--out", out, "--quiet")
        assert done.returncode == 0, f"{file.name}: {done.stderr}"
        motion = json.loads(out.read_text(encoding="utf-8"))
        return motion["frame_rate_hz"], motion["joint_names"], np.array(motion["leader"])

    @classmethod
    def source(cls, rig, names):
        """The sample with the rig's names, which decide how its joints are mapped."""
        text = tools.sample("kick").read_text(encoding="utf-8")
        for joint, name in names.items():
            for word in ("ROOT", "JOINT"):
                text = text.replace(f"{word} {joint}\n", f"{word} {name}\n")
        file = cls.folder / f"{rig}.bvh"
        file.write_text(text, encoding="utf-8")
        first = cls.written["first"]
        return cls.read(file)[2][first:first + cls.written["frames"]]

    def test_every_rig_rate_unit_and_axis_gives_the_sources_positions(self):
        self.assertEqual(len(self.written["cases"]), 4 * 3 * 3 * 2)
        for case in self.written["cases"]:
            with self.subTest(**case):
                rate, joints, positions = self.read(self.folder / case["file"])
                self.assertEqual(rate, case["rate"])
                # The files have no end of the head, so its middle is placed otherwise.
                kept = [joint for joint, name in enumerate(joints) if name != "head"]
                source = self.sources[case["rig"]]
                self.assertEqual(positions.shape, source.shape)
                apart = np.linalg.norm(positions - source, axis=2)[:, kept]
                self.assertLess(apart.max(), MILLIMETRE)


if __name__ == "__main__":
    if BLENDER is None:
        tools.skip("no blender; install the package blender")
    if not (tools.PROGRAMS / "duet-fbx").exists():
        tools.skip("no duet-fbx; it needs libassimp-dev")
    tools.main()
