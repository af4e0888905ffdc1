"""The gateway of contrib/studio behind HAProxy with its configuration, haproxy.cfg, which sends the
requests of all visitors over the same connections: what one sends must never answer another."""

import base64
import contextlib
import pathlib
import shutil
import socket
import ssl
import tempfile
import unittest

import gateways
import proxies
import tools
from gateways import GRPC_WEB, Gateway, answers, framed, message_of, post, read_all
from gateway_test import AMBIGUOUS, HIDDEN, LARGEST

PASSWORD = "open sesame"
ALLOWED = {"Authorization": "Basic " + base64.b64encode(f"duet:{PASSWORD}".encode()).decode()}
LINE = f"Authorization: {ALLOWED['Authorization']}\r\n".encode()
LIVE = (b"GET /live HTTP/1.1\r\nHost: localhost\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
        b"Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: " + base64.b64encode(b"0123456789abcdef") + b"\r\n\r\n")
VICTIMS = 20


def allowed(data):
    """A request with the password of the proxy in every header."""
    return data.replace(b"HTTP/1.1\r\n", b"HTTP/1.1\r\n" + LINE)


class GatewayProxyTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        stack = contextlib.ExitStack()
        cls.addClassCleanup(stack.close)
        cls.folder = pathlib.Path(stack.enter_context(tempfile.TemporaryDirectory()))
        proxies.certificate(cls.folder)
        server = stack.enter_context(tools.running_server())
        gateway = Gateway(server.address)
        stack.callback(gateway.stop)
        cls.gateway_port = gateway.port
        cls.port = tools.free_port()
        stack.enter_context(haproxy(cls.folder, cls.port, gateway.port,
                                    DUET_WEB_REQUESTS_PER_10S="5000"))

    def connect(self):
        trust = ssl.create_default_context(cafile=self.folder / "cert.pem")
        trust.set_alpn_protocols(["http/1.1"])
        plain = socket.create_connection(("127.0.0.1", self.port), tools.RUN_SECONDS)
        return trust.wrap_socket(plain, server_hostname="127.0.0.1")

    def ask(self, data):
        """The answers to raw bytes until the proxy closes the connection; it may cut it off."""
        with self.connect() as connection:
            with contextlib.suppress(ConnectionError, ssl.SSLError):
                connection.sendall(data)
            return answers(read_all(connection))

    def victim(self):
        """The style sheet, requested over a connection that others have used."""
        [(status, headers, body)] = self.ask(allowed(
            b"GET /page.css HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n"))
        self.assertEqual((status, headers["content-type"]), (200, "text/css; charset=utf-8"))
        self.assertEqual(body, (gateways.WEB / "page" / "page.css").read_bytes())

    def test_smuggled_request_answers_no_other_visitor(self):
        ending = b"GET /nowhere HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n"
        for name, data in AMBIGUOUS.items():
            with self.subTest(name):
                for status, _, body in self.ask(allowed(data + HIDDEN + ending)):
                    self.assertIn(status, (200, 400, 404, 411, 413, 422))
                for _ in range(3):
                    self.victim()
        for _ in range(VICTIMS):
            body = b"x" * 10 + HIDDEN * 20  # more than the refusal waits for
            self.ask(allowed(post("/nowhere", body) + ending))
            self.ask(allowed(b"GET / HTTP/1.1\r\nHost: localhost\r\nContent-Length: %d\r\n\r\n"
                             % len(HIDDEN)) + HIDDEN + allowed(ending))
            self.victim()

    def test_a_call_and_a_file_pass_through(self):
        with self.connect() as connection:
            connection.sendall(post("/duet.v1.MotionSynthesis/ListModels", framed(b""),
                                    Content_Type=GRPC_WEB, **ALLOWED))
            with connection.makefile("rb") as reply:
                self.assertIn(b"grpc-status: 0\r\n", reply.read())
        [(status, _, body)] = self.ask(post("/read?name=hug.bvh", tools.sample("hug").read_bytes(),
                                            **ALLOWED))
        self.assertEqual(status, 200, body)

    def test_live_session_passes_through(self):
        with self.connect() as connection:
            connection.sendall(allowed(LIVE))
            self.assertTrue(connection.recv(4096).startswith(b"HTTP/1.1 101 "))
            connection.sendall(b"\x82\x80" + bytes(4))  # the leader ends before it starts
            found = read_all(connection)
        self.assertIn(b'{"code": 3, ', found)
        [(status, _, _)] = self.ask(LIVE)
        self.assertEqual(status, 401)
        self.victim()

    def live_status(self, stack):
        """The status of another session's handshake."""
        connection = stack.enter_context(self.connect())
        connection.sendall(allowed(LIVE))
        return int(connection.recv(4096).split(b" ")[1])

    def test_one_address_cannot_take_all_sessions(self):
        with contextlib.ExitStack() as stack:
            self.assertEqual([self.live_status(stack) for _ in range(9)], [101] * 8 + [429])
            self.victim()

        def has_room():
            with contextlib.ExitStack() as stack:
                return self.live_status(stack) == 101
        tools.wait_until(has_room, "the sessions to end")

    def test_password_is_required(self):
        for headers in ({}, {"Authorization": "Basic ZHVldDpvcGVu"}):
            [(status, _, _)] = self.ask(post("/read?name=a.bvh", b"x", **headers))
            self.assertEqual(status, 401)

    def test_name_and_length_errors_are_json(self):
        for path, headers, expected in (("/read?name=a.bvh", {"Host": "elsewhere.test"}, 421),
                                        ("/read?name=a.bvh", {"Content_Length": LARGEST + 1}, 413),
                                        ("/nowhere", {}, 404)):
            [(status, _, body)] = self.ask(post(path, **headers, **ALLOWED))
            self.assertEqual(status, expected)
            self.assertRegex(message_of(body), r"^\w+: ")

    def test_slow_visitors_do_not_block_others(self):
        with contextlib.ExitStack() as stack:
            for _ in range(40):
                slow = stack.enter_context(self.connect())
                slow.sendall(post("/read?name=a.bvh", b"x" * 100, **ALLOWED)[:-1])
            for _ in range(10):
                stack.enter_context(self.connect()).sendall(b"GET / HTTP/1.1\r\nHost: loc")
            self.victim()

    def test_flood_is_rejected_and_service_recovers(self):
        port = tools.free_port()
        with haproxy(self.folder, port, self.gateway_port, DUET_WEB_REQUESTS_PER_10S="50"):
            through, self.port = self.port, port
            try:
                with self.connect() as connection:
                    connection.sendall(allowed(
                        b"GET /page.css HTTP/1.1\r\nHost: localhost\r\n\r\n") * 199 + allowed(
                        b"GET /page.css HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n"))
                    found = answers(read_all(connection))
                refused = [message_of(body) for status, _, body in found if status == 429]
                self.assertTrue(refused)
                self.assertIn("requests: expected fewer from one address", refused[0])
            finally:
                self.port = through
        self.victim()


@contextlib.contextmanager
def haproxy(folder, port, gateway_port, **environment):
    """HAProxy in front of a gateway; yields when it listens."""
    digest = tools.run("openssl", "passwd", "-5", PASSWORD).stdout.strip()

    def listens():
        with socket.socket() as probe:
            return probe.connect_ex(("127.0.0.1", port)) == 0
    with proxies.Proxy(folder, port, "haproxy", "-f", tools.SOURCE / "contrib/studio/haproxy.cfg",
                       DUET_WEB_BIND=f"127.0.0.1:{port}", DUET_WEB_CERTIFICATE=str(folder / "proxy.pem"),
                       DUET_WEB_PASSWORD_HASH=digest, DUET_WEB_GATEWAY=f"127.0.0.1:{gateway_port}", **environment):
        tools.wait_until(listens, "haproxy to listen")
        yield


if __name__ == "__main__":
    for program in ("haproxy", "openssl"):
        if not shutil.which(program):
            tools.skip(f"{program} is not installed")
    tools.main()
