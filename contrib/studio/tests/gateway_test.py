"""The gateway of contrib/studio under hostile and faulty requests, against a real server."""

import concurrent.futures
import contextlib
import glob
import json
import os
import pathlib
import re
import signal
import socket
import sys
import tempfile
import urllib.parse

import gateways
import tools
from gateways import GRPC_WEB, Gateway, ask_raw, connect, framed, message_of, post

gateways.prepare()

from duet_motion.v1 import synthesis_pb2  # noqa: E402

# Newer versions of aiohttp accept these.
FLOODS_OF_FIELDS = () if gateways.has_new_aiohttp() else (
    (b"GET / HTTP/1.1\r\nHost: localhost\r\n" + b"X: y\r\n" * 6000 + b"\r\n", 400, "request: "),)

CALLS = "/duet.v1.MotionSynthesis"
MEBIBYTE = 2**20
LARGEST = 32 * MEBIBYTE
HEAD = b"POST /read?name=a.bvh HTTP/1.1\r\nHost: localhost\r\n"
HIDDEN = b"GET /about.json HTTP/1.1\r\nHost: localhost\r\n\r\n"
CHUNKED = HEAD + b"Transfer-Encoding: chunked\r\n"
EMPTY = b"Content-Length: 0\r\n\r\n"
GET = b"GET / HTTP/1.1\r\nHost: localhost\r\n"
# Requests that hide another request, which only some parsers see.
AMBIGUOUS = {
    "two lengths": HEAD + b"Content-Length: 0\r\nContent-Length: %d\r\n\r\n" % len(HIDDEN),
    "two equal lengths": HEAD + b"Content-Length: 0\r\nContent-Length: 0\r\n\r\n",
    "a list of lengths": HEAD + b"Content-Length: 0, 0\r\n\r\n",
    "length and coding": CHUNKED + b"Content-Length: 5\r\n\r\n0\r\n\r\n",
    "coding": CHUNKED + b"\r\n0\r\n\r\n",
    "unknown coding": HEAD + b"Transfer-Encoding: xchunked\r\n\r\n0\r\n\r\n",
    "two codings": CHUNKED + b"Transfer-Encoding: identity\r\n\r\n0\r\n\r\n",
    "folded coding": HEAD + b"Transfer-Encoding:\r\n chunked\r\n\r\n0\r\n\r\n",
    "coding with a blank": HEAD + b"Transfer-Encoding : chunked\r\nContent-Length: 0\r\n\r\n",
    "coding with a tab": HEAD + b"Transfer-Encoding: \x0bchunked\r\nContent-Length: 0\r\n\r\n",
    "coding behind a bare CR": HEAD + b"X: y\rTransfer-Encoding: chunked\r\n" + EMPTY,
    "coding behind a bare LF": HEAD + b"X: y\nTransfer-Encoding: chunked\r\n" + EMPTY,
    "negative chunk": CHUNKED + b"\r\n-3\r\nabc\r\n0\r\n\r\n",
    "length with a sign": HEAD + b"Content-Length: +0\r\n\r\n",
    "length with a line": HEAD + b"Content-Length: 0_0\r\n\r\n",
    "negative length": HEAD + b"Content-Length: -1\r\n\r\n",
    "no length": HEAD + b"\r\n",
    "a name with a blank": HEAD + b"X y: z\r\nContent-Length: 0\r\n\r\n",
    "body of a GET": GET + b"Content-Length: %d\r\n\r\n" % len(HIDDEN),
    "coding of a GET": GET + b"Transfer-Encoding: chunked\r\n\r\n",
    "upgrade": GET + b"Connection: Upgrade\r\nUpgrade: h2c\r\n\r\n",
    "another place": b"GET http://elsewhere.test/ HTTP/1.1\r\nHost: localhost\r\n\r\n",
    "no place": b"GET http://[ HTTP/1.1\r\nHost: localhost\r\n\r\n",
    "two hosts": GET + b"Host: elsewhere.test\r\n\r\n",
    "no host": b"GET / HTTP/1.1\r\n\r\n",
}


class GatewayTest(gateways.GatewayTest):
    def ask(self, path, body=b"", gateway=None, **headers):
        """Status, headers and body of the only answer to a POST."""
        [answer] = ask_raw((gateway or self.gateway).port, post(path, body, **headers))
        return answer

    def get(self, path, gateway=None, host="localhost"):
        request = f"GET {path} HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n\r\n"
        [answer] = ask_raw((gateway or self.gateway).port, request.encode())
        return answer

    def read(self, gateway=None, query=""):
        status, _, body = self.ask("/read?name=hug.bvh" + query, tools.sample("hug").read_bytes(), gateway)
        self.assertEqual(status, 200, body)
        return json.loads(body)["motion"]

    def test_only_the_pages_files_are_served(self):
        status, headers, _ = self.get("/")
        self.assertEqual(status, 200)
        self.assertIn("default-src 'self'", headers["content-security-policy"])
        for path in ("/gateway.py", "/../gateway.py", "/page/../gateway.py", "/%2e%2e/gateway.py",
                     "//etc/passwd", "/samples/", "/page/", "/samples/keyframes/hug.txt"):
            self.assertEqual(self.get(path)[0], 404, path)

    def test_ambiguous_requests_close_the_connection(self):
        for name, data in AMBIGUOUS.items():
            with self.subTest(name):
                [(status, _, body)] = ask_raw(self.gateway.port, data + HIDDEN)
                self.assertIn(status, (400, 411, 413))
                self.assertRegex(message_of(body), r"^[\w-]+: ")

    def test_unused_body_is_not_parsed_as_a_request(self):
        for head, expected in ((b"POST /nowhere", 404), (b"POST /", 405), (b"PUT /read", 400),
                               (b"POST /write?format=exe", 400)):
            with self.subTest(head=head):
                found = ask_raw(self.gateway.port, head + b" HTTP/1.1\r\nHost: localhost\r\n"
                                b"Content-Length: %d\r\n\r\n" % len(HIDDEN) + HIDDEN + post("/"))
                self.assertEqual(found[0][0], expected)
                self.assertNotIn(b"samples", b"".join(body for _, _, body in found))

    def test_errors_are_json_with_the_field(self):
        call = f"{CALLS}/ListModels"
        deep = b"[" * MEBIBYTE
        for data, status, words in (
                (post("/nothing"), 404, 'path: expected one of the gateway\'s, got "/nothing"'),
                (post(f"{CALLS}/Nothing", Content_Type=GRPC_WEB), 404, "path: "),
                (post("/grpc.health.v1.Health/Check", Content_Type=GRPC_WEB), 404, "path: "),
                (post("/about.json"), 405, "method: expected GET, got POST"),
                (post(call, Content_Type="text/plain"), 415, "Content-Type: expected "),
                (post(call, Content_Type=GRPC_WEB, x_request_id="\xff"), 400, "x-request-id: "),
                (post("/read"), 400, "name: expected "),
                (post("/read?name=../x.bvh"), 400, "name: expected "),
                (post("/read?name=.bvh"), 400, "name: expected "),
                (post("/read?name=-x.bvh"), 400, "name: expected "),
                (post(f"/read?name={'x' * 5000}.bvh"), 400, "name: expected "),
                (post(f"/read?name={'x' * 9000}.bvh"), 431, "header: expected "),
                (post("/read?name=x.bvh&out=y"), 400, "settings: expected "),
                (post("/read?name=x.bvh&unit=miles", b"x"), 422, "--unit"),
                (post("/read?name=x.bvh&skeleton=head", b"x"), 400, "skeleton: expected "),
                (post("/read?name=x.bvh&skeleton=a:,b:9", b"x"), 422,
                 "skeleton of the model: bones[0]: expected "),
                (post("/write?format=csv&skeleton=sbu", b"{}"), 400, "skeleton: expected own"),
                (post("/write?format=exe"), 400, "format: expected "),
                (post("/write?format=glb&name=../x"), 400, "name: expected "),
                (post("/write?format=csv", b"[1]"), 422, "pair.json"),
                (post("/write?format=csv", deep), 422, "pair.json"),
                (post(call, Content_Type=GRPC_WEB, grpc_timeout="10"), 400,
                 'grpc-timeout: expected at most 8 digits and one of H, M, S, m, u and n, got "10"'),
                (post(call, Content_Type=GRPC_WEB, grpc_timeout="-1S"), 400, "grpc-timeout: "),
                (post("/write_on_rig", b"{}"), 400, "name: expected "),
                (post("/write_on_rig?name=x&rig=a/b.bvh", b"{}"), 400, "name: expected "),
                (post("/write_on_rig?name=x&rig=a.bvh&format=bvh", b"junk"), 422, "pair.json"),
                (post("/read?name=x.bvh", Content_Length=LARGEST + 1), 413, "body: expected "),
                (post("/read?name=x.bvh", Content_Length="9" * 6000), 400, "request: "),
                (post("/read?name=x.bvh", Content_Length="0" * 6000 + "9" * 15), 413, "body: "),
                (post("/read?name=x.bvh", Expect="a miracle"), 417, "Expect: expected "),
                (post("/read?name=x.bvh", Origin="http://elsewhere.test"), 403, "Origin: "),
                (post("/read?name=x.bvh", Origin="null"), 403, "Origin: "),
                (post("/read?name=x.bvh", Host="elsewhere.test"), 421, "Host: expected "),
                (b"\x16\x03\x01\x02\x00\x01\x00\r\n\r\n", 400, "request: "),
                (b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n", 400, "request: "),
                *FLOODS_OF_FIELDS):
            with self.subTest(data=data[:80]):
                [(found, _, body)] = ask_raw(self.gateway.port, data)
                self.assertEqual(found, status, body[:200])
                self.assertTrue(message_of(body).startswith(words), body[:200])

    def test_hints_name_settings_of_the_page_and_no_flags(self):
        crab = tools.sample("kick").read_bytes().replace(b"_hand", b"_claw")
        for name, body, hint in (("crab.bvh", crab, '\nSpecify it under "How the file is read".'),
                                 ("crab.py", crab, "")):
            status, _, reply = self.ask(f"/read?name={name}", body)
            self.assertEqual(status, 422)
            self.assertTrue(message_of(reply).endswith(f"(INVALID_ARGUMENT){hint}"),
                            message_of(reply))

    def test_empty_message_to_each_path_is_answered(self):
        for path in ("/", "/about.json", "/read", "/read?name=a.bvh", "/write", "/write?format=glb",
                     "/write_on_rig"):
            with self.subTest(path):
                status, _, body = self.ask(path)
                self.assertIn(status, (400, 405, 422))
                self.assertTrue(message_of(body))
        for method in ("Synthesize", "ListModels", "GetModel"):
            for body in (b"", b"\0" * 4, framed(b""), framed(b"\xff"), b"\1" + framed(b"")[1:]):
                with self.subTest(method=method, body=body):
                    found = ask_raw(self.gateway.port, post(
                        f"{CALLS}/{method}", body, Content_Type=GRPC_WEB))
                    self.assertEqual(len(found), 1)
                    self.assertEqual(found[0][0], 200)
        self.assertGreater(len(self.read()["leader"]), 0)

    def test_server_errors_keep_their_details(self):
        message = synthesis_pb2.GetModelRequest()
        message.model.name = "nobody"
        body = self.call("GetModel", message.SerializeToString())
        self.assertEqual(body[0], 0x80)
        self.assertIn(b"grpc-status: 5\r\n", body)
        self.assertIn(b"grpc-status-details-bin: ", body)

    def call(self, method, message, gateway=None):
        """The complete answer to a call."""
        return self.ask(f"{CALLS}/{method}", framed(message), gateway, Content_Type=GRPC_WEB)[2]

    def test_unknown_hosts_and_origins_are_rejected(self):
        for host in ("elsewhere.test", "localhost.elsewhere.test", "127.0.0.1.nip.test", "[::2]",
                     "169.254.169.254", ""):
            self.assertEqual(self.get("/", host=host)[0], 421, host)
        for host in ("localhost", f"127.0.0.1:{self.gateway.port}", "LOCALHOST:1", "[::1]:8080"):
            self.assertEqual(self.get("/", host=host)[0], 200, host)
        studio = self.started("--host", "studio.example")
        self.assertEqual(self.get("/", studio, "studio.example")[0], 200)
        self.assertEqual(self.get("/", studio, "other.example")[0], 421)
        for origin, expected in (("https://studio.example", 422), ("http://studio.example", 422),
                                 ("https://studio.example.test", 403), ("http://localhost", 403)):
            self.assertEqual(self.ask("/read?name=x.bvh", b"x", studio, Host="studio.example",
                                      Origin=origin)[0], expected, origin)

    def test_slow_bodies_do_not_block_others(self):
        with contextlib.ExitStack() as stack:
            for path in ("/read?name=a.bvh", "/write?format=glb", "/write_on_rig?name=a&rig=a.bvh&format=glb",
                         f"{CALLS}/Synthesize") * 10:
                slow = stack.enter_context(connect(self.gateway.port))
                slow.sendall(post(path, b"x" * 1000, Content_Type=GRPC_WEB)[:-1])
            self.read()
            self.assertIn(b"grpc-status: 0\r\n", self.call("ListModels", b""))

    def test_large_bodies_take_little_memory(self):
        before = self.gateway.peak_mebibytes()
        for path in ("/read?name=a.csv", "/write?format=glb", f"{CALLS}/Synthesize"):
            with self.subTest(path), contextlib.ExitStack() as stack:
                request = post(path, framed(b"\0" * (LARGEST - 5)), Content_Type=GRPC_WEB)
                slow = []
                for _ in range(20):
                    slow.append(stack.enter_context(connect(self.gateway.port)))
                    slow[-1].sendall(request[:-1])
                self.read()
                for connection in slow:
                    connection.sendall(request[-1:])
                for connection in slow:
                    with connection.makefile("rb") as reply:
                        self.assertIn(reply.readline().split(b" ")[1], (b"200", b"422", b"503"))
                self.assertLess(self.gateway.peak_mebibytes() - before, 250)

    def test_bodies_on_disk_are_bounded_and_removed(self):
        with tempfile.TemporaryDirectory() as folder:
            gateway = self.started(bounds=f"import tempfile; tempfile.tempdir = {folder!r}\n"
                                          "uploads.MAX_SPOOLED_BYTES = 3 * 2**20")
            request = post("/read?name=a.csv", b"0" * (2 * MEBIBYTE))
            with connect(gateway.port) as slow:
                slow.sendall(request[:-1])
                tools.wait_until(lambda: sum(
                    os.path.getsize(file) for file in glob.glob(f"{folder}/*/*")) >= MEBIBYTE,
                    "the slow body on disk")
                status, headers, body = self.ask("/read?name=b.csv", b"0" * (3 * MEBIBYTE), gateway)
                self.assertEqual(status, 503)
                self.assertIn("retry-after", headers)
                self.assertRegex(message_of(body), "^body: ")
            tools.wait_until(lambda: not os.listdir(folder), "an abandoned body to be removed")
            self.read(gateway)
            self.assertEqual(os.listdir(folder), [])

    def test_slow_requests_time_out(self):
        gateway = self.started(bounds="serving.HEADER_SECONDS = 1; uploads.BODY_SECONDS = 1; "
                                      "serving.IDLE_SECONDS = 1")
        for data in (b"", b"GET / HTT", b"GET / HTTP/1.1\r\nHost: localhost\r\nX: y"):
            with self.subTest(data=data):
                self.assertEqual(ask_raw(gateway.port, data), [])
        [(status, headers, body)] = ask_raw(gateway.port, post("/read?name=a.bvh", b"xyz")[:-1])
        self.assertEqual((status, headers["connection"]), (408, "close"))
        self.assertIn("body: expected all of it within 1 s, got 2 bytes", message_of(body))
        # An idle connection is closed too, even with half a header.
        for rest in (b"", b"GET / HTT"):
            [(status, _, _)] = ask_raw(
                gateway.port, b"GET /page.css HTTP/1.1\r\nHost: localhost\r\n\r\n" + rest)
            self.assertEqual(status, 200)

    def test_stalled_reader_is_disconnected(self):
        gateway = self.started(bounds="serving.REQUEST_SECONDS = 0.5")
        with socket.socket() as reader:
            reader.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
            reader.connect(("127.0.0.1", gateway.port))
            for _ in range(20):
                reader.sendall(b"GET /duet-motion.js HTTP/1.1\r\nHost: localhost\r\n\r\n")
            tools.wait_until(lambda: not sockets_with(gateway.pid, reader.getsockname()[1]),
                             "the connection of a reader that stands still to be cut off")
        self.assertEqual(self.get("/", gateway)[0], 200)

    def test_program_is_limited_in_time_and_memory(self):
        bounds = ["conversions.PROGRAM_SECONDS = 0"]
        if not tools.SANITIZED:  # a program with AddressSanitizer does not even start
            bounds.append("conversions.PROGRAM_BYTES = 2**16")
        for bound in bounds:
            with self.subTest(bound):
                gateway = self.started(bounds=bound)
                status, _, body = self.ask("/read?name=hug.bvh", tools.sample("hug").read_bytes(),
                                           gateway)
                self.assertEqual(status, 422)
                self.assertRegex(message_of(body), "^file: expected one that ")

    def test_files_are_converted_like_the_programs(self):
        motion = self.read()
        pair = json.dumps({**motion, "follower": motion["leader"]}).encode()
        for kind in ("glb", "csv", "json", "html"):
            name = "hug_sbu@3_hug1_seed3"
            status, headers, body = self.ask(f"/write?format={kind}&name={name}", pair)
            self.assertEqual(status, 200, body)
            self.assertEqual(headers["content-disposition"],
                             f'attachment; filename="{name}.{kind}"')
        status, headers, body = self.ask("/write?format=bvh&name=x", pair)
        self.assertEqual((status, body[:2]), (200, b"PK"))
        _, _, body = self.ask("/write?format=json&name=x&resample=60", pair)
        self.assertEqual(json.loads(body)["frame_rate_hz"], 60)
        self.assertEqual(len(json.loads(body)["leader"]), 2 * len(motion["leader"]) - 1)

    def test_files_are_read_and_written_in_other_joints(self):
        arm = "left_hand:1,left_elbow:2,left_shoulder:"
        motion = self.read(query=f"&skeleton={arm}&metres_per_unit=0.01")
        self.assertEqual(motion["joint_names"], ["left_hand", "left_elbow", "left_shoulder"])
        self.assertEqual(motion["bones"], [[1, 0], [2, 1]])
        pair = json.dumps({**motion, "follower": motion["leader"]}).encode()
        status, _, body = self.ask("/write?format=json&name=x&skeleton=own&resample=60", pair)
        self.assertEqual(status, 200, body)
        self.assertEqual(json.loads(body)["joint_names"], motion["joint_names"])
        for kind in ("glb", "html"):
            status, _, body = self.ask(f"/write?format={kind}&name=x&skeleton=own", pair)
            self.assertEqual(status, 200, body)
        status, _, body = self.ask("/write?format=json&name=x", pair)
        self.assertEqual(status, 422)
        self.assertIn("head", message_of(body))

    def write_on_rig(self, pair, rig, **settings):
        """The answer to /write_on_rig for a pair and a rig's file, (name, bytes)."""
        query = {"name": "hug_seed1", "format": "bvh", "rig": rig[0], **settings}
        return self.ask(f"/write_on_rig?{urllib.parse.urlencode(query, doseq=True)}", pair + b"\n" + rig[1])

    def test_follower_is_written_on_a_rig(self):
        leader = tools.sample("hug").read_bytes()
        pair = self.pair()
        status, headers, body = self.write_on_rig(pair, ("hug.bvh", leader), side="left")
        self.assertEqual(status, 200, body)
        self.assertEqual(headers["content-disposition"],
                         'attachment; filename="hug_seed1.follower.bvh"')
        self.assertEqual(joints_of(body), joints_of(leader))
        # The motion is that of the pair: its follower is the leader 1 m away.
        offset = [float(value) for value in last_frame(body)[:3]]
        expected = [float(value) for value in last_frame(leader)[:3]]
        self.assertAlmostEqual(offset[0] - expected[0], 100, delta=0.5)  # centimetres
        strange = leader.replace(b"JOINT left_hand", b"JOINT Flipper")
        status, _, body = self.write_on_rig(pair, ("rig.bvh", strange))
        self.assertEqual(status, 422)
        self.assertIn("left_hand", message_of(body))
        status, _, body = self.write_on_rig(pair, ("rig.bvh", strange),
                                            joint_map=["left_hand=Flipper"])
        self.assertEqual((status, b"Flipper" in body), (200, True), body[:200])

    def test_invalid_requests_for_a_rig_are_rejected(self):
        leader = ("hug.bvh", tools.sample("hug").read_bytes())
        pair = self.pair()
        for settings, status, words in (({"follower_start": "/etc/passwd"}, 400, "settings: expected "),
                                        ({"joint_map": ["a\nb"]}, 400, "joint_map: expected "),
                                        ({"side": "up"}, 422, "--rig-side"),
                                        ({"format": "csv"}, 422, "--out: expected the format of --rig")):
            with self.subTest(settings=settings):
                found, _, body = self.write_on_rig(pair, leader, **settings)
                self.assertEqual(found, status, body)
                self.assertIn(words, message_of(body))
        for first, second, words in ((pair, ("rig.bvh", b"junk"), "rig.bvh"), (b"{}", leader, "pair.json")):
            status, _, body = self.write_on_rig(first, second)
            self.assertEqual(status, 422, body[:100])
            self.assertIn(words, message_of(body))
        status, _, body = self.write_on_rig(pair, ("../rig.bvh", b""))
        self.assertEqual((status, message_of(body)[:5]), (400, "name:"))

    def pair(self):
        """A pair in "duet-motion" JSON: the sample hug, and the same 1 m further along x."""
        status, _, body = self.ask("/read?name=hug.bvh", tools.sample("hug").read_bytes())
        self.assertEqual(status, 200, body)
        motion = json.loads(body)["motion"]
        motion["follower"] = [[[x + 1, y, z] for x, y, z in pose] for pose in motion["leader"]]
        return json.dumps(motion).encode()

    def test_messages_do_not_reveal_paths(self):
        for path, body in (("/read?name=junk.bvh", b"junk"), ("/write?format=glb", b"{}"),
                           ("/write?format=html", b"{}"),
                           ("/write_on_rig?name=x&rig=b.bvh&format=bvh", b"x\ny")):
            status, _, body = self.ask(path, body)
            self.assertEqual(status, 422)
            self.assertNotIn(tempfile.gettempdir(), message_of(body))
            self.assertNotIn("duet-gateway", message_of(body))

    def test_killed_server_ends_calls_with_a_status(self):
        port = tools.free_port()
        server = tools.Server(port=port)
        gateway = Gateway(server.address)
        self.addCleanup(gateway.stop)
        try:
            with connect(gateway.port) as connection:
                connection.sendall(post(f"{CALLS}/Synthesize", framed(long_request()),
                                        Content_Type=GRPC_WEB))
                received = connection.recv(1000)
                while len(received) < 1000:  # some frames of the follower
                    received += connection.recv(1000)
                server.kill()
                self.assertRegex(gateways.read_all(connection), rb"grpc-status: 14\r\n")
            self.assertEqual(self.get("/", gateway)[0], 200)
            self.assertIn(b"grpc-status: 14\r\n", self.call("ListModels", b"", gateway))
        finally:
            server.stop()

    def test_call_waits_for_the_connection_to_a_server_that_is_back(self):
        port = tools.free_port()
        gateway = Gateway(f"127.0.0.1:{port}", bounds=f"grpc_web.RECONNECT_SECONDS = {tools.RUN_SECONDS}")
        self.addCleanup(gateway.stop)
        self.assertIn(b"grpc-status: 14\r\n", self.call("ListModels", b"", gateway))
        with concurrent.futures.ThreadPoolExecutor() as callers:
            answer = callers.submit(self.call, "ListModels", b"", gateway)
            self.addCleanup(tools.Server(port=port).stop)
            self.assertIn(b"grpc-status: 0\r\n", answer.result())

    def test_many_visitors_at_once_are_all_answered(self):
        self.gateway.send(signal.SIGSTOP)  # so that all of them wait to be accepted
        try:
            visitors = [connect(self.gateway.port) for _ in range(64)]
        finally:
            self.gateway.send(signal.SIGCONT)
        for visitor in visitors:
            self.addCleanup(visitor.close)
            visitor.sendall(post(f"{CALLS}/ListModels", framed(b""), Content_Type=GRPC_WEB))
        for visitor in visitors:
            with visitor.makefile("rb") as answer:
                self.assertIn(b"grpc-status: 0\r\n", answer.read())

    def test_stops_at_a_signal_and_reports_invalid_options(self):
        gateway = Gateway(self.server.address)
        with connect(gateway.port) as idle:
            self.assertEqual(gateway.stop(), 0)
            self.assertEqual(idle.recv(1), b"")
        result = tools.run(sys.executable, "-B", gateways.WEB / "gateway.py", "--listen", "nowhere",
                           env={**os.environ, "DUET_PROGRAM": str(tools.PROGRAMS / "duet")})
        self.assertEqual(result.returncode, 1)
        self.assertIn("--listen: expected HOST:PORT", result.stderr)
        result = tools.run(sys.executable, "-B", gateways.WEB / "gateway.py",
                           env={**os.environ, "DUET_PROGRAM": "/nowhere/duet"})
        self.assertEqual(result.returncode, 1)
        self.assertIn("DUET_PROGRAM: expected the program duet", result.stderr)


def last_frame(bvh):
    return bvh.split(b"\n")[-2 if bvh.endswith(b"\n") else -1].split()


def joints_of(bvh):
    """The names of a BVH's joints."""
    return re.findall(rb"(?:ROOT|JOINT) (\S+)", bvh)


def sockets_with(pid, peer_port):
    """A process' connections from a port of this machine."""
    own = {os.readlink(link) for link in glob.glob(f"/proc/{pid}/fd/*") if os.path.islink(link)}
    lines = pathlib.Path("/proc/net/tcp").read_text(encoding="ascii").splitlines()[1:]
    return [line for line in lines if int(line.split()[2].split(":")[1], 16) == peer_port
            and f"socket:[{line.split()[9]}]" in own]


def long_request():
    """Ten minutes of a standing leader, as bytes."""
    import duet_motion as duet
    motion = duet.read_motion(tools.sample("hug"))
    request = synthesis_pb2.SynthesizeRequest(chunk_frames=1)
    request.leader.joint_names.extend(motion.joint_names)
    request.leader.frame_rate_hz = 30
    request.leader.unit = 1
    request.leader.up_axis = 1
    request.leader.frame_count = 18000
    request.leader.positions.extend(list(motion.positions[0].ravel()) * 18000)
    request.label_vector.weights.add(interaction_class="hug", weight=1)
    return request.SerializeToString()


if __name__ == "__main__":
    tools.main()
