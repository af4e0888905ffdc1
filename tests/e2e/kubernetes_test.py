"""What kustomize makes of deploy/kubernetes, checked for what no schema says: numbers that must fit one
another, selectors that must find their pods. With DUET_NODE_MODULES, a folder that has what
deploy/kubernetes/validate.mjs names, also against the published schemas."""

import json
import os
import re
import shutil
import unittest

import tools

try:
    import yaml
except ImportError:
    tools.skip("python3-yaml is not installed")

KUBERNETES = tools.SOURCE / "deploy/kubernetes"
OVERLAYS = ("small", "production", "keda", "canary")
FOLDERS = (*(f"overlays/{name}" for name in OVERLAYS), "batch", "batch/merge")


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
                    sleep + int(settings["drain_seconds"]) + int(settings["grace_seconds"]))

    def test_a_server_asks_for_the_whole_cores_that_it_may_use(self):
        for overlay in OVERLAYS:
            for _, template in pods_of(objects_of(f"overlays/{overlay}")):
                resources = template["spec"]["containers"][0]["resources"]
                self.assertEqual(resources["requests"], resources["limits"])
                self.assertRegex(resources["limits"]["cpu"], r"^\d+$")

    def test_selectors_find_the_servers_and_tell_the_canary_apart(self):
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

    def test_names_that_are_referred_to_are_there(self):
        for folder in FOLDERS:
            objects = objects_of(folder)
            there = {(one["kind"], one["metadata"]["name"]) for one in objects}
            for name, template in pods_of(objects):
                for volume in template["spec"].get("volumes", []):
                    if "configMap" in volume:
                        self.assertIn(("ConfigMap", volume["configMap"]["name"]), there, name)

    def test_every_completion_is_a_shard(self):
        job = of_kind(objects_of("batch"), "Job")[0]["spec"]
        environment = {one["name"]: one["value"]
                       for one in job["template"]["spec"]["containers"][0]["env"]}
        self.assertEqual(environment["JOB_COMPLETIONS"], str(job["completions"]))
        self.assertEqual(job["template"]["metadata"]["labels"]["duet.dev/client"], "true")

    @unittest.skipUnless("DUET_NODE_MODULES" in os.environ, "needs DUET_NODE_MODULES")
    def test_the_published_schemas_agree(self):
        objects = [one for folder in FOLDERS for one in objects_of(folder)]
        result = tools.run("node", KUBERNETES / "validate.mjs", os.environ["DUET_NODE_MODULES"],
                           input=json.dumps(objects))
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        self.assertIn(f"{len(objects)} passed, 0 failed", result.stdout)


if __name__ == "__main__":
    if not shutil.which("kubectl"):
        tools.skip("kubectl is not installed")
    tools.main()
