"""The pages of duet view in a real browser."""

import json

import browser
import tools


class GalleryTest(tools.FolderTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.file = cls.folder / "view.html"
        cls.compared = cls.folder / "compare.html"
        pair = cls.folder / "kick.json"
        tools.duet("convert", tools.sample("kick"), "--out", pair).check_returncode()
        motion = json.loads(pair.read_text(encoding="utf-8"))
        motion["follower"] = [[(x, y, z + 1.2) for x, y, z in pose] for pose in motion["leader"]]
        pair.write_text(json.dumps(motion), encoding="utf-8")
        for command in (("view", f"pair={pair}", tools.sample("hug"), "--out", cls.file),
                        ("view", f"first={pair}", f"second={pair}", "--out", cls.compared)):
            result = tools.duet(*command)
            assert result.returncode == 0, result.stderr
        cls.browser = browser.Browser()
        cls.addClassCleanup(cls.browser.close)

    def open(self, suffix="", file=None, **size):
        page = self.browser.open((file or self.file).as_uri() + suffix, **size)
        self.addCleanup(page.close)
        self.assertEqual(page.state()["state"], "ready", page.state())
        return page

    def test_plays_all_motions_at_once(self):
        page = self.open()
        self.assertEqual(page.state()["cells"], "2")
        self.assertGreater(int(page.state()["triangles"]), 20_000)
        page.wait_until("Number(document.documentElement.dataset.frame) > 2")
        self.assertEqual(page.events("Runtime.exceptionThrown"), [])

    def test_every_motion_is_in_view_from_every_side(self):
        page = self.open("#frame=20&paused&view=top", width=1000, height=640)
        for key, view in (("3", "top"), ("0", "reset"), ("1", "front"), ("2", "side")):
            if view != "top":  # the address chose it
                page.press(key)
            picture = page.picture()
            sides = {"left": 0.0, "right": 0.5, "top": 0.1, "bottom": 0.65}
            left = {**sides, "right": 0.5}
            right = {**sides, "left": 0.5, "right": 1.0}
            self.assertGreater(picture.count(tools.is_leader_orange, **left), 300, view)
            self.assertGreater(picture.count(tools.is_follower_teal, **left), 300, view)
            self.assertGreater(picture.count(tools.is_leader_orange, **right), 300, view)
            self.assertEqual(picture.count(tools.is_follower_teal, **right), 0, view)

    def test_curves_follow_the_timeline(self):
        page = self.open("#frame=30&paused", width=1000, height=640)
        titles = page.evaluate(
            "[...document.querySelectorAll('.chart b')].map((title) => title.textContent)")
        self.assertEqual(titles, ["Speed", "Distance between them"])
        counts = page.evaluate("[...document.querySelectorAll('.chart')]"
                               ".map((chart) => chart.querySelectorAll('polyline').length)")
        self.assertEqual(counts, [2, 1])  # one alone has no distance
        line, thumb = page.evaluate("""(() => {
          const last = Number(document.getElementById('scrub').max);
          const track = document.getElementById('scrub').getBoundingClientRect();
          return [document.querySelector('.chart .now').getBoundingClientRect().left,
                  track.left + 7 + (track.width - 14) * 30 / last];
        })()""")
        self.assertAlmostEqual(line, thumb, delta=1.5)

    def test_click_in_the_curves_seeks(self):
        page = self.open("", width=1000, height=640)
        page.click("#charts")
        last = int(page.evaluate("document.getElementById('scrub').max"))
        self.assertFalse(page.evaluate("Boolean(document.querySelector('#play.playing'))"))
        self.assertAlmostEqual(int(page.text("#frame")), last / 2, delta=2)

    def test_hiding_a_person_applies_to_every_cell(self):
        page = self.open("#frame=20&paused", width=1000, height=640)
        page.click("[data-person=leader]")
        picture = page.picture()
        everywhere = {"left": 0, "right": 1, "top": 0.2, "bottom": 0.65}
        self.assertEqual(picture.count(tools.is_leader_orange, **everywhere), 0)
        self.assertGreater(picture.count(tools.is_follower_teal, **everywhere), 300)


if __name__ == "__main__":
    browser.find_chromium()
    tools.main()
