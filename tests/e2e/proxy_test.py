"""HAProxy and nginx with the configurations of deploy/proxy in front of a real server: TLS, calls, what
they refuse, and a flood of resets that the server must hear next to nothing of."""

import shutil
import unittest

import proxies
import reset_flood
import tools
from proxies import haproxy, nginx

FLOOD = 60_000
# Of a flood without a proxy every call reaches the server.
REACH_THE_SERVER = FLOOD // 100


class ProxyTest(proxies.BehindProxyTest):
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
        before = tools.started(self.server, "Synthesize")
        self.assertEqual(before, 1)  # check_calls'
        self.assertGreater(reset_flood.flood(proxy.port, True, FLOOD), 0)
        reached = tools.started(self.server, "Synthesize") - before
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
