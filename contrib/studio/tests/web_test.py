"""The page of contrib/studio in a real browser, through the gateway, against a real server: what one
person does with one file (studio_test.py tests the tools around it)."""

import json
import re

from studio_pages import FOLLOWER, HUG, StudioTest  # before modules that it makes available

import numpy as np  # noqa: E402
import tools  # noqa: E402
from duet_motion.rpc.v1 import status_pb2  # noqa: E402
from duet_motion.v1 import synthesis_pb2  # noqa: E402


class WebTest(StudioTest):
    def test_dropped_file_is_answered_only_after_react(self):
        page = self.open_still()
        self.drop(page)
        self.assertIn("91 frames at 30 Hz", page.text("#leader-name"))
        self.assertIn("Set at least one reaction", page.text("#status"))
        self.assertTrue(page.evaluate("element('react').disabled"))
        self.label(page, "hug", 1)
        self.label(page, "push", 0.5)
        self.assertEqual(page.text("#status"), "Press React.")
        self.assertEqual(page.evaluate("[state.takes.length, theatre.motion.people.follower]"),
                         [0, None])
        self.react(page)
        np.testing.assert_allclose(self.shown(page), self.expected({"hug": 1, "push": 0.5}),
                                   atol=1e-5)
        # Later changes take effect only at React.
        self.label(page, "push", 0)
        self.assertIn("press React", page.text("#status"))
        self.assertEqual(page.state()["answers"], "1")
        self.press(page, "another")
        np.testing.assert_allclose(self.shown(page), self.expected({"hug": 1}, seed=self.default_seed() + 1),
                                   atol=1e-5)

    def test_best_of_several_samples_and_its_grade(self):
        grade = r"^Twisted \d+ %, both feet move \d+ % \(leader \d+ %\), overlapping \d+ %\.$"
        page = self.open_still("#leader=hug.bvh&labels=hug:1&seed=3&candidates=4")
        self.assertEqual(page.text("#grade"), "")
        self.assertEqual(page.evaluate("document.querySelector('[name=candidates]').value"), "4")
        self.react(page)
        wanted = self.expected({"hug": 1}, seed=3, candidates=4)
        np.testing.assert_allclose(self.shown(page), wanted, atol=1e-5)
        self.assertRegex(page.text("#grade"), grade)
        self.set(page, "[name=candidates]", 1)
        self.assertEqual(page.evaluate("document.documentElement.dataset.stale"), "true")
        self.press(page, "show-eight")
        for index in range(8):
            page.evaluate(f"choose({index})")
            self.assertRegex(page.text("#grade"), grade)

    def test_link_and_file_restore_everything(self):
        page = self.open_still()
        self.drop(page)
        self.label(page, "hug", 1)
        self.set(page, "[name=seed]", 5)
        self.set(page, "[name=variety]", 0.5)
        self.set(page, "[name=start]", "0, 0.9, 1.2")
        self.press(page, "show-eight")
        page.evaluate("choose(state.chosen === 1 ? 2 : 1)")
        page.evaluate("choose(1)")
        before, link = self.shown(page), page.evaluate("location.hash")
        for part in ("labels=hug:1", "seed=6", "variety=0.5", "start=0, 0.9, 1.2", "model=sbu@"):
            self.assertIn(part, link.replace("%20", " "))
        self.browser.forget()
        stranger = self.open_still(link)  # it has the settings and not the file
        self.assertIn("visitor's hug.bvh", stranger.text("#empty"))
        self.assertEqual(stranger.evaluate("document.querySelector('[name=start]').value"),
                         "0, 0.9, 1.2")
        self.assertEqual(stranger.evaluate("document.querySelector('#labels [name=hug]').value"), "1")
        self.drop(stranger)
        self.react(stranger)
        np.testing.assert_allclose(self.shown(stranger), before, atol=1e-6)

    def take_sample(self, page, name):
        page.evaluate(f"attempt(takeSample)('{name}')")
        page.wait_until(f"state.leader.name === '{name}.bvh'")
        return page.evaluate("Object.fromEntries(Object.entries(settings.labels).filter("
                             "([, weight]) => weight !== 0))")

    def test_sample_sets_its_own_label(self):
        page = self.open_still()
        self.assertEqual(self.take_sample(page, "hug"), {"hug": 1})
        self.label(page, "push", 0.5)
        self.assertEqual(self.take_sample(page, "kick"), {"kick": 1})
        self.assertEqual(self.take_sample(page, "salsa"), {"basic": 1})  # of another model
        self.assertEqual(self.take_sample(page, "kick"), {"kick": 1})

    def test_single_pose_is_refused(self):
        page = self.open_still()
        lines = re.sub("Frames: .*", "Frames: 1", tools.sample("hug").read_text("utf-8")).split("\n")
        first = next(i for i, line in enumerate(lines) if line.startswith("Frame Time: ")) + 1
        text = "\n".join([*lines[:first + 1], ""])
        self.assertEqual(self.open_text(page, text, "pose.bvh"), "pose.bvh: expected a motion of at least 2 frames, got 1. "
                                               "A single pose has no reaction.")
        self.assertIsNone(page.evaluate("state.leader"))

    def test_scene_keeps_its_height_with_everything_open(self):
        page = self.open_still(HUG, width=1280, height=720)
        self.press(page, "show-eight")
        page.evaluate("element('curves').open = element('pins').open = true")
        page.next_frame()
        self.assertGreaterEqual(page.evaluate("element('view').clientHeight"), 0.45 * 720 - 1)
        top, bottom = page.evaluate("(({top, bottom}) => [top, bottom])("
                                    "element('transport').getBoundingClientRect())")
        self.assertTrue(0 < top < bottom < 720, (top, bottom))

    def test_link_opens_a_sample_and_invalid_links_are_harmless(self):
        page = self.open_still("#leader=hug.bvh&labels=hug:1,push:-0.25&seed=3")
        self.react(page)
        wanted = self.expected({"hug": 1, "push": -0.25}, seed=3)
        np.testing.assert_allclose(self.shown(page), wanted, atol=1e-5)
        for odd in ("#labels=hug:1e9,<b>:1&seed=-4&variety=9&candidates=17&side=up&model=nobody@7",
                    "#key=x;hug:1&key=-1&key=3&leader=%E0%A4%A&__proto__=1&takes=1", "#=&&==&%%%"):
            with self.subTest(odd):
                page = self.open_still(odd)
                self.assertEqual(page.evaluate("settings.seed"), "")
                self.assertLessEqual(page.evaluate("settings.variety"), 2)
                self.assertEqual(page.evaluate("settings.candidates"), 1)
                self.assertRegex(page.evaluate("settings.model"), "^sbu@")

    def test_keyframes_and_direction_are_sent(self):
        page = self.open_still()
        self.drop(page)
        for frame, weights in ((0, {"push": 1}), (60, {"push": 0, "hug": 1})):
            page.evaluate(f"seekAll({frame})")
            for name, weight in weights.items():
                self.label(page, name, weight)
            page.evaluate("element('add-key').click()")
            page.wait_until("theatre.frame === frameNow()")
        self.set(page, "[name=direction]", "0,0,1")
        self.set(page, "[name=clean_up]", "off")
        self.assertEqual(page.evaluate("settings.curves.push"), [[0, 1], [60, 0]])
        self.assertEqual(page.evaluate("settings.curves.hug"), [[0, 0], [60, 1]])
        self.react(page)
        classes = page.evaluate("state.model.interaction_classes")
        frames = {frame: {name: weights.get(name, 0) for name in classes}
                  for frame, weights in ((0, {"push": 1}), (60, {"hug": 1}))}
        wanted = self.expected(keyframes=frames, partner_direction=(0, 0, 1), clean_up=False)
        np.testing.assert_allclose(self.shown(page), wanted, atol=1e-5)

    def test_both_people_are_visible(self):
        for width, height in ((1000, 700), (375, 720)):
            with self.subTest(width=width):
                page = self.open_still(HUG, width=width, height=height)
                self.react(page)
                drawn = page.state()["draws"]
                page.evaluate("seekAll(45)")
                page.wait_until(f"document.documentElement.dataset.draws !== '{drawn}'")
                picture = page.picture()
                stage = {"left": 0, "right": 0.6 if width > 760 else 1, "top": 0,
                         "bottom": 0.5 if width > 760 else 0.4}
                self.assertGreater(picture.count(tools.is_leader_orange, **stage), 300)
                self.assertGreater(picture.count(tools.is_follower_teal, **stage), 300)
                self.assertTrue(page.evaluate("element('empty').hidden"))

    def test_every_control_works_on_a_phone_and_by_keyboard(self):
        page = self.open_still(HUG, width=375, height=720)
        page.evaluate("for (const part of document.querySelectorAll('details')) part.open = true")
        self.press(page, "show-eight")
        self.check_controls(page, "button, select, input:not([type=file]), summary, .button")
        reached = set()
        for _ in range(160):
            page.call("Input.dispatchKeyEvent", type="keyDown", key="Tab", windowsVirtualKeyCode=9)
            page.call("Input.dispatchKeyEvent", type="keyUp", key="Tab", windowsVirtualKeyCode=9)
            reached.add(page.evaluate(
                "document.activeElement.id || document.activeElement.textContent"))
        chosen = page.evaluate("gallery.tiles[0].textContent")
        self.assertLessEqual({"undo", "place", "play", "scrub",
                              chosen, "add-key", "file", "react",
                              "show-eight", "rig-download"} - reached, set())

    def test_plays_until_paused(self):
        page = self.open(width=500, height=500)
        self.drop(page)
        page.wait_until("theatre.player && theatre.player.frame > 0")
        page.click("#play")
        self.assertEqual(page.text("#play"), "Play")

    def test_downloads_match_the_view_and_are_named_after_the_settings(self):
        page = self.open_still("#leader=hug.bvh&labels=hug:1,push:0.5&seed=3&model=sbu@3")
        self.react(page)
        name = "hug_sbu@3_hug1_push0.5_seed3"
        page.evaluate("download('json')")
        self.assertEqual(page.state()["downloaded"], f"{name}.json")

        def saved(act):
            file, text = self.saved(page, lambda: page.evaluate(act))
            self.assertTrue(file.startswith(f"{name}."), file)
            return file[len(name):], text
        pair = json.loads(saved("download('json')")[1])
        np.testing.assert_allclose(np.ravel(pair["follower"]), page.evaluate(FOLLOWER), atol=1e-6)
        self.assertEqual(saved("download('bvh')")[0], ".zip")
        self.set(page, "[name=resample]", 60)
        self.assertEqual(json.loads(saved("download('json')")[1])["frame_rate_hz"], 60)
        file, rig = saved("downloadOnRig()")
        self.assertEqual(file, ".follower.bvh")
        self.assertEqual(re.findall(r"(?:ROOT|JOINT) \S+", rig), re.findall(
            r"(?:ROOT|JOINT) \S+", tools.sample("hug").read_text(encoding="utf-8")))
        # Settings that were changed after the answer do not change the name.
        self.label(page, "hug", -1)
        self.assertEqual(page.evaluate("downloadName(state.takes[0])"), name)

    def test_errors_of_gateway_and_server_are_displayed(self):
        page = self.open_still()
        self.drop(page, name="junk.bvh", fetched="/page.css")
        self.assertRegex(page.text("#status"), r"^junk\.bvh:1: ")
        self.drop(page)
        page.wait_until("state.leader && document.documentElement.dataset.failed === 'false'")
        self.label(page, "hug", 1)
        page.evaluate("state.leader.motion.frame_rate_hz = 1000; react(1)")
        page.wait_until("document.documentElement.dataset.failed === 'true'")
        self.assertRegex(page.text("#problems"), "leader.frame_rate_hz: ")
        self.set(page, "[name=start]", "somewhere")
        page.evaluate("react(1)")
        page.wait_until("element('status').textContent.startsWith('Follower starts at: ')")

    def test_reading_settings_change_the_leader(self):
        page = self.open_still()
        self.drop(page)
        height = "Math.max(...state.leader.motion.positions)"
        before = page.evaluate(height)
        self.set(page, "[name=metres_per_unit]", 0.005)
        page.evaluate("state.leader.old = true; element('reread').click()")
        page.wait_until("!state.leader.old || document.documentElement.dataset.failed === 'true'")
        self.assertAlmostEqual(page.evaluate(height), before / 2, places=2)
        self.assertIn("metres_per_unit=0.005", page.evaluate("location.hash"))
        self.set(page, "[name=joint_map]", "torso=Nobody")
        page.evaluate("element('reread').click()")
        page.wait_until("document.documentElement.dataset.failed === 'true'")
        self.assertIn("Nobody", page.text("#status"))

    def test_message_fields_match_the_proto_files(self):
        page = self.open()
        messages = page.evaluate("MESSAGES")
        self.assertIn("SynthesizeRequest", messages)
        files = (synthesis_pb2.DESCRIPTOR, *synthesis_pb2.DESCRIPTOR.dependencies,
                 status_pb2.DESCRIPTOR, *status_pb2.DESCRIPTOR.dependencies)
        known = {name: descriptor for file in files
                 for name, descriptor in file.message_types_by_name.items()}
        known.update(known["BadRequest"].nested_types_by_name)
        kinds = {1: "double", 2: "float", 4: "uint64", 8: "bool", 9: "string", 12: "bytes",
                 13: "uint32", 14: "enum"}
        for name, fields in messages.items():
            for field, (number, kind) in fields.items():
                wanted = known[name].fields_by_name[field]
                of = kinds.get(wanted.type) or wanted.message_type.name
                repeated = "[]" if wanted.label == wanted.LABEL_REPEATED else ""
                self.assertEqual((number, kind), (wanted.number, of + repeated), f"{name}.{field}")


if __name__ == "__main__":
    tools.main()
