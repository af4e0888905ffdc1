"""The studio with models of other joints, in a real browser against a real server."""

import json
import pathlib
import tempfile

from studio_pages import FOLLOWER, StudioTest  # before modules that it makes available

import numpy as np  # noqa: E402
import tools  # noqa: E402


class StudioModelsTest(StudioTest):
    def choose_model(self, page, name):
        self.set(page, "[name=model]", page.evaluate(
            f"state.models.map(nameOf).find((model) => model.startsWith('{name}@'))"))

    def take_sample(self, page, name):
        page.evaluate(f"""[...document.querySelectorAll('#samples button')].find(
            (button) => button.textContent === '{name}').click()""")
        page.wait_until(f"state.leader && state.leader.name === '{name}.bvh'")

    def joints(self, page):
        return page.evaluate("state.leader.motion.joint_names")

    def open_dance(self):
        """The sample salsa, answered."""
        page = self.open_still(width=1200, height=900)
        self.take_sample(page, "salsa")
        self.react(page)
        return page

    def test_sample_of_a_dance_selects_its_model_and_is_answered(self):
        page = self.open_dance()
        self.assertTrue(page.evaluate("settings.model").startswith("salsa@"))
        self.assertEqual(page.evaluate("settings.labels"), {"basic": 1})
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "pair.json"
            tools.duet("synthesize", "--server", self.server.address, "--model", "salsa", "--leader",
                       tools.sample("salsa"), "--label", "basic=1", "--out", file).check_returncode()
            pair = json.loads(file.read_text(encoding="utf-8"))
        self.assertEqual(self.joints(page), pair["joint_names"])
        np.testing.assert_allclose(page.evaluate(FOLLOWER), np.ravel(pair["follower"]), atol=2e-3)
        picture = page.picture()
        stage = {"left": 0, "right": 0.6, "top": 0, "bottom": 0.5}
        self.assertGreater(picture.count(tools.is_leader_orange, **stage), 300)
        self.assertGreater(picture.count(tools.is_follower_teal, **stage), 300)

    def test_downloads_have_all_joints(self):
        page = self.open_dance()
        name, text = self.saved(page, lambda: page.evaluate("attempt(download)('json')"))
        self.assertRegex(name, r"^salsa_salsa@\d+_basic1_seed\d+\.json$")
        pair = json.loads(text)
        self.assertEqual(pair["joint_names"], self.joints(page))
        np.testing.assert_allclose(np.ravel(pair["follower"]), page.evaluate(FOLLOWER), atol=1e-5)
        name, text = self.saved(page, lambda: page.evaluate("attempt(downloadOnRig)()"))
        self.assertRegex(name, r"\.follower\.bvh$")
        with tempfile.TemporaryDirectory() as folder:
            files = [pathlib.Path(folder) / name for name in ("pair.json", "on_rig.bvh", "on_rig.json")]
            files[0].write_text(json.dumps(pair), encoding="utf-8")
            files[1].write_text(text, encoding="utf-8")
            tools.duet("convert", files[1], "--skeleton", files[0], "--out", files[2]).check_returncode()
            on_rig = np.array(json.loads(files[2].read_text(encoding="utf-8"))["leader"])
        follower = np.array(pair["follower"])
        for side in ("left", "right"):
            ankle, toe = (pair["joint_names"].index(f"{side}_{joint}") for joint in ("ankle", "toe"))
            self.assertLess(np.abs(on_rig[:, ankle] - follower[:, ankle]).max(), 0.002)
            self.assertLess(np.abs(on_rig[:, toe] - follower[:, toe]).max(), 0.05)

    def test_model_with_other_joints_reads_the_leader_again(self):
        page = self.open_dance()
        self.choose_model(page, "sbu")
        page.wait_until("state.leader.motion.joint_names.length === 15")
        self.assertEqual(page.evaluate("state.takes.length"), 0)
        page.evaluate("undoHistory.undo()")
        self.assertTrue(page.evaluate("settings.model").startswith("salsa@"))
        self.assertIn("left_toe", self.joints(page))
        self.assertEqual(page.evaluate("state.takes.length"), 1)

    def test_leader_without_the_models_joints_is_refused_and_undone(self):
        page = self.open_still(width=1200, height=900)
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "hug.csv"
            tools.duet("convert", tools.sample("hug"), "--out", file).check_returncode()
            text = json.dumps(file.read_text(encoding="utf-8"))
        page.evaluate(f"attempt(takeFile)(new File([{text}], 'hug.csv'))")
        page.wait_until("state.leader")
        self.label(page, "hug", 1)
        self.choose_model(page, "salsa")
        page.wait_until("document.documentElement.dataset.failed === 'true'")
        self.assertIn("left_toe", page.text("#status"))
        self.assertIsNone(page.evaluate("state.leader"))
        page.evaluate("undoHistory.undo()")
        self.assertTrue(page.evaluate("settings.model").startswith("sbu@"))
        self.assertEqual(len(self.joints(page)), 15)
        self.react(page)
        self.choose_model(page, "salsa")
        page.wait_until("state.leader === null")
        self.take_sample(page, "kick")  # which selects a model with this class
        self.assertFalse(page.evaluate("settings.model").startswith("salsa@"))

    def test_link_to_a_dance_restores_it(self):
        page = self.open_dance()
        shown = page.evaluate(FOLLOWER)
        again = self.open_still(page.evaluate("location.hash"), width=1200, height=900)
        self.assertEqual(again.evaluate("settings.model"), page.evaluate("settings.model"))
        self.react(again)
        np.testing.assert_allclose(again.evaluate(FOLLOWER), shown, atol=1e-6)

    def test_pins_work_with_every_joint(self):
        page = self.open_dance()
        page.evaluate("""seekAll(100); setPin(settings, 'left_wrist', 100,
            pinHandles.placeOf('left_wrist', 100).map((value, i) => value + (i === 1 ? 0.1 : 0)));
            changed('test')""")
        self.react(page)
        self.assertLess(page.evaluate("state.takes[0].pins[0].metres"), 0.1)


if __name__ == "__main__":
    tools.main()
