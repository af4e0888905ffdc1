"""Long live sessions through HAProxy and nginx with the configurations of deploy/proxy: more bytes than any other
request may have, and more patience than the server."""

import re
import shutil
import unittest

import proxies
import tools
from live_clients import Session, frames_message, grpc, person, start_message

RATE = 240
FRAMES = 10 * RATE  # the most in a message
MEBIBYTES = 36  # more than any other request may have
SECONDS = {"s": 1, "m": 60, "h": 3600}


def seconds(configuration, name):
    """The values of a timeout in a proxy's configuration."""
    found = re.findall(rf"^\s*{name}\s+(\d+)([smh])\b", configuration, re.MULTILINE)
    return [int(count) * SECONDS[unit] for count, unit in found]


class LiveProxyTest(proxies.BehindProxyTest):
    def check_session(self, proxy):
        """Most of the bytes are frames that the server has already: it drops them, which costs no evaluation."""
        proxy.wait_until_it_serves()
        credentials = grpc.ssl_channel_credentials((self.folder / "cert.pem").read_bytes())
        channel = grpc.secure_channel(f"127.0.0.1:{proxy.port}", credentials)
        self.addCleanup(channel.close)
        session = Session(channel, start_message(rate=RATE))
        leader = person(tools.JOINTS, RATE, FRAMES + 1)
        frames = frames_message(0, leader[:FRAMES])
        messages = 1 + MEBIBYTES * 2**20 // frames.ByteSize()
        for _ in range(1 + messages):
            session.send(frames)
        session.wait_for(FRAMES - 1)
        session.send(frames_message(FRAMES, leader[FRAMES:]))
        session.wait_for(FRAMES)
        session.drain()
        self.assertEqual(session.summary.frame_count, FRAMES + 1)
        self.assertEqual(session.summary.late_frames, messages * FRAMES)

    def check_patience(self, configuration, *names):
        """A session that is silent is the server's to end."""
        idle = float(re.search(r"^live_idle_seconds: (\S+)", tools.run(
            tools.PROGRAMS / "duet-server", "--print-config").stdout, re.MULTILINE)[1])
        for name in names:
            found = seconds(configuration, name)
            self.assertTrue(found, name)
            self.assertGreater(min(found), 2 * idle, name)

    @unittest.skipUnless(shutil.which("haproxy"), "needs haproxy")
    def test_haproxy_carries_a_long_session(self):
        self.check_session(self.stack.enter_context(
            proxies.haproxy(self.folder, self.server, tools.free_port())))
        self.check_patience((proxies.PROXY / "haproxy.cfg").read_text(encoding="utf-8"),
                            "timeout client", "timeout server")

    @unittest.skipUnless(shutil.which("nginx"), "needs nginx")
    def test_nginx_carries_a_long_session(self):
        self.check_session(self.stack.enter_context(proxies.nginx(self.folder, self.server)))
        self.check_patience((proxies.PROXY / "nginx.conf").read_text(encoding="utf-8"),
                            "client_body_timeout", "grpc_read_timeout", "grpc_send_timeout")

    @unittest.skipUnless(shutil.which("nginx"), "needs nginx")
    def test_nginx_limits_other_requests(self):
        proxy = self.stack.enter_context(proxies.nginx(self.folder, self.server))
        proxy.wait_until_it_serves()
        credentials = grpc.ssl_channel_credentials((self.folder / "cert.pem").read_bytes())
        with grpc.secure_channel(f"127.0.0.1:{proxy.port}", credentials) as channel:
            call = channel.unary_stream("/duet.v1.MotionSynthesis/Synthesize")
            with self.assertRaises(grpc.RpcError) as caught:
                list(call(bytes(MEBIBYTES * 2**20), timeout=tools.RUN_SECONDS))
        self.assertEqual((caught.exception.code(), caught.exception.details()),
                         (grpc.StatusCode.RESOURCE_EXHAUSTED, "the request is larger than 33 MiB"))


if __name__ == "__main__":
    if not shutil.which("openssl"):
        tools.skip("openssl is not installed")
    if not shutil.which("haproxy") and not shutil.which("nginx"):
        tools.skip("neither haproxy nor nginx is installed")
    tools.main()
