"""deploy/kubernetes on a real API server, as far as Debian 12's sources have one: Kubernetes 1.20
(deploy/kubernetes/make_api_server.sh builds it). Needs kube-apiserver, in the PATH or where
$DUET_KUBE_APISERVER points, etcd and kubectl.

Each object is created, and what the server kept is compared with what was sent: a field that it did not
know would be missing. What came after 1.20 is taken back first, by name: that part published schemas check
(kubernetes_test.py)."""

import contextlib
import copy
import json
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

import tools

try:
    import yaml
except ImportError:
    tools.skip("python3-yaml is not installed")

KUBERNETES = tools.SOURCE / "deploy/kubernetes"
FOLDERS = ("overlays/small", "overlays/production", "overlays/keda", "overlays/canary", "batch",
           "batch/merge")
API_SERVER = os.environ.get("DUET_KUBE_APISERVER") or shutil.which("kube-apiserver")
# Kinds of others, which an API server has once their projects are installed.
FOREIGN = ("ScaledObject", "ServiceMonitor")
OLD_VERSIONS = {("PodDisruptionBudget", "policy/v1"): "policy/v1beta1",
                ("HorizontalPodAutoscaler", "autoscaling/v2"): "autoscaling/v2beta2"}
# Fields of a Job that came, or came into force, after 1.20.
LATER_JOB_FIELDS = ("backoffLimitPerIndex", "completionMode", "maxFailedIndexes",
                    "podFailurePolicy", "podReplacementPolicy", "ttlSecondsAfterFinished")


def objects_of(folder):
    result = tools.run("kubectl", "kustomize", KUBERNETES / folder)
    assert result.returncode == 0, f"{folder}: {result.stderr}"
    return list(yaml.safe_load_all(result.stdout))


def pod_spec(one):
    return one["spec"]["template"]["spec"] if one["kind"] in ("Deployment", "Job") else {}


def as_of_1_20(one):
    """The object without what came later."""
    one = copy.deepcopy(one)
    one["apiVersion"] = OLD_VERSIONS.get((one["kind"], one["apiVersion"]), one["apiVersion"])
    for container in pod_spec(one).get("containers", []):
        stop = container.get("lifecycle", {}).get("preStop", {})
        if "sleep" in stop:
            container["lifecycle"]["preStop"] = {
                "exec": {"command": ["sleep", str(stop["sleep"]["seconds"])]}}
    if one["kind"] == "PodDisruptionBudget":
        one["spec"].pop("unhealthyPodEvictionPolicy", None)
    if one["kind"] == "Job":
        for field in LATER_JOB_FIELDS:
            one["spec"].pop(field, None)
    return one


def missing_of(sent, kept, path=""):
    """The paths of what was sent and was not kept; text, quantities for instance, may be written otherwise,
    and an empty list as none."""
    if isinstance(sent, dict):
        if not isinstance(kept, dict):
            return [path]
        return [wrong for key, value in sent.items()
                for wrong in missing_of(value, kept.get(key), f"{path}.{key}")]
    if sent == [] and kept is None:
        return []
    if isinstance(sent, list):
        if not isinstance(kept, list) or len(sent) != len(kept):
            return [path]
        return [wrong for i, value in enumerate(sent)
                for wrong in missing_of(value, kept[i], f"{path}[{i}]")]
    return [] if kept is not None and (kept == sent or isinstance(sent, str)) else [path]


class ApiServer:
    """etcd and an API server on the loopback, in a folder of their own."""

    def __init__(self, folder, stack):
        clients, peers, port = tools.free_ports(3)
        self._log = stack.enter_context(open(folder / "log", "w", encoding="utf-8"))
        self._stack = stack
        self._start("etcd", "--data-dir", folder / "etcd",
                    "--listen-client-urls", f"http://127.0.0.1:{clients}",
                    "--advertise-client-urls", f"http://127.0.0.1:{clients}",
                    "--listen-peer-urls", f"http://127.0.0.1:{peers}")
        key = folder / "accounts.key"
        tools.run("openssl", "genrsa", "-out", key, "2048").check_returncode()
        (folder / "tokens.csv").write_text("secret,tester,1,system:masters\n")
        server = self._start(
            API_SERVER, "--etcd-servers", f"http://127.0.0.1:{clients}",
            "--bind-address", "127.0.0.1", "--secure-port", port, "--cert-dir", folder / "tls",
            "--service-cluster-ip-range", "10.0.0.0/24", "--token-auth-file", folder / "tokens.csv",
            "--service-account-issuer", "test", "--service-account-key-file", key,
            "--service-account-signing-key-file", key, "--authorization-mode", "RBAC")
        self._flags = ["--server", f"https://127.0.0.1:{port}", "--insecure-skip-tls-verify",
                       "--token", "secret"]

        def ready():
            assert server.poll() is None, (folder / "log").read_text()[-3000:]
            return self.kubectl("get", "--raw", "/readyz").returncode == 0
        tools.wait_until(ready, "the API server")

    def _start(self, *command):
        process = subprocess.Popen([str(word) for word in command], stdout=self._log,
                                   stderr=self._log)
        self._stack.callback(process.wait, timeout=tools.STOP_SECONDS)
        self._stack.callback(process.kill)
        return process

    def kubectl(self, *words, **options):
        return tools.run("kubectl", *self._flags, *words, **options)

    def create(self, namespace, one):
        """The object as the server keeps it, or what it has against it."""
        result = self.kubectl("--namespace", namespace, "create", "--validate=false", "--output",
                              "json", "--filename", "-", input=json.dumps(one))
        return json.loads(result.stdout) if result.returncode == 0 else result.stderr


class ApiServerTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        stack = contextlib.ExitStack()
        cls.addClassCleanup(stack.close)
        folder = pathlib.Path(stack.enter_context(tempfile.TemporaryDirectory()))
        cls.server = ApiServer(folder, stack)

    def test_every_object_is_accepted_without_loss(self):
        for number, folder in enumerate(FOLDERS):
            namespace = f"try-{number}"
            self.server.kubectl("create", "namespace", namespace).check_returncode()
            for one in objects_of(folder):
                if one["kind"] in FOREIGN:
                    continue
                one = as_of_1_20(one)
                one["metadata"].pop("namespace", None)
                with self.subTest(folder=folder, kind=one["kind"], name=one["metadata"]["name"]):
                    kept = self.server.create(namespace, one)
                    self.assertIsInstance(kept, dict, kept)
                    self.assertEqual(missing_of(one, kept), [])

    def test_server_update_changes_only_mutable_fields(self):
        """`kubectl apply` again with another image: selectors, which may not change, do not."""
        self.server.kubectl("create", "namespace", "again").check_returncode()
        deployment = next(one for one in map(as_of_1_20, objects_of("overlays/production"))
                          if one["kind"] == "Deployment")
        deployment["metadata"].pop("namespace", None)
        self.assertIsInstance(self.server.create("again", deployment), dict)
        pod_spec(deployment)["containers"][0]["image"] += "-next"
        result = self.server.kubectl("--namespace", "again", "replace", "--validate=false",
                                     "--output", "json", "--filename", "-",
                                     input=json.dumps(deployment))
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(json.loads(result.stdout)["metadata"]["generation"], 2)

    def test_invalid_objects_are_rejected(self):
        """That the checks above are the server's: a selector that misses its own pods."""
        self.server.kubectl("create", "namespace", "wrong").check_returncode()
        deployment = next(one for one in map(as_of_1_20, objects_of("overlays/small"))
                          if one["kind"] == "Deployment")
        deployment["metadata"].pop("namespace", None)
        deployment["spec"]["selector"]["matchLabels"] = {"app": "another"}
        refused = self.server.create("wrong", deployment)
        self.assertIn("selector", refused)


if __name__ == "__main__":
    for needed in ("kubectl", "etcd", "openssl"):
        if not shutil.which(needed):
            tools.skip(f"{needed} is not installed")
    if not API_SERVER:
        tools.skip("no kube-apiserver; deploy/kubernetes/make_api_server.sh builds one")
    tools.main()
