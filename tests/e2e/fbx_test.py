"""FBX leaders and pairs through every command that reads motion files."""

import json
import shutil

import tools

FILES = tools.SOURCE / "tests/formats/fbx/files"
RECIPE = 'reactions { each_class { classes: "kick" } }\noutput { formats: FORMAT_NPY }\n'


class FbxTest(tools.ServedTest):
    def synthesize(self, out, *flags):
        return tools.duet("synthesize", "--server", self.server.address, "--label", "kick=1", "--out",
                          self.folder / out, *flags)

    def test_inspect_shows_unit_axis_rate_and_takes(self):
        done = tools.duet("inspect", FILES / "two_takes_30.fbx")
        self.assertEqual(done.returncode, 0, done.stderr)
        for words in ("FBX", "UnitScaleFactor 1", "y-up", "30 Hz", "Rig|kick", "Rig|punch"):
            self.assertIn(words, done.stdout)

    def test_a_leader_gets_its_follower(self):
        self.synthesize("pair.csv", "--leader", FILES / "metres_z_up_24.fbx").check_returncode()
        self.assertIn("frame_rate_hz=24", (self.folder / "pair.csv").read_text(encoding="utf-8"))

    def test_the_follower_is_put_on_a_skinned_rig(self):
        done = self.synthesize("rig.glb", "--leader", FILES / "mixamo_skin_30.fbx", "--follower-rig",
                               FILES / "still_skin.fbx")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn(b"JOINTS_0", (self.folder / "rig.follower.glb").read_bytes())

    def test_an_unknown_take_is_rejected_with_the_known_ones(self):
        done = self.synthesize("none.glb", "--leader", FILES / "two_takes_30.fbx", "--animation", "walk")
        self.assertNotEqual(done.returncode, 0)
        self.assertIn('expected "Rig|kick", "Rig|punch", got "walk"', done.stderr)

    def test_a_folder_of_pairs_becomes_a_data_set(self):
        pairs = self.folder / "pairs" / "kick"
        pairs.mkdir(parents=True)
        for number in range(4):
            shutil.copy(FILES / "two_people_30.fbx", pairs / f"{number}.fbx")
        done = tools.run(tools.PROGRAMS / "duet-import", "--from", self.folder / "pairs", "--out",
                         self.folder / "set", "--skeleton", "sbu")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertTrue((self.folder / "set" / "dataset.json").exists())

    def test_a_batch_reads_a_folder_of_leaders(self):
        leaders = self.folder / "leaders"
        leaders.mkdir()
        for name in ("centimetres_y_up_30", "metres_z_up_24"):
            shutil.copy(FILES / f"{name}.fbx", leaders)
        recipe = self.folder / "recipe.textproto"
        recipe.write_text(RECIPE, encoding="utf-8")
        out = self.folder / "batch"
        done = tools.duet("batch", leaders, "--recipe", recipe, "--out", out, "--server",
                          self.server.address)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        summary = json.loads((out / "summary.json").read_text(encoding="utf-8"))
        self.assertEqual((summary["done"], summary["missing"]), (2, 0), summary)


if __name__ == "__main__":
    if not (tools.PROGRAMS / "duet-fbx").exists():
        tools.skip("duet was built without libassimp-dev (DUET_FBX)")
    tools.main()
