"""Live sessions through the gateway's WebSocket, against a real server: answers, errors, and
hostile browsers."""

import asyncio
import base64
import contextlib
import itertools
import json
import socket
import struct
import time

import gateways
import tools
from gateways import Gateway, ask_raw, connect, message_of

gateways.prepare()

import aiohttp  # noqa: E402
import duet_motion as duet  # noqa: E402
import numpy as np  # noqa: E402
from duet_motion.rpc.v1 import status_pb2  # noqa: E402
from duet_motion.v1 import live_pb2  # noqa: E402

HANDSHAKE = {"Host": "localhost", "Connection": "Upgrade", "Upgrade": "websocket",
             "Sec-WebSocket-Version": "13",
             "Sec-WebSocket-Key": base64.b64encode(b"0123456789abcdef").decode()}
TEXT, BINARY, CLOSE, PING = 1, 2, 8, 9
UNAVAILABLE = 14  # of gRPC


def handshake(path="/live", **changes):
    lines = {**HANDSHAKE, **{name.replace("_", "-"): value for name, value in changes.items()}}
    head = "".join(f"{name}: {value}\r\n" for name, value in lines.items() if value is not None)
    return f"GET {path} HTTP/1.1\r\n{head}\r\n".encode()


def frame(kind, data=b"", length=None, masked=True, last=True):
    """A frame of a browser, by default as one sends it. `length`: that which it claims."""
    length = len(data) if length is None else length
    head = bytes([(0x80 if last else 0) | kind])
    bit = 0x80 if masked else 0
    if length < 126:
        head += bytes([bit | length])
    elif length < 2**16:
        head += bytes([bit | 126]) + struct.pack(">H", length)
    else:
        head += bytes([bit | 127]) + struct.pack(">Q", length)
    return head + (bytes(4) if masked else b"") + data  # a mask of zeros changes nothing


def start_message(leader, **changes):
    start = live_pb2.LiveStart(**{"seed": 3, **changes})
    start.leader.joint_names.extend(leader.joint_names)
    start.leader.frame_rate_hz = leader.frame_rate_hz
    start.leader.unit = start.leader.up_axis = 1
    start.label_vector.weights.add(interaction_class="hug", weight=1)
    return live_pb2.SynthesizeLiveRequest(start=start).SerializeToString()


def frames_message(leader, first, count=1):
    return live_pb2.SynthesizeLiveRequest(frames=live_pb2.LeaderFrames(
        first_frame=first, frame_count=count, capture_seconds=first,
        positions=np.roll(leader.positions, -first, axis=0)[:count].ravel().tolist(),
    )).SerializeToString()


class LiveSocketTest(gateways.GatewayTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.leader = duet.read_motion(tools.sample("hug"))

    def session(self, talk, gateway=None):
        """Runs `talk(socket)` on a WebSocket of a browser."""
        async def run():
            async with aiohttp.ClientSession() as client:
                url = f"{(gateway or self.gateway).url}/live"
                async with client.ws_connect(url, headers={"Host": "localhost"}) as browser:
                    return await asyncio.wait_for(talk(browser), tools.RUN_SECONDS)
        return asyncio.run(run())

    @staticmethod
    async def responses(browser):
        """The messages until the status, and the status."""
        found = []
        async for message in browser:
            if message.type is aiohttp.WSMsgType.TEXT:
                return found, json.loads(message.data)
            found.append(live_pb2.SynthesizeLiveResponse.FromString(message.data))
        raise AssertionError(f"no status; closed with {browser.close_code}")

    def works(self, gateway=None):
        """A whole session; returns the follower."""
        async def talk(browser):
            reading = asyncio.ensure_future(self.responses(browser))  # which also answers pings
            await browser.send_bytes(start_message(self.leader))
            for first in range(20):
                await browser.send_bytes(frames_message(self.leader, first))
                await asyncio.sleep(0.01)
            await browser.send_bytes(b"")
            return await reading

        found, status = self.session(talk, gateway)
        self.assertEqual(status, {"code": 0, "message": "", "details": ""})
        self.assertEqual(found[0].WhichOneof("payload"), "header")
        self.assertEqual(found[-1].summary.frame_count, 20)
        parts = [message.frames for message in found if message.HasField("frames")]
        self.assertEqual([part.first_frame for part in parts],
                         np.cumsum([0, *(part.frame_count for part in parts)])[:-1].tolist())
        return np.concatenate([part.positions for part in parts])

    def closed_by(self, data, gateway=None):
        """The close code and reason that answer raw bytes behind a handshake."""
        with connect((gateway or self.gateway).port) as browser:
            browser.sendall(handshake())
            with contextlib.suppress(ConnectionError):
                browser.sendall(data)
            answer = gateways.read_all(browser)
        head, _, rest = answer.partition(b"\r\n\r\n")
        self.assertTrue(head.startswith(b"HTTP/1.1 101 "), head)
        while rest:
            kind, length = rest[0] & 15, rest[1]
            start = 4 if length == 126 else 2
            length = struct.unpack(">H", rest[2:4])[0] if length == 126 else length
            body, rest = rest[start:start + length], rest[start + length:]
            if kind == CLOSE:
                return struct.unpack(">H", body[:2])[0], body[2:].decode()
        return None, ""

    def test_session_is_answered_frame_by_frame(self):
        follower = self.works()
        self.assertEqual(len(follower), 20 * 15 * 3)
        self.assertTrue(np.isfinite(follower).all())

    def test_servers_error_arrives_with_its_details(self):
        async def talk(browser):
            await browser.send_bytes(start_message(self.leader, delay_frames=99))
            return await self.responses(browser)

        _, status = self.session(talk)
        self.assertEqual(status["code"], 3)
        self.assertIn("delay_frames", status["message"])
        details = status_pb2.Status.FromString(base64.b64decode(status["details"]))
        self.assertIn("BadRequest", " ".join(detail.type_url for detail in details.details))

    def test_requests_that_are_no_websocket_are_refused(self):
        for changes, status in (({"Origin": "http://elsewhere.test"}, 403),
                                ({"Origin": "null"}, 403), ({"Host": "elsewhere.test"}, 421),
                                ({"Upgrade": "h2c"}, 426), ({"Upgrade": None}, 426),
                                ({"Connection": "close"}, 400 if gateways.has_new_aiohttp() else 426),
                                ({"Sec_WebSocket_Key": "short"}, 400),
                                ({"Sec_WebSocket_Version": "99"}, 400),
                                ({"x_request_id": "\x01"}, 400)):
            with self.subTest(changes):
                data = handshake(**changes) + b"GET /about.json HTTP/1.1\r\nHost: localhost\r\n\r\n"
                [(found, _, body)] = ask_raw(self.gateway.port, data)
                self.assertEqual(found, status, body)
                self.assertTrue(message_of(body))
        [(found, _, body)] = ask_raw(self.gateway.port, handshake("/about.json"))
        self.assertEqual((found, message_of(body)), (400, "Upgrade: expected none, got one"))

    def test_pages_may_connect_to_their_own_host_only(self):
        for path in ("/", "/spar"):
            [(_, headers, _)] = ask_raw(
                self.gateway.port,
                f"GET {path} HTTP/1.1\r\nHost: localhost:7\r\nConnection: close\r\n\r\n".encode())
            self.assertIn("connect-src 'self' ws://localhost:7 wss://localhost:7",
                          headers["content-security-policy"])

    def test_hostile_messages_end_the_session_with_a_reason(self):
        leader = start_message(self.leader)
        for name, data, code in (
                ("text", frame(TEXT, b"hello"), 1003),
                ("a giant frame", frame(BINARY, length=2**40),
                 None if gateways.has_new_aiohttp() else 1009),  # None: ends with the next ping
                ("a frame above the limit", frame(BINARY, bytes(2**20 + 1)), 1009),
                ("a giant message in parts", b"".join(
                    frame(0 if i else BINARY, bytes(2**18), last=False) for i in range(5)), 1009),
                ("no mask", frame(BINARY, b"x", masked=False), None),
                ("reserved bits", b"\xf2\x80" + bytes(4), 1002),
                ("an unknown kind", frame(5, b"x"), 1002),
                # A session that is answered by then has ended by itself.
                ("after the end", frame(BINARY, leader) + frame(BINARY) + frame(BINARY, b"x"),
                 (1000, 1008)),
                ("a flood", frame(BINARY, b"\x12\x00") * 3000, None)):
            with self.subTest(name):
                found, reason = self.closed_by(data + frame(CLOSE))
                if code is not None:
                    self.assertIn(found, code if isinstance(code, tuple) else (code,), reason)
        self.works()

    def test_silence_ends_the_session(self):
        gateway = self.started(bounds="live_socket.SILENCE_SECONDS = 0.3")
        self.assertEqual(self.closed_by(b"", gateway),
                         (1008, "expected a message within 0.3 s, got none"))
        leader = start_message(self.leader)
        self.assertEqual(self.closed_by(frame(BINARY, leader), gateway)[0], 1008)

    def test_browser_that_does_not_answer_pings_is_gone(self):
        gateway = self.started(bounds="live_socket.PING_SECONDS = 2")
        with connect(gateway.port) as browser:
            browser.sendall(handshake())
            tools.wait_until(lambda: browser.recv(4096) == b"", "the gateway to hang up")
        self.works(gateway)

    def test_browser_that_does_not_read_is_cut_off(self):
        gateway = self.started(bounds="live_socket.SEND_SECONDS = 0.5; live_socket.PING_SECONDS = 60")
        before = gateway.peak_mebibytes()
        with socket.socket() as browser:
            browser.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
            browser.connect(("127.0.0.1", gateway.port))
            browser.settimeout(tools.RUN_SECONDS)
            end = time.monotonic() + tools.RUN_SECONDS
            browser.sendall(handshake())
            browser.sendall(frame(BINARY, start_message(self.leader, plan_frames=30)))
            with self.assertRaises(ConnectionError):
                for sent in itertools.count():
                    self.assertLess(time.monotonic(), end, "not cut off")
                    browser.sendall(frame(BINARY, frames_message(self.leader, sent)))
                    time.sleep(0.004)  # fewer than the limit of messages
        self.assertLess(gateway.peak_mebibytes() - before, 40)
        self.works(gateway)

    def test_half_open_browsers_leave_nothing_behind(self):
        gateway = self.started(bounds="live_socket.MAX_SESSIONS = 3; live_socket.PING_SECONDS = 2")
        for _ in range(3):
            with connect(gateway.port) as browser:
                browser.sendall(handshake())
                browser.sendall(frame(BINARY, start_message(self.leader)))
                browser.recv(4096)
                browser.shutdown(socket.SHUT_WR)
        tools.wait_until(lambda: self.has_room(gateway), "the half-open sessions to end")

    def has_room(self, gateway):
        """Whether the gateway accepts a session, which then works."""
        try:
            self.works(gateway)
        except aiohttp.WSServerHandshakeError:
            return False
        return True

    def test_sessions_are_counted(self):
        gateway = self.started(bounds="live_socket.MAX_SESSIONS = 2")
        with contextlib.ExitStack() as stack:
            for _ in range(2):
                browser = stack.enter_context(connect(gateway.port))
                browser.sendall(handshake())
                self.assertTrue(browser.recv(4096).startswith(b"HTTP/1.1 101 "))
            [(status, headers, body)] = ask_raw(gateway.port, handshake())
            self.assertEqual(status, 503)
            self.assertIn("retry-after", headers)
            self.assertIn("sessions: expected fewer than 2", message_of(body))
        tools.wait_until(lambda: self.has_room(gateway), "the sessions to end")

    def test_session_outlasts_the_time_limit_of_requests(self):
        gateway = self.started(bounds="serving.REQUEST_SECONDS = 0.5")

        async def talk(browser):
            await browser.send_bytes(start_message(self.leader))
            for first in range(10):
                await asyncio.sleep(0.15)
                await browser.send_bytes(frames_message(self.leader, first))
            await browser.send_bytes(b"")
            return await self.responses(browser)

        found, status = self.session(talk, gateway)
        self.assertEqual((status["code"], found[-1].summary.frame_count), (0, 10))

    def test_gateway_that_stops_says_so(self):
        gateway = Gateway(self.server.address)
        with connect(gateway.port) as browser:
            browser.sendall(handshake())
            browser.sendall(frame(BINARY, start_message(self.leader)))
            browser.recv(4096)
            self.assertEqual(gateway.stop(), 0)
            self.assertIn(struct.pack(">H", 1001), gateways.read_all(browser))

    def test_killed_server_is_reported_and_the_next_one_used(self):
        port = tools.free_port()
        server = tools.Server(port=port)
        gateway = Gateway(server.address)
        self.addCleanup(gateway.stop)

        async def talk(browser):
            await browser.send_bytes(start_message(self.leader))
            await browser.send_bytes(frames_message(self.leader, 0))
            await browser.receive()
            server.kill()
            return await self.responses(browser)

        _, status = self.session(talk, gateway)
        self.assertEqual(status["code"], UNAVAILABLE)
        self.assertRegex(status["message"], rf"^The server at {server.address} .*Start it with duet-server")
        server = tools.Server(port=port)
        self.addCleanup(server.stop)
        # The gateway's connection may still wait before it tries to connect again.
        tools.wait_until(lambda: self.opening_status(gateway) != UNAVAILABLE, "the gateway to connect")
        self.works(gateway)

    def opening_status(self, gateway):
        """The status of a session that ends after its first message."""
        async def talk(browser):
            await browser.send_bytes(start_message(self.leader))
            with contextlib.suppress(ConnectionResetError):  # it may have ended already
                await browser.send_bytes(b"")
            return await self.responses(browser)

        return self.session(talk, gateway)[1]["code"]


if __name__ == "__main__":
    tools.main()
