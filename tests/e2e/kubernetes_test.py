"""What kustomize makes of deploy/kubernetes, checked for what no schema says: numbers that must fit one
another, selectors that must find their pods; and the two scripts there, the check of hashes and the batch."""

import hashlib
import os
import pathlib
import re
import shutil
import tempfile
import unittest

import tools

try:
    import yaml
except ImportError:
    tools.skip("python3-yaml is not installed")

KUBERNETES = tools.SOURCE / "deploy/kubernetes"
OVERLAYS = ("small", "production", "canary")
FOLDERS = (*(f"overlays/{name}" for name in OVERLAYS), "batch", "batch/gather")


def objects_of(folder):
    result = tools.run("kubectl", "kustomize", KUBERNETES / folder)
    assert result.returncode == 0, f"{folder}: {result.stderr}"
    return list(yaml.safe_load_all(result.stdout))


def of_kind(objects, kind):
    return [one for one in objects if one["kind"] == kind]


def pods_of(objects):
    """The pod templates, as (name, template)."""
    return [(one["metadata"]["name"], one["spec"]["template"])
            for one in objects if one["kind"] in ("Deployment", "Job")]


def selected(selector, labels):
    return all(labels.get(key) == value for key, value in selector.items())

# A kubectl that writes down what it is asked for. The wait for one of a job's two ends returns at once, that
# for the other one never.
KUBECTL = """#!/bin/sh
case "$*" in
  *wait*--for=condition=$END_OF_JOBS*) ;;
  *wait*) echo $$ >>"$FOLDER/waiting" && exec sleep infinity ;;
  *) echo "$*" >>"$FOLDER/asked" ;;
esac
"""


class KubernetesTest(unittest.TestCase):
    def test_every_pod_is_confined(self):
        for folder in FOLDERS:
            for name, template in pods_of(objects_of(folder)):
                spec = template["spec"]
                with self.subTest(folder=folder, pod=name):
                    self.assertIs(spec["automountServiceAccountToken"], False)
                    self.assertIs(spec["securityContext"]["runAsNonRoot"], True)
                    for container in spec["containers"] + spec.get("initContainers", []):
                        rights = container["securityContext"]
                        self.assertIs(rights["allowPrivilegeEscalation"], False)
                        self.assertIs(rights["readOnlyRootFilesystem"], True)
                        self.assertEqual(rights["capabilities"], {"drop": ["ALL"]})
                        self.assertIn("memory", container["resources"]["limits"])

    def test_a_pod_may_take_as_long_to_end_as_its_calls(self):
        for overlay in OVERLAYS:
            objects = objects_of(f"overlays/{overlay}")
            config = next(one for one in of_kind(objects, "ConfigMap")
                          if one["metadata"]["name"].startswith("duet-config"))
            settings = dict(re.findall(r"^(\w+): (\d+)$", config["data"]["server.textproto"],
                                       re.MULTILINE))
            for _, template in pods_of(objects):
                spec = template["spec"]
                sleep = spec["containers"][0]["lifecycle"]["preStop"]["sleep"]["seconds"]
                self.assertGreater(
                    spec["terminationGracePeriodSeconds"],
                    sleep + int(settings["drain_seconds"]) + int(settings["grace_seconds"])
                    + 10)  # until a server that hangs exits by itself

    def test_only_overlays_without_an_autoscaler_state_the_number_of_pods(self):
        """Where both do, each apply sets back what the autoscaler has chosen."""
        for overlay in OVERLAYS:
            objects = objects_of(f"overlays/{overlay}")
            scaled = [one["spec"]["scaleTargetRef"]["name"] for one in of_kind(objects, "ScaledObject")]
            for deployment in of_kind(objects, "Deployment"):
                with self.subTest(overlay=overlay):
                    self.assertEqual("replicas" in deployment["spec"],
                                     deployment["metadata"]["name"] not in scaled)

    def test_selectors_distinguish_servers_and_canary(self):
        stable = objects_of("overlays/production")
        canary = objects_of("overlays/canary")
        pods = {track: of_kind(objects, "Deployment")[0]
                for track, objects in (("stable", stable), ("canary", canary))}
        labels = {track: pod["spec"]["template"]["metadata"]["labels"]
                  for track, pod in pods.items()}
        selectors = {"Service": lambda one: one["spec"]["selector"],
                     "PodDisruptionBudget": lambda one: one["spec"]["selector"]["matchLabels"],
                     "NetworkPolicy": lambda one: one["spec"]["podSelector"]["matchLabels"]}
        for kind, selector_of in selectors.items():
            selector = selector_of(of_kind(stable, kind)[0])
            for track in pods:
                self.assertTrue(selected(selector, labels[track]), f"{kind}, {track}")
        for track, pod in pods.items():
            selector = pod["spec"]["selector"]["matchLabels"]
            for other in pods:
                self.assertEqual(selected(selector, labels[other]), track == other)
        self.assertNotEqual(pods["stable"]["metadata"]["name"], pods["canary"]["metadata"]["name"])

    def test_every_completion_is_a_shard(self):
        job = of_kind(objects_of("batch"), "Job")[0]["spec"]
        command = job["template"]["spec"]["containers"][0]["command"]
        self.assertEqual(command[-2:],
                         ["--shard", f"$(JOB_COMPLETION_INDEX)/{job['completions']}"])
        self.assertEqual(job["template"]["metadata"]["labels"]["duet.dev/client"], "true")

    def verify_models(self, folder):
        """What the init container says to a volume that is at `folder`/models."""
        deployment = of_kind(objects_of("overlays/production"), "Deployment")[0]
        shell, flags, script = deployment["spec"]["template"]["spec"]["initContainers"][0]["command"]
        script = re.sub(r"(?<![\w.])/(?=(models|hashes|tmp)\b)", f"{folder}/", script)
        return tools.run(shell, flags, script)

    def test_models_are_served_only_with_matching_hashes(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            for path in ("models/sbu/1", "hashes", "tmp"):
                (folder / path).mkdir(parents=True)
            weights = folder / "models/sbu/1/weights.safetensors"
            weights.write_bytes(b"weights")
            (folder / "hashes/models.sha256").write_text(
                f"{hashlib.sha256(b'weights').hexdigest()}  ./sbu/1/weights.safetensors\n")
            self.assertEqual(self.verify_models(folder).returncode, 0)

            weights.write_bytes(b"weightz")
            changed = self.verify_models(folder)
            self.assertNotEqual(changed.returncode, 0)
            self.assertIn("./sbu/1/weights.safetensors: FAILED", changed.stdout)

            weights.write_bytes(b"weights")
            (folder / "models/sbu/1/more").touch()
            added = self.verify_models(folder)
            self.assertNotEqual(added.returncode, 0)
            self.assertIn("./sbu/1/more", added.stdout)

            (folder / "models/sbu/1/more").unlink()
            weights.unlink()
            self.assertNotEqual(self.verify_models(folder).returncode, 0)

    def run_batch(self, end_of_jobs):
        """Runs the batch where jobs end in this way; its result, and what it asked of kubectl."""
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            kubectl = folder / "kubectl"
            kubectl.write_text(KUBECTL)
            kubectl.chmod(0o755)
            result = tools.run(KUBERNETES / "batch/run.sh", "there", env={
                **os.environ, "PATH": f"{folder}:{os.environ['PATH']}", "FOLDER": name,
                "END_OF_JOBS": end_of_jobs})
            waiting = folder / "waiting"
            for process in waiting.read_text().split() if waiting.exists() else ():
                self.assertFalse(pathlib.Path(f"/proc/{process}").exists(), "a wait goes on")
            return result, (folder / "asked").read_text().splitlines()

    def test_batch_is_gathered_after_its_shards(self):
        result, asked = self.run_batch("complete")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(asked, ["apply -k .", "apply -k gather",
                                 "--namespace there logs job/duet-batch-gather"])

    def test_batch_with_failed_shards_is_not_gathered(self):
        result, asked = self.run_batch("failed")
        self.assertEqual(result.returncode, 1)
        self.assertIn("job/duet-batch failed", result.stderr)
        self.assertEqual(asked, ["apply -k ."])


if __name__ == "__main__":
    if not shutil.which("kubectl"):
        tools.skip("kubectl is not installed")
    tools.main()
