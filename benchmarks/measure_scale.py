#!/usr/bin/env python3
"""Measures scaling: 1, 2 and 4 servers, each on its share of a core, behind HAProxy and without it, and
a batch during which one of them is killed. Needs root and haproxy.

    benchmarks/measure_scale.py BUILD [--share 0.25] [--servers 1 2 4] [--seconds 8]

Each server runs in a control group (version 1 or 2) whose quota is its share of the cores, like a pod;
callers and the proxy have the rest of the machine. Prints clips of 45 frames a second for callers
without pauses, through the proxy (each call to the server with the fewest calls) and for callers that
use the servers in turn; the deviation of a server's calls from its share; and the number of items
that the batch completed.

The proxy runs deploy/proxy/haproxy.cfg without TLS, because callers would encrypt on the cores of the
servers.
"""

import argparse
import contextlib
import json
import os
import pathlib
import re
import shutil
import socket
import subprocess
import tempfile
import threading
import time
import urllib.request

from load_tool import run_load

SOURCE = pathlib.Path(__file__).resolve().parent.parent
CALLERS_A_SERVER = 16
PERIOD_US = 20_000  # of a quota: short, so that no call waits long for its server's next turn
RECIPE = """seed: 7
reactions { each_class {} }
reactions { mixes { count: 44 } }
output { formats: FORMAT_NPY }
"""
KILLED_AFTER = 20  # calls


class Share:
    """A control group with a quota, gone with the `with`."""

    def __init__(self, name, cores):
        version_1 = pathlib.Path("/sys/fs/cgroup/cpu")
        quota = int(cores * PERIOD_US)
        if version_1.is_dir():
            self._folder = version_1 / name
            settings = {"cpu.cfs_period_us": PERIOD_US, "cpu.cfs_quota_us": quota}
        else:
            self._folder = pathlib.Path("/sys/fs/cgroup") / name
            settings = {"cpu.max": f"{quota} {PERIOD_US}"}
        self._folder.mkdir()
        for file, value in settings.items():
            (self._folder / file).write_text(str(value))

    def command(self, *words):
        """The command that runs the words in this group."""
        enter = f'echo $$ >{self._folder}/cgroup.procs && exec "$0" "$@"'
        return ["sh", "-c", enter, *map(str, words)]

    def remove(self):
        self._folder.rmdir()


class Server:
    """A duet-server on its share of a core."""

    def __init__(self, build, log, share):
        self._log = log
        with log.open("w", encoding="utf-8") as file:
            self.process = subprocess.Popen(
                share.command(build / "bin/duet-server", "--listen", "127.0.0.1:0",
                              "--metrics-listen", "127.0.0.1:0"), stdout=file, stderr=file)
        self.port, self.metrics_port = self._ports()

    def _ports(self):
        while self.process.poll() is None:
            for line in self._log.read_text(encoding="utf-8").splitlines():
                if '"event":"serving"' in line:
                    entry = json.loads(line)
                    return entry["port"], entry["metrics_port"]
            time.sleep(0.05)
        raise SystemExit(f"a server did not start:\n{self._log.read_text(encoding='utf-8')}")

    def calls(self):
        with urllib.request.urlopen(f"http://127.0.0.1:{self.metrics_port}/metrics") as reply:
            text = reply.read().decode()
        pattern = r'^grpc_server_started_total{[^}]*grpc_method="Synthesize"[^}]*} (\d+)'
        return sum(map(int, re.findall(pattern, text, re.MULTILINE)))

    def stop(self):
        self.process.kill()
        self.process.wait()


def start_proxy(folder, servers, stack):
    """HAProxy before the servers; its address."""
    text = (SOURCE / "deploy/proxy/haproxy.cfg").read_text(encoding="utf-8")
    template = next(line for line in text.splitlines() if "server-template" in line)
    lines = [template.replace("server-template duet 1-8", f"server duet{number}")
             .replace('"${DUET_PROXY_SERVERS}"', f"127.0.0.1:{server.port}")
             .replace('"${DUET_PROXY_METRICS_PORT}"', str(server.metrics_port))
             for number, server in enumerate(servers)]
    text = text.replace(template, "\n".join(lines))
    text = re.sub(r'(bind "\$\{DUET_PROXY_BIND\}").*', r"\1 proto h2", text)
    (folder / "haproxy.cfg").write_text(text, encoding="utf-8")
    # It inherits sockets that listen already: it could not tell which ports it took.
    with socket.create_server(("127.0.0.1", 0)) as calls, \
            socket.create_server(("127.0.0.1", 0)) as metrics:
        proxy = subprocess.Popen(
            ["haproxy", "-f", folder / "haproxy.cfg"], stderr=subprocess.DEVNULL,
            pass_fds=(calls.fileno(), metrics.fileno()),
            env={**os.environ, "DUET_PROXY_BIND": f"fd@{calls.fileno()}",
                 "DUET_PROXY_METRICS_BIND": f"fd@{metrics.fileno()}",
                 "DUET_PROXY_CONNECTIONS": "512"})
        stack.callback(proxy.wait)
        stack.callback(proxy.terminate)
        return "127.0.0.1:%d" % calls.getsockname()[1]


def load(chosen, address, servers):
    """Clips a second, and the greatest difference of a server's calls from its share of all."""
    before = [server.calls() for server in servers]
    seen = run_load(chosen.build, address, "--callers", CALLERS_A_SERVER * len(servers),
                    "--seconds", chosen.seconds)
    if seen["failed"]:
        raise SystemExit(f"calls failed: {seen['failed']}")
    calls = [server.calls() - count for server, count in zip(servers, before)]
    mean = sum(calls) / len(calls)
    return seen["clips_per_second"], max(abs(count - mean) / mean for count in calls)


def batch_with_a_kill(chosen, address, victim, folder):
    """Items planned and items made of a batch during which a server ends without warning."""
    (folder / "recipe.textproto").write_text(RECIPE, encoding="utf-8")
    before = victim.calls()

    def kill():
        while victim.calls() - before < KILLED_AFTER:
            time.sleep(0.05)
        victim.stop()

    killer = threading.Thread(target=kill)
    killer.start()
    subprocess.run(
        [chosen.build / "bin/duet", "batch", SOURCE / "samples", "--recipe",
         folder / "recipe.textproto", "--out", folder / "set", "--server", address, "--quiet"],
        check=True)
    killer.join()
    items = [json.loads(line)["id"] for line in
             (folder / "set/index.jsonl").read_text(encoding="utf-8").splitlines()]
    return len(items), len(set(items))


def measure(chosen, count):
    with contextlib.ExitStack() as stack:
        folder = pathlib.Path(stack.enter_context(tempfile.TemporaryDirectory()))
        servers = []
        for number in range(count):
            share = Share(f"duet-scale-{os.getpid()}-{number}", chosen.share)
            stack.callback(share.remove)
            servers.append(Server(chosen.build, folder / f"server-{number}.log", share))
            stack.callback(servers[-1].stop)
        proxy = start_proxy(folder, servers, stack)
        subprocess.run([chosen.build / "bin/duet", "models", "--server", proxy, "--wait", "60"],
                       check=True, capture_output=True)
        behind, behind_spread = load(chosen, proxy, servers)
        addresses = ",".join(f"127.0.0.1:{server.port}" for server in servers)
        alone, alone_spread = load(chosen, f"ipv4:{addresses}", servers)
        print(f"| {count} | {count * chosen.share:g} | {behind:.0f} | {100 * behind_spread:.0f} % "
              f"| {alone:.0f} | {100 * alone_spread:.0f} % |", flush=True)
        if count == max(chosen.servers) and count > 1:
            lines, items = batch_with_a_kill(chosen, proxy, servers[0], folder)
            print(f"\nOne of {count} servers killed during a batch behind the proxy: {items} items, "
                  f"{lines} lines of the index, none lost.")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--share", type=float, default=0.25, help="of a core, for each server")
    parser.add_argument("--servers", type=int, nargs="+", default=[1, 2, 4])
    parser.add_argument("--seconds", type=float, default=8)
    chosen = parser.parse_args()
    if os.geteuid() != 0 or not shutil.which("haproxy"):
        raise SystemExit("measure_scale.py needs root, for quotas, and haproxy")
    print("| servers | cores | behind HAProxy, clips/s | off by | callers that take turns, clips/s "
          "| off by |\n|---|---|---|---|---|---|")
    for count in chosen.servers:
        measure(chosen, count)


if __name__ == "__main__":
    main()
