"""HAProxy and nginx with the configurations of deploy/proxy in front of a real server: TLS, calls, what
they refuse, and a flood of resets that the server must hear next to nothing of."""

import contextlib
import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

import reset_flood
import tools

PROXY = tools.SOURCE / "deploy/proxy"
FLOOD = 60_000
# Of a flood without a proxy every call reaches the server.
REACH_THE_SERVER = FLOOD // 100


def certificate(folder):
    """A certificate for this machine in `cert.pem`, with its key in `proxy.pem`."""
    result = tools.run("openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-days", "2",
                       "-subj", "/CN=localhost", "-addext", "subjectAltName=IP:127.0.0.1",
                       "-keyout", folder / "key.pem", "-out", folder / "cert.pem")
    assert result.returncode == 0, result.stderr
    chain = (folder / "cert.pem").read_text() + (folder / "key.pem").read_text()
    (folder / "proxy.pem").write_text(chain)


class Proxy:
    """A proxy that runs in the foreground, ended with the `with`."""

    def __init__(self, folder, port, *command, **environment):
        self.port = port
        self._folder = folder
        self._log = open(folder / "proxy.log", "w", encoding="utf-8")
        self._process = subprocess.Popen([str(word) for word in command], stdout=self._log,
                                         stderr=self._log, env={**os.environ, **environment})

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._process.terminate()
        try:
            self._process.wait(timeout=tools.STOP_SECONDS)
        finally:
            self._process.kill()
            self._log.close()

    def duet(self, *arguments):
        # A client looks for a server that is not there yet; a proxy takes a moment to begin.
        return tools.duet(*arguments, "--server", f"127.0.0.1:{self.port}",
                          "--tls-ca", self._folder / "cert.pem", "--wait", 60)

    def wait_until_it_serves(self):
        for _ in range(20):
            result = self.duet("models")
            if result.returncode == 0:
                return
            assert self._process.poll() is None, (self._folder / "proxy.log").read_text()
        raise AssertionError(f"{result.stderr}\n{(self._folder / 'proxy.log').read_text()}")


def haproxy(folder, server, metrics_port):
    port = tools.free_port()
    return Proxy(folder, port, "haproxy", "-f", PROXY / "haproxy.cfg",
                 DUET_PROXY_BIND=f"127.0.0.1:{port}",
                 DUET_PROXY_METRICS_BIND=f"127.0.0.1:{metrics_port}",
                 DUET_PROXY_CERTIFICATE=str(folder / "proxy.pem"),
                 DUET_PROXY_SERVERS=server.address,
                 DUET_PROXY_METRICS_PORT=str(server.metrics_port))


def nginx(folder, server):
    port = tools.free_port()
    text = (PROXY / "nginx.conf").read_text(encoding="utf-8")
    for old, new in (("/run/nginx", str(folder)), ("8443", f"127.0.0.1:{port}"),
                     ("server:50051", server.address), ("/etc/duet/tls", str(folder))):
        assert old in text, old
        text = text.replace(old, new)
    (folder / "nginx.conf").write_text(text, encoding="utf-8")
    return Proxy(folder, port, "nginx", "-c", folder / "nginx.conf", "-g", "daemon off;")


def calls_of(server, method):
    """How often a method was called, by the server's own figures."""
    text = server.page("/metrics")[1]
    pattern = rf'^grpc_server_started_total{{[^}}]*grpc_method="{method}"[^}}]*}} (\d+)'
    return sum(int(count) for count in re.findall(pattern, text, re.MULTILINE))


class ProxyTest(unittest.TestCase):
    def setUp(self):
        stack = contextlib.ExitStack()
        self.addCleanup(stack.close)
        self.folder = pathlib.Path(stack.enter_context(tempfile.TemporaryDirectory()))
        # nginx begins as root and works as somebody else.
        self.folder.chmod(0o755)
        certificate(self.folder)
        self.server = stack.enter_context(
            tools.running_server("--client-key", "x-duet-client", metrics="127.0.0.1:0"))
        self.stack = stack

    def check_calls(self, proxy):
        out = self.folder / "follower.npy"
        result = proxy.duet("synthesize", "--leader", tools.sample("kick"), "--label", "kick=1",
                            "--out", out)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertGreater(out.stat().st_size, 1000)
        # In the clear nothing answers, and neither does a stranger's certificate.
        address = f"127.0.0.1:{proxy.port}"
        self.assertEqual(tools.duet("models", "--server", address, "--timeout", 5).returncode, 1)
        self.assertEqual(
            tools.duet("models", "--server", address, "--tls", "--timeout", 5).returncode, 1)

    def check_flood(self, proxy):
        before = calls_of(self.server, "Synthesize")
        self.assertEqual(before, 1)  # check_calls'
        self.assertGreater(reset_flood.flood(proxy.port, True, FLOOD), 0)
        reached = calls_of(self.server, "Synthesize") - before
        self.assertLess(reached, REACH_THE_SERVER)
        self.assertEqual(tools.duet("models", "--server", self.server.address).returncode, 0)

    @unittest.skipUnless(shutil.which("haproxy"), "needs haproxy")
    def test_haproxy(self):
        proxy = self.stack.enter_context(haproxy(self.folder, self.server, tools.free_port()))
        proxy.wait_until_it_serves()
        self.check_calls(proxy)
        self.check_flood(proxy)

    @unittest.skipUnless(shutil.which("nginx"), "needs nginx")
    def test_nginx(self):
        proxy = self.stack.enter_context(nginx(self.folder, self.server))
        proxy.wait_until_it_serves()
        self.check_calls(proxy)
        self.check_flood(proxy)


if __name__ == "__main__":
    if not shutil.which("openssl"):
        tools.skip("openssl is not installed")
    if not shutil.which("haproxy") and not shutil.which("nginx"):
        tools.skip("neither haproxy nor nginx is installed")
    tools.main()
