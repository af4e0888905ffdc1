"""The studio in a real browser, through a gateway, against a real server: what its tests share."""

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
FOLLOWER = "Array.from(state.takes[state.chosen].positions)"


class StudioTest(unittest.TestCase):
    """A server, a gateway and a browser for all tests of a class."""

    @classmethod
    def setUpClass(cls):
        cls.browser = Browser()  # first: without one, the test ends here
        cls.addClassCleanup(cls.browser.close)
        cls.server = tools.Server()
        cls.addClassCleanup(cls.server.stop)
        cls.gateway = gateways.Gateway(cls.server.address)
        cls.addClassCleanup(cls.gateway.stop)

    def setUp(self):
        self.browser.forget()

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
