"""The pages of the viewer, of a pair and of several motions, in a real browser, handled with real keys and clicks.

    viewer_test.py <write_test_page program>
"""

import sys

import browser
import tools

FRAMES = 90


class ViewerTest(browser.BrowserTest):
    shared = None  # see paused

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.file = cls.folder / "page.html"
        tools.run(WRITE_TEST_PAGE, cls.file).check_returncode()

    def open_good(self, suffix="", **size):
        page = self.open_page(self.file.as_uri() + suffix, **size)
        self.assertEqual(page.state()["state"], "ready", page.state())
        return page

    def paused(self, frame=0):
        """A page of good data, paused at a frame, that tests share: opening one costs the most."""
        if not ViewerTest.shared:
            ViewerTest.shared = self.browser.open(self.file.as_uri() + "#paused")
        page = ViewerTest.shared
        self.assertEqual(page.state()["state"], "ready", page.state())
        page.press("Home")
        page.evaluate(f"document.getElementById('stage').player.seek({frame})")
        page.press("0")
        return page

    def spoilt(self, old, new):
        """A copy of the page with something replaced."""
        html = self.file.read_text(encoding="utf-8")
        self.assertIn(old, html)
        copy = self.folder / f"{self.id()}.html"
        copy.write_text(html.replace(old, new), encoding="utf-8")
        return copy.as_uri()

    def test_page_plays_when_opened(self):
        page = self.open_good()
        self.assertEqual(page.state()["frames"], str(FRAMES))
        self.assertGreater(int(page.state()["triangles"]), 10_000)
        page.wait_until("Number(document.documentElement.dataset.frame) > 2")
        self.assertNotIn("error", page.state())
        self.assertEqual(page.events("Runtime.exceptionThrown"), [])

    def test_nothing_is_fetched(self):
        page = self.paused()
        urls = [event["request"]["url"] for event in page.events("Network.requestWillBeSent")]
        self.assertEqual(urls, [self.file.as_uri()])

    def test_policy_blocks_a_page_that_fetches(self):
        page = self.open_page(self.spoilt("\nstart();\n", """
            document.addEventListener('securitypolicyviolation', (event) => {
              document.documentElement.dataset.violation = event.effectiveDirective;
            });
            new Image().src = 'http://127.0.0.1:9/picture.png';
            start();
            """) + "#paused")
        page.wait_until("document.documentElement.dataset.violation === 'img-src'")

    def test_measure_button_shows_contact_and_distance(self):
        page = self.paused()
        self.assertEqual(page.text("#measures"), "")
        page.press("m")
        page.wait_until("document.getElementById('measures').textContent.includes('above the floor')")
        self.assertRegex(page.text("#measures"), r"(touch|nearest): .* to .*, \d\.\d\d m")
        page.click("#measure")
        self.assertTrue(page.evaluate("document.getElementById('measures').hidden"))

    def test_grade_is_in_figures(self):
        page = self.paused()
        rows = page.evaluate("Array.from(document.querySelectorAll('#grade p')).map((row) =>"
                             " [row.textContent, row.className])")
        self.assertEqual(rows, [["twisted5 %", "fault"], ["overlapping< 1 %", ""],
                                ["feet move40 %, leader 10 %", "fault"]])

    def test_next_fault_goes_through_the_bad_frames(self):
        page = self.open_good("#paused", width=1000, height=600)
        self.assertEqual(page.text("#next-fault"), "Marked frames: 3")
        for index, frame in enumerate((12, 50, 85, 12)):
            page.press("n") if index % 2 else page.click("#next-fault")
            self.assertEqual(page.state()["frame"], str(frame))
            self.assertEqual(page.text("#next-fault"), f"Marked frames {index % 3 + 1} of 3")
        for frame, text in ((15, "Marked frames 1 of 3"), (16, "Marked frames: 3"),
                            (11, "Marked frames: 3"), (89, "Marked frames 3 of 3")):
            page.evaluate(f"document.getElementById('stage').player.seek({frame})")
            page.press("0")
            self.assertEqual(page.text("#next-fault"), text, frame)

    def test_saves_png_and_glb(self):
        page = self.paused()
        page.click("#save-picture")
        page.wait_until("(document.documentElement.dataset.saved || '').includes('.png')")
        self.assertGreater(int(page.state()["saved"].split()[-1]), 10_000)
        page.click("#save-motion")
        self.assertRegex(page.state()["saved"], r"\.glb 12$")

    def test_saves_a_film_of_one_run(self):
        page = self.open_good("#frame=5&paused", width=320, height=240)
        page.evaluate("document.querySelector('[data-speed=\"2\"]').click()")
        page.evaluate("document.getElementById('save-film').click()")
        page.wait_until(f"document.documentElement.dataset.frame > {FRAMES // 2}")
        page.wait_until("(document.documentElement.dataset.saved || '').includes('.webm')")
        self.assertEqual(page.state()["frame"], str(FRAMES - 1))

    def test_draws_only_after_a_change(self):
        page = self.paused()
        drawn = page.state()["draws"]
        page.next_frame()
        page.next_frame()
        self.assertEqual(page.state()["draws"], drawn)
        page.press("ArrowRight")
        self.assertNotEqual(page.state()["draws"], drawn)

    def test_shows_both_characters_from_every_side(self):
        page = self.open_good("#frame=10&paused&view=top")
        for key, view in (("3", "top"), ("0", "reset"), ("1", "front"), ("2", "side")):
            if view != "top":  # the address chose it
                page.press(key)
            picture = page.picture()
            self.assertGreater(picture.count(tools.is_leader_orange), 300, view)
            self.assertGreater(picture.count(tools.is_follower_teal), 300, view)

    def test_no_button_covers_another_on_a_phone(self):
        page = self.open_good("#paused", width=390, height=844)
        covered = page.evaluate("""[...document.querySelectorAll('button')].filter((button) => {
            const {left, top, width, height} = button.getBoundingClientRect();
            return width && !button.contains(document.elementFromPoint(left + width / 2, top + height / 2));
        }).map((button) => button.textContent)""")
        self.assertEqual(covered, [])

    def test_keys_step_through_frames(self):
        page = self.paused()
        for key, frame in (("ArrowRight", 1), ("ArrowRight", 2), ("ArrowLeft", 1),
                           ("End", FRAMES - 1), ("ArrowRight", FRAMES - 1), ("Home", 0)):
            page.press(key)
            self.assertEqual(page.text("#frame"), str(frame), key)
        page.press("End")
        self.assertEqual(page.text("#time"), "2.97 / 2.97 s")
        page.press(" ")
        page.wait_until("document.querySelector('#play.playing')"
                        f" && Number(document.documentElement.dataset.frame) < {FRAMES - 1}")
        page.press(" ")
        self.assertFalse(page.evaluate("Boolean(document.querySelector('#play.playing'))"))

    def test_scrubbing_pauses_at_the_frame(self):
        page = self.open_good()
        page.click("#scrub")
        self.assertFalse(page.evaluate("Boolean(document.querySelector('#play.playing'))"))
        self.assertAlmostEqual(int(page.text("#frame")), FRAMES / 2, delta=2)

    def test_weights_follow_their_keyframes(self):
        page = self.paused(frame=30)  # half way from 0 to 60
        weights = page.evaluate(
            "[...document.querySelectorAll('.weight')].map((row) => row.textContent)")
        self.assertEqual(weights, ["kick−0.50", "hug−0.25"])
        page.press("End")
        self.assertEqual(page.text(".weight .value"), "−2.00")
        self.assertEqual(page.evaluate("document.querySelectorAll('#marks i').length"), 2)

    def test_a_character_can_be_hidden(self):
        page = self.paused(frame=10)
        page.click("[data-view=front]")
        page.click("[data-person=leader]")
        picture = page.picture()
        self.assertEqual(picture.count(tools.is_leader_orange), 0)
        self.assertGreater(picture.count(tools.is_follower_teal), 300)
        page.click("[data-person=leader]")
        self.assertGreater(page.picture().count(tools.is_leader_orange), 300)

    def test_camera_orbits_and_resets(self):
        page = self.open_good("#frame=10&paused", width=900)
        def orange():
            return page.picture().count(tools.is_leader_orange)
        page.click("[data-view=front]")
        self.assertEqual(page.text("[data-view].chosen"), "Front")
        before = orange()
        page.drag((450, 200), (600, 250))
        self.assertNotEqual(orange(), before)
        self.assertIsNone(page.evaluate("document.querySelector('[data-view].chosen')"))
        page.click("[data-view=front]")
        # What is left of the orbit's momentum may still turn the camera a little.
        self.assertAlmostEqual(orange(), before, delta=before / 4)

    def test_script_error_is_displayed(self):
        page = self.open_page(self.spoilt("\nstart();\n", "\nthrow new Error('boom');\n"))
        self.assertEqual(page.state()["state"], "failed")
        self.assertIn("boom", page.text("#failure"))

    def test_missing_webgl_is_reported(self):
        page = self.open_page(self.spoilt(
            "\nstart();\n", "\nHTMLCanvasElement.prototype.getContext = () => null;\nstart();\n"))
        self.assertEqual(page.state()["state"], "failed")
        self.assertIn("WebGL", page.text("#failure"))


class GalleryTest(browser.BrowserTest):
    """The page of duet view."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.file, pair = cls.folder / "view.html", cls.folder / "kick.json"
        browser.write_pair(pair)
        tools.duet("view", f"pair={pair}", tools.sample("hug"), "--out", cls.file).check_returncode()

    def open_good(self, suffix=""):
        page = self.open_page(self.file.as_uri() + suffix, width=1000, height=640)
        self.assertEqual(page.state()["state"], "ready", page.state())
        return page

    def test_plays_all_motions_at_once_until_the_timeline_is_clicked(self):
        page = self.open_good()
        self.assertEqual(page.state()["cells"], "2")
        page.wait_until("Number(document.documentElement.dataset.frame) > 2")
        page.click("#scrub")
        last = int(page.evaluate("document.getElementById('scrub').max"))
        self.assertFalse(page.evaluate("Boolean(document.querySelector('#play.playing'))"))
        self.assertAlmostEqual(int(page.text("#frame")), last / 2, delta=2)
        self.assertEqual(page.events("Runtime.exceptionThrown"), [])

    def test_every_motion_is_in_view_and_a_person_can_be_hidden(self):
        page = self.open_good("#frame=20&paused&view=top")
        sides = {"top": 0.2, "bottom": 0.65}

        def counts():
            picture = page.picture()
            return [picture.count(colour, **half, **sides) for half in ({"left": 0, "right": 0.5}, {"left": 0.5, "right": 1})
                    for colour in (tools.is_leader_orange, tools.is_follower_teal)]
        for key in ("3", "0", "1", "2"):
            page.press(key)
            self.assertEqual([count > 300 for count in counts()], [True, True, True, False], key)
        page.click("[data-person=leader]")
        self.assertEqual([count > 0 for count in counts()], [False, True, False, False])


WRITE_TEST_PAGE = sys.argv.pop(1)


if __name__ == "__main__":
    browser.find_chromium()
    tools.main()
