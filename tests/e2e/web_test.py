"""The page of client/web in a real browser, through the gateway, against a real server."""

import importlib.util
import json
import os
import signal
import socket
import subprocess
import sys
import unittest
import urllib.error
import urllib.request

import tools
from browser import Browser

for module, package in (("grpc", "python3-grpcio"), ("numpy", "python3-numpy")):
    if importlib.util.find_spec(module) is None:
        tools.skip(f"no Python module {module}; install the package {package}")

sys.path.insert(0, str(tools.SOURCE / "client" / "python"))
os.environ["DUET_PROGRAM"] = str(tools.PROGRAMS / "duet")

import duet_motion as duet  # noqa: E402
import numpy as np  # noqa: E402
from duet_motion.v1 import synthesis_pb2  # noqa: E402

# Drops a file on the page as a visitor would, with the text that `fetched` gives.
DROP = """(async () => {{
  const text = await (await fetch({fetched})).text();
  const transfer = new DataTransfer();
  transfer.items.add(new File([text], {name}));
  window.dispatchEvent(new DragEvent('drop', {{dataTransfer: transfer, cancelable: true}}));
}})()"""
SLIDE = """(() => {{
  const slider = document.querySelector('#labels input[name={name}]');
  slider.value = {value};
  slider.dispatchEvent(new Event('input', {{bubbles: true}}));
}})()"""
FOLLOWER = "Array.from(state.follower)"


class Gateway:
    def __init__(self, server):
        self._process = subprocess.Popen(
            [sys.executable, "-B", tools.SOURCE / "client" / "web" / "gateway.py", "--server",
             server, "--listen", "127.0.0.1:0"], stdout=subprocess.PIPE, text=True)
        self.url = self._process.stdout.readline().strip()

    def send(self, number):
        self._process.send_signal(number)

    def stop(self):
        self._process.terminate()
        self._process.wait(tools.STOP_SECONDS)
        self._process.stdout.close()


class WebTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.server = tools.Server()
        cls.addClassCleanup(cls.server.stop)
        cls.gateway = Gateway(cls.server.address)
        cls.addClassCleanup(cls.gateway.stop)
        cls.browser = Browser()
        cls.addClassCleanup(cls.browser.close)

    def open(self, **size):
        page = self.browser.open(self.gateway.url, **size)
        self.addCleanup(page.close)
        self.assertEqual(page.state()["state"], "ready", page.text("#status"))
        return page

    def open_still(self, **size):
        """The page of a visitor who wants nothing to move: it draws when something changed."""
        page = self.open(**size)
        page.call("Emulation.setEmulatedMedia",
                  features=[{"name": "prefers-reduced-motion", "value": "reduce"}])
        return page

    def drop(self, page, name="visitor's hug.bvh", fetched="/samples/hug.bvh"):
        page.evaluate(DROP.format(name=json.dumps(name), fetched=json.dumps(fetched)))

    def answers(self, page, count):
        page.wait_until(f"document.documentElement.dataset.answers === '{count}' || "
                        "document.documentElement.dataset.failed === 'true'")
        self.assertEqual(page.state()["failed"], "false", page.text("#status"))

    def test_a_dropped_file_is_answered_as_the_sliders_stand(self):
        page = self.open_still()
        self.drop(page)
        self.answers(page, 1)
        self.assertIn("91 frames at 30 Hz", page.text("#leader-name"))
        page.evaluate(SLIDE.format(name="hug", value=1))
        self.answers(page, 2)
        page.evaluate(SLIDE.format(name="push", value=0.5))
        self.answers(page, 3)
        page.evaluate("element('another').click()")
        self.answers(page, 4)
        # Sliders at rest have weight 0, which is the same as none.
        with duet.Client(self.server.address) as client:
            wanted = client.synthesize(duet.read_motion(tools.sample("hug")),
                                       {name: {"hug": 1, "push": 0.5}.get(name, 0)
                                        for name in client.get_model().model.interaction_classes},
                                       seed=1)
        np.testing.assert_allclose(np.reshape(page.evaluate(FOLLOWER), (91, 15, 3)),
                                   wanted.follower.positions, atol=1e-5)

    def test_both_are_seen(self):
        for width, height in ((1000, 700), (400, 800)):
            with self.subTest(width=width):
                page = self.open_still(width=width, height=height)
                page.evaluate("document.querySelector('#samples button').click()")
                self.answers(page, 1)
                drawn = page.state()["draws"]
                page.evaluate("theatre.player.seek(45); theatre.touch()")
                page.wait_until(f"document.documentElement.dataset.draws !== '{drawn}'")
                picture = page.picture()
                stage = {"left": 0, "right": 0.6 if width > 760 else 1, "top": 0, "bottom": 0.5}
                self.assertGreater(picture.count(tools.is_leader_orange, **stage), 300)
                self.assertGreater(picture.count(tools.is_follower_teal, **stage), 300)
                self.assertEqual(page.evaluate("getComputedStyle(element('empty')).display"), "none")

    def test_it_plays_unless_told_not_to(self):
        page = self.open(width=500, height=500)
        self.drop(page)
        page.wait_until("theatre.player && theatre.player.frame > 0")
        page.click("#play")
        self.assertEqual(page.text("#play"), "Play")

    def test_what_is_downloaded_is_what_was_seen(self):
        page = self.open_still()
        self.drop(page)
        self.answers(page, 1)
        body = page.evaluate("""(async () => {
          const kept = {};
          const fetched = window.fetch;
          window.fetch = async (...all) => {
            const response = await fetched(...all);
            kept.text = await response.clone().text();
            return response;
          };
          await download('json');
          return kept.text;
        })()""")
        self.assertEqual(page.state()["downloaded"], "reaction.json")
        pair = json.loads(body)
        np.testing.assert_allclose(np.ravel(pair["follower"]), page.evaluate(FOLLOWER), atol=1e-6)
        page.evaluate("download('bvh')")
        page.wait_until("document.documentElement.dataset.downloaded === 'reaction.zip'")

    def test_refusals_are_told_in_the_words_of_who_refuses(self):
        page = self.open_still()
        self.drop(page, name="junk.bvh", fetched="/page.css")
        page.wait_until("document.documentElement.dataset.failed === 'true'")
        self.assertRegex(page.text("#status"), r"^junk\.bvh:1: ")
        self.drop(page)
        self.answers(page, 1)
        page.evaluate("state.leader.frame_rate_hz = 1000; react()")
        page.wait_until("document.documentElement.dataset.failed === 'true'")
        self.assertRegex(page.text("#status"), "leader.frame_rate_hz: is 1000")

    def test_the_pages_messages_are_those_of_the_contract(self):
        page = self.open()
        messages = page.evaluate("MESSAGES")
        self.assertIn("SynthesizeRequest", messages)
        files = (synthesis_pb2.DESCRIPTOR, *synthesis_pb2.DESCRIPTOR.dependencies)
        kinds = {1: "double", 2: "float", 4: "uint64", 8: "bool", 9: "string", 13: "uint32",
                 14: "enum"}
        for name, fields in messages.items():
            descriptor = next(file.message_types_by_name[name] for file in files
                              if name in file.message_types_by_name)
            for field, (number, kind) in fields.items():
                wanted = descriptor.fields_by_name[field]
                of = kinds.get(wanted.type) or wanted.message_type.name
                repeated = "[]" if wanted.label == wanted.LABEL_REPEATED else ""
                self.assertEqual((number, kind), (wanted.number, of + repeated), f"{name}.{field}")

    def ask(self, path, data=None, **headers):
        request = urllib.request.Request(self.gateway.url + path, data, headers)
        try:
            with urllib.request.urlopen(request, timeout=tools.RUN_SECONDS) as response:
                return response.status, response.read(), response.headers
        except urllib.error.HTTPError as error:
            with error:
                return error.code, error.read(), error.headers

    def test_the_gateway_gives_out_its_own_files_alone(self):
        status, _, headers = self.ask("/")
        self.assertEqual(status, 200)
        self.assertIn("default-src 'self'", headers["Content-Security-Policy"])
        for path in ("/gateway.py", "/../gateway.py", "/page/../gateway.py", "/viewer/../page.cc",
                     "/%2e%2e/gateway.py", "//etc/passwd", "/samples/", "/three/nothing.js"):
            self.assertEqual(self.ask(path)[0], 404, path)

    def test_the_gateway_refuses_what_makes_no_sense(self):
        grpc_web = {"Content-Type": "application/grpc-web+proto"}
        for path, data, headers, status in (
                ("/read?name=../x.bvh", b"x", {}, 400), ("/read?name=.bvh", b"x", {}, 400),
                ("/write?format=exe", b"{}", {}, 400), ("/write?format=csv", b"{}", {}, 400),
                ("/write?format=csv", b"[1]", {}, 400), ("/nothing", b"", {}, 404),
                ("/duet.v1.MotionSynthesis/Nothing", b"", grpc_web, 404),
                ("/grpc.health.v1.Health/Check", b"", grpc_web, 404),
                ("/duet.v1.MotionSynthesis/ListModels", b"", {"Content-Type": "text/plain"}, 415),
                ("/read?name=x.bvh", b"x", {"Origin": "http://elsewhere.test"}, 403)):
            with self.subTest(path=path, headers=headers):
                self.assertEqual(self.ask(path, data, **headers)[0], status)
        status, body, _ = self.ask("/duet.v1.MotionSynthesis/ListModels", b"\0\0\0\0\5",
                                   **grpc_web)
        self.assertIn(b"grpc-status: 3\r\n", body)

    def test_the_gateway_passes_refusals_on_with_their_details(self):
        message = synthesis_pb2.GetModelRequest()
        message.model.name = "nobody"
        data = message.SerializeToString()
        _, body, _ = self.ask("/duet.v1.MotionSynthesis/GetModel",
                              b"\0" + len(data).to_bytes(4, "big") + data,
                              **{"Content-Type": "application/grpc-web+proto"})
        self.assertEqual(body[0], 0x80)
        self.assertIn(b"grpc-status: 5\r\n", body)
        self.assertIn(b"grpc-status-details-bin: ", body)

    def test_many_visitors_at_once_are_all_answered(self):
        host, _, port = self.gateway.url.removeprefix("http://").partition(":")
        self.gateway.send(signal.SIGSTOP)  # so that all of them wait to be accepted
        try:
            visitors = [socket.create_connection((host, int(port)), tools.RUN_SECONDS)
                        for _ in range(64)]
        finally:
            self.gateway.send(signal.SIGCONT)
        request = (f"POST /duet.v1.MotionSynthesis/ListModels HTTP/1.0\r\nHost: {host}:{port}\r\n"
                   "Content-Type: application/grpc-web+proto\r\nContent-Length: 5\r\n\r\n")
        for visitor in visitors:
            self.addCleanup(visitor.close)
            visitor.sendall(request.encode() + b"\0" * 5)
        for visitor in visitors:
            with visitor.makefile("rb") as answer:
                self.assertIn(b"grpc-status: 0\r\n", answer.read())


if __name__ == "__main__":
    tools.main()
