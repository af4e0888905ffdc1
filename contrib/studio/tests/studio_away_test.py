"""The pages of contrib/studio while the server or the gateway is away, in a real browser."""

import unittest

import gateways
import tools
from browser import Browser

gateways.prepare()

AWAY = (r"^The server at 127\.0\.0\.1:\d+ is not running: it refused the connection\. Start it with "
        r"duet-server, or start the gateway with another one \(--server HOST:PORT\)\.")
HUG = "/#leader=hug.bvh&labels=hug:1"
FAILED = "document.documentElement.dataset.failed === 'true'"
IS_READY = "document.documentElement.dataset.state === 'ready'"
ANSWERED = "document.documentElement.dataset.answers > 0"


class StudioAwayTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.browser = Browser()  # first: without one, the test ends here
        cls.addClassCleanup(cls.browser.close)

    def setUp(self):
        self.browser.forget()
        self.port = tools.free_port()
        self.gateway = gateways.Gateway(f"127.0.0.1:{self.port}")
        self.addCleanup(self.gateway.stop)

    def serve(self):
        server = tools.Server(port=self.port)
        self.addCleanup(server.stop)
        return server

    def open(self, address, **size):
        page = self.browser.open(self.gateway.url + address, **size)
        self.addCleanup(page.close)
        return page

    def test_studio_opened_without_a_server_says_so_and_starts_when_it_comes(self):
        page = self.open(HUG, still=True)
        self.assertEqual(page.state()["state"], "failed")
        self.assertRegex(page.text("#status"), AWAY)
        self.serve()
        page.wait_until(IS_READY)
        page.wait_until("state.leader")
        page.evaluate("element('react').click()")
        page.wait_until(ANSWERED)
        self.assertEqual(page.state()["failed"], "false", page.text("#status"))

    def test_spar_opened_without_a_server_says_so_and_starts_when_it_comes(self):
        page = self.open("/spar", width=420, height=420)
        self.assertEqual(page.state()["state"], "failed")
        self.assertRegex(page.text("#away"), AWAY)
        self.serve()
        page.wait_until(IS_READY)
        page.wait_until("spar.seen && element('away').hidden")

    def test_call_without_a_server_is_explained(self):
        server = self.serve()
        page = self.open(HUG, still=True)
        page.wait_until("state.leader")
        server.kill()
        page.evaluate("element('react').click()")
        page.wait_until(FAILED)
        self.assertRegex(page.text("#status"), r"^The server at 127\.0\.0\.1:\d+ (is not running|closed the connection): ")
        self.serve()
        # The gateway waits for its connection, but on a busy machine not for long enough.
        tools.wait_until(lambda: self.is_answered(page), "an answer after the server's return")

    def is_answered(self, page):
        page.evaluate("element('react').click()")
        page.wait_until(f"{FAILED} || {ANSWERED}")
        return page.evaluate(ANSWERED)

    def test_gateway_that_is_away_is_named(self):
        self.serve()
        page = self.open(HUG, still=True)
        page.wait_until("state.leader")
        self.gateway.stop()
        page.evaluate("element('react').click()")
        page.wait_until(FAILED)
        self.assertEqual(page.text("#status"), f"The gateway at 127.0.0.1:{self.gateway.port} does not "
                                               "answer. Start it with contrib/studio/gateway.py.")


if __name__ == "__main__":
    tools.main()
