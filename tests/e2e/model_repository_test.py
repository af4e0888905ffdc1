"""duet-server over a repository of real checkpoints, told by signal and by `duet admin` what to serve:
weights that are absurd or torn, volumes as Kubernetes mounts them, a reload under load."""

import contextlib
import hashlib
import json
import os
import pathlib
import shutil
import struct
import tempfile
import threading
import unittest

import tools

CHECKPOINT = tools.SOURCE / "model" / "embedded" / "sbu" / "1"


def write_checkpoint(folder, version, change_weights=None):
    """The embedded checkpoint as another version; `change_weights` changes its bytes before they
    are hashed."""
    manifest = json.loads((CHECKPOINT / "manifest.json").read_text(encoding="utf-8"))
    weights = bytearray((CHECKPOINT / manifest["weights"]["file"]).read_bytes())
    if change_weights:
        change_weights(weights)
    manifest["version"] = version
    manifest["weights"].update(bytes=len(weights), sha256=hashlib.sha256(weights).hexdigest())
    partial = folder.parent / f".{folder.name}.partial"
    partial.mkdir(parents=True)
    (partial / manifest["weights"]["file"]).write_bytes(weights)
    (partial / "manifest.json").write_text(json.dumps(manifest), encoding="utf-8")
    partial.rename(folder)


def make_huge(weights):
    """Every weight 1e30: finite, of the right shape, and of no use."""
    header = struct.unpack("<Q", weights[:8])[0]
    values = (len(weights) - 8 - header) // 4
    weights[8 + header:] = struct.pack("<f", 1e30) * values


class ModelRepositoryTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.repository = self.folder / "models"
        self.repository.mkdir()

    def serve(self, *flags):
        server = tools.Server("--model-repository", self.repository, "--admin-listen",
                              "127.0.0.1:0", *flags)
        self.addCleanup(server.stop)
        port = next(entry for entry in server.log if entry.get("event") == "serving")["admin_port"]
        self.admin_server = f"127.0.0.1:{port}"
        return server

    def admin(self, *arguments):
        return tools.duet("admin", "--admin-server", self.admin_server, *arguments)

    def models(self):
        """"name/version state" of each, and why it failed."""
        result = self.admin("models", "--json")
        self.assertEqual(result.returncode, 0, result.stderr)
        models = json.loads(result.stdout)["models"]
        return {f"{model['name']}/{model['version']} "
                f"{model['state'].removeprefix('MODEL_STATE_').lower()}": model["error"]
                for model in models}

    def synthesize(self, server, *flags):
        return tools.duet("synthesize", "--server", server.address, "--leader",
                          tools.sample("kick"), "--label", "kick=1", "--out",
                          self.folder / f"{threading.get_ident()}.json", "--quiet", *flags)

    def test_absurd_and_truncated_weights_never_replace_good_ones(self):
        write_checkpoint(self.repository / "sbu" / "1", 1)
        server = self.serve()
        write_checkpoint(self.repository / "sbu" / "2", 2, make_huge)
        write_checkpoint(self.repository / "sbu" / "3", 3)
        weights = next((self.repository / "sbu" / "3").glob("*.safetensors"))
        os.truncate(weights, weights.stat().st_size // 2)
        result = self.admin("reload")
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertIn("refused: sbu/3, sbu/2", result.stdout)
        models = self.models()
        self.assertEqual(set(models), {"sbu/1 served", "sbu/2 failed", "sbu/3 failed"})
        self.assertIn("weights", models["sbu/2 failed"])
        self.assertRegex(models["sbu/2 failed"], "^weights: expected")
        self.assertRegex(models["sbu/3 failed"], r"weights: expected \d+ bytes, .*got \d+")
        self.assertEqual(self.synthesize(server).returncode, 0)

    def test_kubernetes_volume_is_served(self):
        def publish(generation, version):
            write_checkpoint(self.repository / f"..{generation}" / "sbu" / str(version), version)
            link = self.repository / "..data_tmp"
            link.symlink_to(f"..{generation}")
            link.rename(self.repository / "..data")

        publish("2026_01", 1)
        (self.repository / "sbu").symlink_to("..data/sbu")
        server = self.serve()
        self.assertEqual(set(self.models()), {"sbu/1 served"})
        publish("2026_02", 2)
        shutil.rmtree(self.repository / "..2026_01")
        result = self.admin("reload")
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        self.assertEqual(set(self.models()), {"sbu/2 served"})
        self.assertEqual(self.synthesize(server).returncode, 0)

    def test_labels_move_and_versions_unload(self):
        for version in (1, 2):
            write_checkpoint(self.repository / "sbu" / str(version), version)
        server = self.serve("--version-label", "sbu:stable=1")
        self.assertEqual(self.synthesize(server, "--model", "sbu:stable").returncode, 0)
        self.assertEqual(self.admin("unload", "sbu", "1").returncode, 42, "a label needs it")
        self.assertEqual(self.admin("label", "sbu", "stable", "2").returncode, 0)
        result = self.admin("unload", "sbu", "1")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(set(self.models()), {"sbu/1 unloaded", "sbu/2 served"})
        self.assertEqual(self.admin("load", "sbu", "1").returncode, 0)
        self.assertEqual(set(self.models()), {"sbu/1 served", "sbu/2 served"})

    def test_no_call_fails_while_models_are_replaced(self):
        write_checkpoint(self.repository / "sbu" / "1", 1)
        server = self.serve()
        over = threading.Event()
        failures = []
        calls = []

        def call():
            while not over.is_set():
                result = self.synthesize(server)
                calls.append(result.returncode)
                if result.returncode != 0:
                    failures.append(result.stderr)

        callers = [threading.Thread(target=call) for _ in range(2)]
        with contextlib.ExitStack() as stack:
            for caller in callers:
                caller.start()
                stack.callback(caller.join)
            stack.callback(over.set)
            for _ in range(5):
                before = len(calls)
                self.assertEqual(self.admin("load", "sbu", "1").returncode, 0)
                while len(calls) == before and not failures:
                    over.wait(0.01)
        self.assertEqual(failures, [])


if __name__ == "__main__":
    tools.main()
