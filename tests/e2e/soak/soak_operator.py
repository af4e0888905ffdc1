"""The operator of soak.py."""

import collections
import random
import secrets
import shutil
import signal
import threading
import time

from soak_server import run, write_checkpoint


class Operator:
    """Makes changes to the server, one after the other."""

    def __init__(self, server, callers, client, seed):
        self.server, self.callers, self.client = server, callers, client
        self.done, self.failed = collections.Counter(), []
        self._chance = random.Random(f"{seed} operator")
        self._over = threading.Event()
        self._thread = None

    def begin(self):
        self._over.clear()
        self._thread = threading.Thread(target=self._run)
        self._thread.start()

    def pause(self):
        self._over.set()
        self._thread.join()

    def _run(self):
        actions = (self._hang_up, self._reload, self._load_again, self._move_label,
                   self._unload_and_load, self._bad_checkpoint, self._rotate_certificate,
                   self._rotate_token)
        while not self._over.wait(self._chance.uniform(0.2, 1.0)):
            action = self._chance.choice(actions)
            name = action.__name__.strip("_").replace("_", " ")
            try:
                action()
                self.done[name] += 1
            except Exception as error:  # pylint: disable=broad-except
                self.failed.append(f"{name}: {error}")

    def _admin(self, *arguments, code=0):
        done = run(self.client, "admin", "--admin-server", f"localhost:{self.server.admin_port}",
                   "--tls-ca", self.server.authority.certificate, "--token-file",
                   self.server.folder / "ops.token", *arguments)
        if done.returncode != code:
            raise RuntimeError(f"exit code {done.returncode}: {done.stdout}{done.stderr}")

    def _await(self, what, happened):
        end = time.monotonic() + 60
        while not happened():
            if time.monotonic() > end:
                raise RuntimeError(f"expected {what} within 60 s, got none")
            time.sleep(0.1)

    def _hang_up(self):
        before = self.server.total("duet_reloads_total")
        self.server.process.send_signal(signal.SIGHUP)
        self._await("a reload", lambda: self.server.total("duet_reloads_total") > before)

    def _reload(self):
        write_checkpoint(self.server.models / "sbu" / "2", 2)
        self._admin("reload")

    def _load_again(self):
        self._admin("load", "sbu", str(self._chance.choice((1, 2))))

    def _move_label(self):
        self._admin("label", "sbu", "canary", str(self._chance.choice((1, 2))))
        self._admin("label", "sbu", "canary", "--delete")

    def _unload_and_load(self):
        self._admin("unload", "sbu", "2")
        self._admin("load", "sbu", "2")

    def _bad_checkpoint(self):
        write_checkpoint(self.server.models / "sbu" / "3", 3, spoil=True)
        self._admin("load", "sbu", "3", code=42)
        shutil.rmtree(self.server.models / "sbu" / "3")
        self._admin("reload")

    def _rotate_certificate(self):
        taken = 'duet_secrets_reloads_total{kind="tls",outcome="taken"}'
        before = self.server.metrics().get(taken, 0)
        self.server.authority.issue(self.server.folder)
        self._await("the certificate", lambda: self.server.metrics().get(taken, 0) > before)

    def _rotate_token(self):
        taken = 'duet_secrets_reloads_total{kind="access",outcome="taken"}'
        old = self.server.tokens["farm"]
        for old_farm in (old, None):
            before = self.server.metrics().get(taken, 0)
            if old_farm:
                self.server.tokens["farm"] = secrets.token_hex(32)
            else:
                # All calls with the old token end before it is removed.
                self.callers.token = self.server.tokens["farm"]
                self.callers.gate.set(False)
                self.callers.gate.set(True)
            self.server.write_access(old_farm)
            self._await("the access file", lambda: self.server.metrics().get(taken, 0) > before)
