"""duet-server on its embedded checkpoint and the duet client: the whole path, every kind of file,
every kind of failure."""

import json
import math
import pathlib
import struct

import tools

JOINTS = 15


def bvh_frames(path):
    lines = pathlib.Path(path).read_text(encoding="utf-8").splitlines()
    return int(next(line for line in lines if line.startswith("Frames:")).split()[1])


def distance(a, b):
    return math.dist(a, b)


class Pair:
    """A pair as the client's .json file holds it."""

    def __init__(self, path):
        data = json.loads(pathlib.Path(path).read_text(encoding="utf-8"))
        self.joints = data["joint_names"]
        self.frame_rate = data["frame_rate_hz"]
        self.leader, self.follower = data["leader"], data["follower"]

    def at(self, person, frame, joint):
        return person[frame][self.joints.index(joint)]


class ClientServerTest(tools.ServedTest):
    def out(self, name):
        return self.folder / f"{self.id().split('.')[-1]}.{name}"

    def synthesize(self, leader, *labels, out, more=()):
        flags = [flag for label in labels for flag in ("--label", label)]
        return tools.duet("synthesize", "--server", self.server.address, "--leader", leader, *flags,
                          "--out", out, *more)

    def good(self, *arguments, **keywords):
        result = self.synthesize(*arguments, **keywords)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result

    def refused(self, code, words, *arguments, **keywords):
        result = self.synthesize(*arguments, **keywords)
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        for word in words:
            self.assertIn(word, result.stderr)
        self.assertEqual(result.stdout, "")

    def test_models_are_listed(self):
        result = tools.duet("models", "--server", self.server.address, "--json")
        self.assertEqual(result.returncode, 0, result.stderr)
        models = {}
        for model in json.loads(result.stdout)["models"]:  # the newest version first
            models.setdefault(model["name"], model)
        self.assertEqual(set(models), {"sbu", "k3hi", "salsa", "everyday"})
        self.assertTrue(models["sbu"]["is_default"])
        self.assertFalse(models["k3hi"].get("is_default", False))
        self.assertEqual(set(models["sbu"]["interaction_classes"]), set(tools.CLASSES))
        self.assertIn("point", models["k3hi"]["interaction_classes"])
        for name, model in models.items():
            is_free = name in ("salsa", "everyday")
            self.assertEqual(len(model["joint_names"]), 22 if is_free else JOINTS)
            self.assertEqual(model["free_for_all_uses"], is_free)
        for_people = tools.duet("models", "--server", self.server.address)
        self.assertIn(f"sbu@{models['sbu']['version']}, default", for_people.stdout)
        self.assertIn(f"k3hi@{models['k3hi']['version']}", for_people.stdout)

    def test_second_model_is_selected_by_name(self):
        out = self.out("k3hi.json")
        self.good(tools.sample("punch"), "point=1", out=out, more=("--model", "k3hi"))
        pair = Pair(out)
        self.assertEqual(len(pair.follower), bvh_frames(tools.sample("punch")))
        self.check_plausible(pair, "point")

    def test_every_class_has_an_answer_to_its_sample(self):
        for name in tools.CLASSES:
            out = self.out(f"{name}.json")
            self.good(tools.sample(name), f"{name}=1", out=out)
            pair = Pair(out)
            self.assertEqual(len(pair.leader), bvh_frames(tools.sample(name)))
            self.assertEqual(len(pair.follower), len(pair.leader))
            self.check_plausible(pair, name)

    def check_plausible(self, pair, name):
        """A person, upright, within reach of the leader, who looks at them at first."""
        for frame in range(0, len(pair.follower), 5):
            head = pair.at(pair.follower, frame, "head")
            torso = pair.at(pair.follower, frame, "torso")
            self.assertGreater(head[1], torso[1] + 0.2, f"{name}, frame {frame}")
            apart = distance(torso, pair.at(pair.leader, frame, "torso"))
            self.assertTrue(0.1 < apart < 2.5, f"{name}, frame {frame}: {apart} m apart")
        left, right = (pair.at(pair.follower, 0, f"{side}_hip") for side in ("left", "right"))
        facing = (right[2] - left[2], left[0] - right[0])  # (x, z) of up x (right - left)
        torso = pair.at(pair.follower, 0, "torso")
        leader = pair.at(pair.leader, 0, "torso")
        towards = facing[0] * (leader[0] - torso[0]) + facing[1] * (leader[2] - torso[2])
        self.assertGreater(towards, 0, f"{name}: the follower turns its back")

    def test_best_of_several_candidates(self):
        followers = []
        for candidates in (1, 4, 4):
            for seed in range(4):
                result = self.good(tools.sample("hug"), "hug=1", out=self.out("json"),
                                   more=("--json", "--seed", seed, "--candidates", candidates))
                followers.append(Pair(self.out("json")).follower)
                report = json.loads(result.stdout)
                self.assertEqual(report["candidates"], candidates)
                for share in ("twisted", "skating", "leader_skating", "overlapping"):
                    self.assertTrue(0 <= report["grade"][share] <= 1, report["grade"])
        self.assertEqual(followers[4:8], followers[8:])
        self.assertNotEqual(followers[:4], followers[4:8])  # the first sample is not the best for every seed

    def test_clean_up_can_be_switched_off(self):
        frames = {}
        for text, cleaned_up in (("", True), ("clean_up: CLEAN_UP_ON", True), ("clean_up: CLEAN_UP_OFF", False)):
            out, request = self.out("json"), self.out("textproto")
            request.write_text(text, encoding="utf-8")
            result = self.good(tools.sample("kick"), "kick=1", out=out, more=("--json", "--seed", "1", "--request", request))
            self.assertEqual(json.loads(result.stdout)["cleaned_up"], cleaned_up)  # the default model samples
            frames[text] = Pair(out).follower
        auto, on, off = frames.values()
        self.assertEqual(auto, on)
        self.assertGreater(max(distance(p, q) for a, b in zip(on, off) for p, q in zip(a, b)), 1e-3)

    def test_every_format_has_the_same_follower(self):
        out = {extension: self.out(extension) for extension in ("json", "csv", "npy", "html", "bvh")}
        more = [flag for path in list(out.values())[1:] for flag in ("--out", path)]
        self.good(tools.sample("push"), "push=1", out=out["json"], more=more)
        pair = Pair(out["json"])
        frames = len(pair.follower)
        npy = out["npy"].read_bytes()
        self.assertIn(f"(2, {frames}, {JOINTS}, 3)".encode(), npy[:128])
        self.assertLess(distance(struct.unpack("<3f", npy[-12:]), pair.follower[-1][-1]), 1e-4)
        for person in ("leader", "follower"):
            self.assertEqual(bvh_frames(out["bvh"].with_suffix(f".{person}.bvh")), frames)
        self.assertGreaterEqual(len(out["csv"].read_text(encoding="utf-8").splitlines()), frames)
        self.assertIn(f'"frames":{frames}', out["html"].read_text(encoding="utf-8"))
        # No other file is left.
        mine = {path.name for path in self.folder.glob(out["json"].stem + ".*")}
        self.assertEqual(len(mine), 6, mine)

    def test_bad_input_exits_with_42_and_is_named(self):
        out = self.out("html")
        kick = tools.sample("kick")
        self.refused(42, ["no-such.bvh"], self.folder / "no-such.bvh", "kick=1", out=out)
        broken = self.folder / "broken.bvh"
        broken.write_text("HIERARCHY\nROOT\n", encoding="utf-8")
        self.refused(42, ["broken.bvh"], broken, "kick=1", out=out)
        self.refused(42, ["interaction_class", "dance", "kick, push"], kick, "dance=1", out=out)
        self.refused(42, ["label_vector.weights[1].weight", "[-2, 2]"], kick, "hug=1", "kick=9",
                     out=out)
        self.refused(42, ["leader.frame_rate_hz", "1 to 240"], kick, "kick=1", out=out,
                     more=("--frame-rate", "500"))
        self.refused(42, ["NOT_FOUND", "nobody"], kick, "kick=1", out=out,
                     more=("--model", "nobody"))
        self.refused(42, ["NOT_FOUND"], kick, "kick=1", out=out, more=("--model", "sbu@99"))
        self.assertFalse(out.exists())

    def test_expired_deadline_exits_with_1(self):
        # Half a minute takes a dozen windows, each of about as long as the deadline.
        result = self.synthesize(tools.sample("salsa"), "kick=1", out=self.out("html"),
                                 more=("--timeout", "0.001"))
        self.assertEqual(result.returncode, 1, result.stderr)


if __name__ == "__main__":
    tools.main()
