"""The viewer's element, <duet-motion>, on other pages in a real browser.

    element_test.py
"""

import functools
import http.server
import json
import sys
import threading

import browser
import tools

sys.path.insert(0, str(tools.SOURCE / "client" / "viewer"))

import element  # noqa: E402

PAGE = """<!doctype html><meta charset="utf-8"><meta name="viewport" content="width=device-width">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; connect-src 'self';
 script-src {scripts}; style-src 'self'">
{body}
<script src="events.js"></script><script src="duet-motion.js"></script>"""
# Sets the state when every element is ready or has failed, and stores their events.
EVENTS = """
window.told = [];
const elements = [...document.querySelectorAll('duet-motion')];
let left = elements.length;
for (const one of elements) {
  for (const name of ['ready', 'play', 'pause', 'error', 'orbit', 'drawn']) {
    one.addEventListener(name, ({type, detail}) => {
      if (type !== 'drawn') window.told.push([elements.indexOf(one), type, detail]);
      if ((type === 'drawn' || type === 'error') && !one.dataset.seen) {
        one.dataset.seen = type;
        if (--left === 0) document.documentElement.dataset.state = 'ready';
      }
    });
  }
}
"""


class ElementTest(browser.BrowserTest):
    pages = 0  # opened so far

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        element.main([str(cls.folder / "duet-motion.js")])
        (cls.folder / "events.js").write_text(EVENTS, encoding="utf-8")
        motion = browser.write_pair(cls.folder / "pair.json")
        cls.frames = len(motion["leader"])
        cls.inline = f'<script type="application/json">{json.dumps(motion)}</script>'
        alone = {name: value for name, value in motion.items() if name != "follower"}
        (cls.folder / "alone.json").write_text(json.dumps(alone), encoding="utf-8")
        (cls.folder / "sunk.json").write_text(json.dumps({**motion, "up_axis": "z-up"}))
        (cls.folder / "broken.json").write_text("{", encoding="utf-8")
        handler = functools.partial(Handler, directory=str(cls.folder))
        cls.server = Server(("127.0.0.1", 0), handler)
        threading.Thread(target=cls.server.serve_forever, daemon=True).start()
        cls.addClassCleanup(cls.server.server_close)
        cls.addClassCleanup(cls.server.shutdown)

    def open(self, body, over="http", **size):
        # A page from a file has no origin for 'self'.
        scripts = "'self'" if over == "http" else "'unsafe-inline' file:"
        ElementTest.pages += 1
        file = self.folder / f"{ElementTest.pages}.html"
        file.write_text(PAGE.format(body=body, scripts=scripts), encoding="utf-8")
        url = file.as_uri() if over == "file" else \
            f"http://127.0.0.1:{self.server.server_port}/{file.name}"
        page = self.open_page(url, **size)
        self.assertEqual(page.events("Runtime.exceptionThrown"), [])
        return page

    def told(self, page, *kinds):
        return [what for what in page.evaluate("window.told") if what[1] in kinds]

    def sees(self, page, leader=True, follower=True, **where):
        picture = page.picture()
        self.assertEqual(picture.count(tools.is_leader_orange, **where) > 100, leader)
        self.assertEqual(picture.count(tools.is_follower_teal, **where) > 100, follower)

    def frame(self, page):
        return page.evaluate("document.querySelector('duet-motion').frame")

    def test_two_elements_with_inline_data_work_from_a_file(self):
        page = self.open(f"<duet-motion paused>{self.inline}</duet-motion>" * 2, over="file",
                         width=500, height=620)
        self.sees(page, bottom=0.48)
        self.sees(page, top=0.52)
        urls = {event["request"]["url"].rsplit("/", 1)[-1]
                for event in page.events("Network.requestWillBeSent")}
        self.assertLessEqual(urls, {f"{self.pages}.html", "events.js", "duet-motion.js"})

    def test_fetches_only_src_and_defines_no_global_names(self):
        page = self.open('<duet-motion src="pair.json" paused></duet-motion>')
        self.sees(page)
        self.assertEqual(self.told(page, "ready"), [[0, "ready", {"frames": self.frames, "frameRate": 30}]])
        self.assertEqual(page.evaluate("[typeof THREE, typeof Motion, typeof Stage]"),
                         ["undefined"] * 3)

    def test_src_may_change_and_the_element_may_move(self):
        page = self.open('<duet-motion src="pair.json" paused frame="7"></duet-motion>')
        page.evaluate("elements[0].remove()")
        page.next_frame()
        page.evaluate("document.body.append(elements[0])")
        page.wait_until("elements[0].stage")
        self.assertEqual(self.frame(page), 7)
        page.evaluate("elements[0].setAttribute('src', 'alone.json')")
        page.wait_until("window.told.filter(([, kind]) => kind === 'ready').length === 2")
        page.next_frame()
        self.sees(page, follower=False)

    def test_script_sets_the_motion_and_hides_a_person(self):
        page = self.open(f"<duet-motion paused>{self.inline}</duet-motion>", over="file")
        page.evaluate("elements[0].show('leader', false)")
        page.next_frame()
        self.sees(page, leader=False)
        page.evaluate("elements[0].motion = {...JSON.parse(elements[0].textContent), follower: null}")
        page.next_frame()
        self.sees(page, follower=False)

    def test_attributes_set_frame_speed_and_view(self):
        page = self.open('<duet-motion src="pair.json" paused frame="12" view="top" speed="2" once>'
                         '</duet-motion>')
        self.assertEqual(self.frame(page), 12)
        self.assertEqual(page.evaluate("[elements[0].view, elements[0].player.speed,"
                                       " elements[0].player.looping]"), ["top", 2, False])
        page.evaluate("elements[0].setAttribute('frame', '30')")
        self.assertEqual(self.frame(page), 30)
        page.evaluate("elements[0].removeAttribute('paused')")
        page.wait_until(f"elements[0].frame === {self.frames - 1} && !elements[0].playing")
        page.next_frame()
        self.assertEqual([kind for _, kind, _ in self.told(page, "play", "pause")],
                         ["play", "pause"])

    def test_keys_control_only_the_focused_element(self):
        page = self.open('<duet-motion src="pair.json" paused></duet-motion>' * 2)
        page.press("ArrowRight")
        self.assertEqual(self.frame(page), 0)
        page.press("Tab")
        for key, frame in (("ArrowRight", 1), ("End", self.frames - 1), ("ArrowLeft", self.frames - 2),
                           ("Home", 0)):
            page.press(key)
            self.assertEqual(self.frame(page), frame, key)
        page.press("3")
        self.assertEqual(page.evaluate("elements.map((one) => one.view)"), ["top", "reset"])
        page.press(" ")
        self.assertEqual(page.evaluate("elements.map((one) => one.playing)"), [True, False])

    def test_controls_play_and_seek(self):
        page = self.open('<duet-motion src="pair.json" paused controls></duet-motion>')
        inside = "elements[0].shadowRoot.querySelector('[part={}]')"
        x, y = page.evaluate(f"(() => {{ const box = {inside.format('time')}.getBoundingClientRect();"
                             " return [box.left + box.width / 2, box.top + box.height / 2]; })()")
        page.mouse("mousePressed", x, y)
        page.mouse("mouseReleased", x, y, buttons=0)
        page.next_frame()
        self.assertAlmostEqual(self.frame(page), self.frames / 2, delta=2)
        page.evaluate(f"{inside.format('play')}.click()")
        self.assertTrue(page.evaluate("elements[0].playing"))
        self.assertEqual(page.evaluate("elements[0].shadowRoot.querySelector('output').textContent")
                         .split("/")[1], f" {(self.frames - 1) / 30:.2f} s")

    def test_does_not_draw_while_invisible(self):
        page = self.open('<duet-motion src="pair.json"></duet-motion><pre>' + "\n" * 200 + "</pre>")
        page.evaluate("window.scrollTo(0, 100000)")
        page.wait_until("!elements[0].onScreen")
        drawn = page.evaluate("elements[0].draws")
        page.next_frame()
        page.next_frame()
        self.assertEqual(page.evaluate("elements[0].draws"), drawn)

    def test_load_errors_are_reported(self):
        for source, why in (("nowhere.json", "404"), ("broken.json", "JSON"),
                            ("sunk.json", "expected metres, y-up, got metres, z-up")):
            page = self.open(f'<duet-motion src="{source}"></duet-motion>')
            ((_, _, detail),) = self.told(page, "error")
            self.assertIn(source, detail["message"])
            self.assertIn(why, detail["message"])
            self.assertEqual(page.evaluate("elements[0].shadowRoot.querySelector('[role=alert]')"
                                           ".textContent"), detail["message"])


class Handler(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *values):
        """Logs nothing."""


class Server(http.server.ThreadingHTTPServer):
    request_queue_size = 128  # the browser opens many connections at once


if __name__ == "__main__":
    browser.find_chromium()
    if not (element.THREE / "three.min.js").is_file():
        tools.skip("no three.js; install the package libjs-three")
    tools.main()
