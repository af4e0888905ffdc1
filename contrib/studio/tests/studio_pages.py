"""The pages in a real browser, through a gateway, against a real server: what their tests share."""

import json
import unittest

import gateways
import tools
from browser import Browser

gateways.prepare()

import duet_motion as duet  # noqa: E402
import numpy as np  # noqa: E402

# Drops a file on the page like a visitor; its text comes from the URL `fetched`.
DROP = """(async () => {{
  const text = await (await fetch({fetched})).text();
  const transfer = new DataTransfer();
  transfer.items.add(new File([text], {name}));
  window.dispatchEvent(new DragEvent('drop', {{dataTransfer: transfer, cancelable: true}}));
}})()"""
# Sets a field like a visitor, by its selector.
SET = """(() => {{
  const field = document.querySelector({selector});
  field.value = {value};
  field.dispatchEvent(new Event('input', {{bubbles: true}}));
}})()"""
# Keeps the text of what the page saves, in place of downloading it.
CATCH_SAVED = """window.saved = [];
  saveBlob = async (blob, name) => { window.saved.push([name, await blob.text()]); }; undefined"""
# The visible controls of a page, as [name, width, height], and those without an accessible name.
TARGETS = """[...document.querySelectorAll({selector})]
    .filter((item) => item.offsetParent !== null)
    .map((item) => [item.id || item.name || item.textContent.trim(),
                    item.getBoundingClientRect().width, item.getBoundingClientRect().height])"""
NAMELESS = """[...document.querySelectorAll('input, select, textarea, button')].filter((item) =>
    !(item.labels?.length || item.getAttribute('aria-label') || item.textContent.trim()))
    .map((item) => item.outerHTML)"""
HUG = "#leader=hug.bvh&labels=hug:1"
FOLLOWER = "Array.from(state.takes[state.chosen].positions)"


class PageTest(unittest.TestCase):
    """A server on a port of its own, a gateway and a browser for all tests of a class."""

    @classmethod
    def setUpClass(cls):
        cls.browser = Browser()  # first: without one, the test ends here
        cls.addClassCleanup(cls.browser.close)
        cls.port = tools.free_port()
        cls.server = tools.Server(port=cls.port)
        cls.addClassCleanup(lambda: cls.server.stop())  # the one that serves at the end
        cls.gateway = gateways.Gateway(cls.server.address)
        cls.addClassCleanup(cls.gateway.stop)

    def setUp(self):
        self.browser.forget()

    def check_controls(self, page, selector):
        """The page is as wide as the screen, and a finger can hit its controls, which have names."""
        self.assertLessEqual(page.evaluate("document.documentElement.scrollWidth"), 375)
        for what, width, height in page.evaluate(TARGETS.format(selector=json.dumps(selector))):
            self.assertGreaterEqual(min(width, height), 40, what)
        self.assertEqual(page.evaluate(NAMELESS), [])


class StudioTest(PageTest):
    """The studio."""

    def open(self, address="", **size):
        page = self.browser.open(f"{self.gateway.url}/{address}", **size)
        self.assertEqual(page.state()["state"], "ready", page.text("#status"))
        return page

    def open_still(self, address="", **size):
        """Opens the page without animation: it draws only when something changed."""
        return self.open(address, still=True, **size)

    def drop(self, page, name="visitor's hug.bvh", fetched="/samples/hug.bvh"):
        page.evaluate(DROP.format(name=json.dumps(name), fetched=json.dumps(fetched)))
        page.wait_until("state.leader || document.documentElement.dataset.failed === 'true'")

    def set(self, page, selector, value):
        page.evaluate(SET.format(selector=json.dumps(selector), value=json.dumps(str(value))))

    def label(self, page, name, weight):
        self.set(page, f"#labels input[name={name}]", weight)

    def key(self, page, key, modifiers=0):
        """A real key stroke; modifiers: 2 is Ctrl, 8 is Shift."""
        for kind in ("keyDown", "keyUp"):
            page.call("Input.dispatchKeyEvent", type=kind, key=key, modifiers=modifiers,
                      text=key if len(key) == 1 and kind == "keyDown" and not modifiers else "")
        page.next_frame()

    def touch(self, page, start, end):
        """Drags with a finger."""
        for kind, point in (("touchStart", start), ("touchMove", end), ("touchEnd", None)):
            page.call("Input.dispatchTouchEvent", type=kind,
                      touchPoints=[{"x": point[0], "y": point[1]}] if point else [])

    def seek(self, page, frame):
        page.evaluate(f"seekAll({frame})")
        page.wait_until(f"theatre.frame === {frame}")

    def saved(self, page, act):
        """The name and the text of the file that the page saves."""
        page.evaluate(CATCH_SAVED)
        act()
        page.wait_until("window.saved.length > 0 || document.documentElement.dataset.failed === 'true'")
        self.assertEqual(page.state()["failed"], "false", page.text("#status"))
        return page.evaluate("window.saved.pop()")

    def open_text(self, page, text, name):
        """Opens a text as a file; returns what the page tells of it."""
        page.evaluate("tell('opening')")
        page.evaluate(f"attempt(takeFile)(new File([{json.dumps(text)}], {json.dumps(name)}))")
        return page.text("#status")

    def press(self, page, button):
        """Presses a button, and waits for the answers."""
        before = int(page.state().get("answers", 0))
        page.evaluate(f"element({json.dumps(button)}).click()")
        page.wait_until(f"Number(document.documentElement.dataset.answers) > {before} || "
                        "document.documentElement.dataset.failed === 'true'")
        self.assertEqual(page.state()["failed"], "false", page.text("#status"))

    def react(self, page):
        self.press(page, "react")

    def shown(self, page, frames=91):
        return np.reshape(page.evaluate(FOLLOWER), (frames, 15, 3))

    def default_seed(self, sample="hug"):
        """The seed that the server chooses for a sample."""
        with duet.Client(self.server.address) as client:
            return client.synthesize(duet.read_motion(tools.sample(sample)), {"hug": 1}).seed

    def expected(self, labels=None, **settings):
        with duet.Client(self.server.address) as client:
            if labels is not None:
                classes = client.get_model().model.interaction_classes
                settings["labels"] = {name: labels.get(name, 0) for name in classes}
            return client.synthesize(duet.read_motion(tools.sample("hug")),
                                     **settings).follower.positions
