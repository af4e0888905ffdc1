"""Several servers at once: clients that balance give each its share, and a server that is killed behind
HAProxy loses no item."""

import collections
import contextlib
import json
import pathlib
import shutil
import tempfile
import threading
import unittest

import proxies
import tools

SERVERS = 3
RECIPE = """seed: 7
reactions { each_class {} }
reactions { mixes { count: %d } }
output { formats: FORMAT_NPY }
"""


class ScaleTest(unittest.TestCase):
    def setUp(self):
        self.stack = contextlib.ExitStack()
        self.addCleanup(self.stack.close)
        self.folder = pathlib.Path(self.stack.enter_context(tempfile.TemporaryDirectory()))
        self.servers = [tools.Server(metrics="127.0.0.1:0") for _ in range(SERVERS)]
        for server in self.servers:
            self.stack.callback(server.kill)
        self.recipe = self.folder / "recipe.textproto"

    def batch(self, mixes, *words):
        self.recipe.write_text(RECIPE % mixes)
        return tools.duet("batch", tools.SOURCE / "samples", "--recipe", self.recipe,
                          "--out", self.folder / "set", "--quiet", *words)

    def items(self):
        lines = (self.folder / "set/index.jsonl").read_text().splitlines()
        return [json.loads(line)["id"] for line in lines]

    def test_round_robin_gives_each_server_its_share(self):
        addresses = ",".join(server.address for server in self.servers)
        result = self.batch(44, "--server", f"ipv4:{addresses}")
        self.assertEqual(result.returncode, 0, result.stderr)
        calls = [tools.started(server, "Synthesize") for server in self.servers]
        self.assertGreaterEqual(sum(calls), len(self.items()))
        # On a busy machine, the client may reach one server a while after the others.
        self.assertGreater(min(calls), 0.5 * sum(calls) / SERVERS, calls)

    @unittest.skipUnless(shutil.which("haproxy") and shutil.which("openssl"),
                         "needs haproxy and openssl")
    def test_killed_server_behind_the_proxy_loses_no_item(self):
        proxies.certificate(self.folder)
        text = (proxies.PROXY / "haproxy.cfg").read_text(encoding="utf-8")
        # A line for each server in place of the name that stands for all of them.
        template = next(line for line in text.splitlines() if "server-template" in line)
        lines = [template.replace("server-template duet 1-8", f"server duet{number}")
                 .replace('"${DUET_PROXY_SERVERS}"', server.address)
                 .replace('"${DUET_PROXY_METRICS_PORT}"', str(server.metrics_port))
                 for number, server in enumerate(self.servers)]
        config = self.folder / "haproxy.cfg"
        config.write_text(text.replace(template, "\n".join(lines)), encoding="utf-8")
        port = tools.free_port()
        proxy = self.stack.enter_context(proxies.Proxy(
            self.folder, port, "haproxy", "-f", config, DUET_PROXY_BIND=f"127.0.0.1:{port}",
            DUET_PROXY_METRICS_BIND=f"127.0.0.1:{tools.free_port()}",
            DUET_PROXY_CERTIFICATE=str(self.folder / "proxy.pem")))
        proxy.wait_until_it_serves()

        # One server ends without warning once it has answered some calls.
        victim = self.servers[0]
        answered = threading.Event()
        done = threading.Event()

        def kill():
            while not done.is_set():
                if sum(entry.get("event") == "call" for entry in list(victim.log)) > 20:
                    answered.set()
                    victim.kill()
                    return
                done.wait(0.01)

        killer = threading.Thread(target=kill)
        killer.start()
        result = self.batch(44, "--server", f"127.0.0.1:{port}",
                            "--tls-ca", self.folder / "cert.pem")
        done.set()
        killer.join()
        self.assertTrue(answered.is_set())
        self.assertEqual(result.returncode, 0, result.stderr)
        counts = collections.Counter(self.items())
        self.assertEqual(set(counts.values()), {1})
        self.assertGreater(len(counts), 290)


if __name__ == "__main__":
    tools.main()
