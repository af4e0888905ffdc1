"""duet batch against duet-server: data sets that are whole and the same however often anything is
killed or damaged, what duet_motion.sets makes of them, shards of a job, refusals, and Ctrl-C.

    batch_test.py [KILLS] [test...]     how often each kill test kills; 6
"""

import hashlib
import json
import os
import random
import resource
import shutil
import signal
import subprocess
import sys
import time

import tools

KILLS = int(sys.argv.pop(1)) if sys.argv[1:] and sys.argv[1].isdigit() else 6

RECIPE = """
seed: 7
reactions { each_class {} }
reactions { mixes { count: 2 } }
samples: 2
output { formats: FORMAT_NPY %s }
"""


def digests(folder):
    """The files of a data set: path to digest, without the job's folder."""
    found = {}
    for path in sorted(folder.rglob("*")):
        name = path.relative_to(folder).as_posix()
        if path.is_file() and not name.startswith(".duet-batch/"):
            found[name] = hashlib.sha256(path.read_bytes()).hexdigest()
    return found


def entries(folder, name="index.jsonl"):
    lines = (folder / name).read_text(encoding="utf-8").splitlines()
    return [json.loads(line) for line in lines]


def sets(*words):
    """Runs a command of duet_motion.sets."""
    return tools.run(sys.executable, "-m", "duet_motion.sets", *words,
                     env={**os.environ, "PYTHONPATH": str(tools.SOURCE / "client" / "python")})


def change(path, at):
    """Flips a bit of a file in place."""
    with path.open("r+b") as file:
        file.seek(at)
        byte = file.read(1)
        file.seek(at)
        file.write(bytes([byte[0] ^ 1]))


class BatchTest(tools.ServedTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.leaders = cls.folder / "leaders"
        (cls.leaders / "far").mkdir(parents=True)
        for name in ("kick", "hug"):
            shutil.copy(tools.sample(name), cls.leaders)
        shutil.copy(tools.sample("push"), cls.leaders / "far")
        # The set of RECIPE that an undisturbed run makes.
        cls.whole = cls.folder / "whole"
        recipe = cls.folder / "whole.textproto"
        recipe.write_text(RECIPE % "", encoding="utf-8")
        tools.run(*cls.command(cls.whole, recipe, "--quiet")).check_returncode()

    def recipe(self, more="", text=RECIPE):
        path = self.folder / f"{self.id().split('.')[-1]}.textproto"
        path.write_text(text % more, encoding="utf-8")
        return path

    def out(self, name="set"):
        return self.folder / f"{self.id().split('.')[-1]}-{name}"

    @classmethod
    def command(cls, out, recipe, *flags, server=None, leaders=None):
        return [tools.PROGRAMS / "duet", "batch", *([] if "--manifest" in flags else [leaders or cls.leaders]),
                "--recipe", recipe, "--out", out, "--server", server or cls.server.address, *flags]

    def batch(self, out, recipe, *flags, code=0, **options):
        result = tools.run(*self.command(out, recipe, *flags, **options))
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        return result

    def verified(self, out, code=0):
        result = sets("verify", out)
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        return result

    def check_whole(self, out):
        self.verified(out)
        self.assertEqual(digests(out), digests(self.whole))

    def copy_of_whole(self):
        """The undisturbed set under another name, and its motions."""
        out = self.out()
        shutil.copytree(self.whole, out)
        return out, sorted(out.rglob("*.npy"))

    def kill_often(self, command):
        """Kills the command again and again, and then lets it end."""
        dice, seconds = random.Random(), []
        for _ in range(KILLS):
            seconds.append(round(dice.uniform(0.01, 0.3), 3))
            client = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            try:
                client.wait(seconds[-1])
            except subprocess.TimeoutExpired:
                pass
            client.kill()
            client.wait()
        result = tools.run(*command)
        self.assertEqual(result.returncode, 0, f"{seconds} {result.stderr}")

    def test_folder_becomes_a_data_set(self):
        out = self.out()
        self.batch(out, self.recipe("formats: FORMAT_GLB"))
        index = entries(out)
        self.assertEqual(len(index), 3 * (6 + 2) * 2)
        self.assertEqual((out / "far" / "push-kick-s1.glb").read_bytes()[:4], b"glTF")
        self.assertEqual([entry["item"] for entry in index], list(range(len(index))))
        self.assertTrue((out / "far" / "push-kick-s1.npy").is_file())
        for entry in index:
            self.assertEqual(entry["request_id"], "batch-" + entry["id"])
            self.assertEqual(entry["candidates"], 1)
            for share in ("twisted", "skating", "leader_skating", "overlapping"):
                self.assertTrue(0 <= entry["quality"][share] <= 1, entry["quality"])
            for file in entry["files"]:
                content = (out / file["path"]).read_bytes()
                self.assertEqual(hashlib.sha256(content).hexdigest(), file["sha256"])
        self.assertEqual(json.loads((out / "dataset.json").read_text(encoding="utf-8"))["items"],
                         {"done": len(index), "rejected": 0, "failed": 0, "missing": 0})
        self.verified(out)
        (out / "far" / "push-kick-s1.npy").write_bytes(b"changed")
        self.assertIn("push-kick-s1.npy: was changed", self.verified(out, 42).stderr)

    def test_answer_equals_that_of_synthesize(self):
        out, single = self.whole, self.folder / "single.npy"
        entry = next(e for e in entries(out) if e["name"] == "hug-kick-s0")
        result = tools.duet("synthesize", "--server", self.server.address, "--leader",
                            self.leaders / "hug.bvh", "--label", "kick=1", "--seed", entry["seed"],
                            "--out", single)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(single.read_bytes(), (out / "hug-kick-s0.npy").read_bytes())

    def test_killed_runs_end_with_the_same_set(self):
        # Enough items for the run to outlast all kills.
        samples = f"samples: {max(2, KILLS // 3)}"
        recipe = self.recipe(text=RECIPE.replace("samples: 2", samples))
        whole, out = self.out("whole"), self.out()
        self.batch(whole, recipe)
        dice, server, kills = random.Random(), tools.Server("--reflection=false"), 0
        seconds = []
        try:
            while True:
                client = subprocess.Popen(
                    self.command(out, recipe, "--patience", "60", "--quiet",
                                 server=server.address),
                    stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
                if kills < KILLS:
                    wait = dice.uniform(0.02, 0.5)
                    seconds.append(round(wait, 3))
                    try:
                        client.wait(wait)
                    except subprocess.TimeoutExpired:
                        pass
                    kills += 1
                    if kills % 3 == 0:
                        server.kill()
                    client.kill()
                    client.communicate()
                    if kills % 3 == 0:
                        server = tools.Server("--reflection=false")
                    continue
                _, errors = client.communicate(timeout=tools.RUN_SECONDS)
                self.assertEqual(client.returncode, 0, errors)
                break
        finally:
            server.stop()
        self.assertEqual(digests(out), digests(whole), f"killed after {seconds}")
        self.verified(out)

    def test_server_restart_loses_nothing(self):
        recipe, out = self.recipe(), self.out()
        port = tools.free_port()
        server = tools.Server(port=port)
        client = subprocess.Popen(
            self.command(out, recipe, "--patience", "60", server=server.address),
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        while not list(out.glob("*.npy")) and client.poll() is None:
            time.sleep(0.005)
        server.kill()
        server = tools.Server(port=port)
        try:
            said, _ = client.communicate(timeout=tools.RUN_SECONDS)
        finally:
            server.stop()
        self.assertEqual(client.returncode, 0, said)
        self.assertEqual(digests(out), digests(self.whole))

    def test_set_without_items_is_pointed_out(self):
        result = self.batch(self.out(), self.recipe(), "--limit", "0")
        self.assertIn("0 done, 0 rejected, 0 failed, 0 missing", result.stdout)
        self.assertIn("duet: the plan has no items: ", result.stderr)

    def test_full_disk_exits_with_retry(self):
        recipe, out = self.recipe(), self.out()

        def fill_disk():  # files take no more than this; SIGXFSZ would end the process
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (20000, resource.RLIM_INFINITY))

        result = tools.run(*self.command(out, recipe), preexec_fn=fill_disk)
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertIn("cannot write", result.stderr)
        self.assertIn(" 48 items missing", sets("verify", out).stdout)
        self.assertEqual(list(out.rglob("*.npy")), [])
        self.batch(out, recipe)
        self.assertEqual(digests(out), digests(self.whole))

    def test_interrupt_finishes_calls_in_progress(self):
        recipe, out = self.recipe("formats: FORMAT_BVH"), self.out()
        # Five calls a second, so the run still takes seconds after the first files appear.
        token, access = self.out("token"), self.out("access")
        token.write_text("secret", encoding="utf-8")
        access.write_text(f"batch synthesise sha256:{hashlib.sha256(b'secret').hexdigest()} "
                          "calls_per_second=5\n", encoding="utf-8")
        server = tools.Server("--access-file", access)
        self.addCleanup(server.stop)
        client = subprocess.Popen(
            self.command(out, recipe, "--max-in-flight", "1", "--token-file", token,
                         server=server.address),
            stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        while not list(out.glob("*.bvh")) and client.poll() is None:
            time.sleep(0.005)
        client.send_signal(signal.SIGINT)
        said, errors = client.communicate(timeout=tools.RUN_SECONDS)
        self.assertEqual(client.returncode, 1, said + errors)
        made = entries(out)
        self.assertGreater(len(made), 0)
        self.assertLess(len(made), 48)
        missing = 48 - len(made)
        self.assertIn(f"{len(made)} done, 0 rejected, 0 failed, {missing} missing", said.decode())
        self.assertEqual(json.loads((out / "dataset.json").read_text())["items"]["missing"], missing)
        self.assertIn(f" {missing} items missing", self.verified(out, 1).stdout)
        self.batch(out, recipe)
        self.assertEqual(len(entries(out)), 48)

    def test_dry_run_counts_and_writes_nothing(self):
        out = self.out()
        result = self.batch(out, self.recipe(), "--dry-run")
        self.assertIn("48 items of 3 leaders", result.stdout)
        self.assertFalse(out.exists())
        broken = self.out("broken")
        broken.mkdir()
        (broken / "a.bvh").write_text("HIERARCHY", encoding="utf-8")
        result = self.batch(out, self.recipe(), "--dry-run", code=42, leaders=broken)
        self.assertEqual(result.stderr.count("cannot be used: "), 1)
        self.assertIn("a.bvh", result.stderr)
        self.assertFalse(out.exists())

    def test_invalid_lines_are_rejected_before_the_run(self):
        out, manifest = self.out(), self.out("manifest.tsv")
        rows = ["leader\tlabels\tleader_side", f"{self.leaders}/kick.bvh\tkick=1\t",
                f"{self.leaders}/hug.bvh\tkik=1\t", f"{self.leaders}/hug.bvh\thug=1\tlft",
                f"{self.leaders}/hug.bvh"]
        manifest.write_text("\n".join(rows) + "\n", encoding="utf-8")
        for flags in ((), ("--dry-run",)):
            result = self.batch(out, self.recipe(), "--manifest", manifest, *flags, code=42)
            self.assertIn("3 bad lines", result.stderr)
            self.assertIn(f"{manifest}:3: labels: expected classes of sbu@3", result.stderr)
        self.assertFalse((out / "index.jsonl").exists())
        manifest.write_text("\n".join(rows[:2]) + "\n", encoding="utf-8")
        self.batch(out, self.recipe(), "--manifest", manifest, "--limit", "1")  # the same --out

    def test_a_tolerated_share_of_bad_leaders_lets_shards_merge(self):
        leaders, recipe = self.out("leaders"), self.recipe()
        leaders.mkdir()
        for name in ("kick", "hug", "push"):
            shutil.copy(tools.sample(name), leaders)
        (leaders / "broken.bvh").write_text("HIERARCHY", encoding="utf-8")
        for allowed, code in (("0%", 42), ("24%", 42), ("25%", 0)):
            for flags in (("--dry-run",), ()):
                result = self.batch(self.out(1), recipe, "--allow-failed", allowed, *flags, code=code, leaders=leaders)
        self.assertIn("16 failed", result.stdout)
        self.assertIn("--allow-failed permits them", result.stderr)
        for index in range(2):
            self.batch(self.out(), recipe, "--shard", f"{index}/2", "--allow-failed", "25%",
                       leaders=leaders)
        merged = self.batch(self.out(), recipe, "--allow-failed", "25%", leaders=leaders)
        self.assertIn("gathered 2 of 2 shards, 64 items", merged.stderr)
        self.assertEqual(digests(self.out()), digests(self.out(1)))
        self.verified(self.out())
        wrong = self.batch(self.out("wrong"), recipe, "--allow-failed", "many", code=2)
        self.assertIn("--allow-failed: expected a share of the leaders from 0% to 100%", wrong.stderr)

    def test_one_rate_for_all_items(self):
        leaders, out, mixed = self.out("leaders"), self.out(), self.out("mixed")
        leaders.mkdir()
        for name, rate in (("kick", 30), ("hug", 120)):
            tools.duet("convert", tools.sample(name), "--resample", rate, "--out",
                       leaders / f"{name}.bvh").check_returncode()
        self.batch(mixed, self.recipe(), leaders=leaders)
        described = json.loads((mixed / "dataset.json").read_text(encoding="utf-8"))
        self.assertNotIn("frame_rate_hz", described)
        self.assertEqual([rate["frame_rate_hz"] for rate in described["frame_rates"]], [30, 120])
        self.batch(out, self.recipe("frame_rate_hz: 25"), leaders=leaders)
        dataset = json.loads((out / "dataset.json").read_text(encoding="utf-8"))
        self.assertEqual(dataset["frame_rate_hz"], 25)
        for entry, before in zip(entries(out), entries(mixed)):
            self.assertEqual((entry["frame_rate_hz"], entry["seed"]), (25, before["seed"]))
            self.assertAlmostEqual(entry["frames"] / 25, before["frames"] / before["frame_rate_hz"],
                                   delta=0.1)

    def test_gathered_shards_equal_a_single_run(self):
        recipe, out = self.recipe(), self.out()
        for index in range(2):
            self.batch(out, recipe, "--shard", f"{index}/3")
        self.batch(out, recipe, "--shard", "2/3", "--limit", "20")
        # The shard that is not complete, and a file that was changed, are made by the run itself, even if it is killed.
        changed = next((out / "shard-0-of-3").glob("*.npy"))
        change(changed, changed.stat().st_size // 2)
        self.kill_often(self.command(out, recipe, "--verify"))
        self.assertEqual(list(out.glob("shard-*")), [])
        self.check_whole(out)
        again = self.batch(out, recipe)
        self.assertNotIn("gathered", again.stderr)

    def test_shards_that_do_not_belong_together_are_refused(self):
        recipe, out = self.recipe(), self.out()
        for index in range(2):
            self.batch(out, recipe, "--shard", f"{index}/2")
        other = self.batch(out, self.recipe("formats: FORMAT_BVH"), code=42)
        self.assertIn("shard-0-of-2: was begun with another recipe", other.stderr)
        self.recipe()
        job = out / "shard-1-of-2" / ".duet-batch" / "job.json"
        begun = json.loads(job.read_text(encoding="utf-8"))
        begun["models"][0]["weights_sha256"] = "ab" * 32
        job.write_text(json.dumps(begun), encoding="utf-8")
        refused = self.batch(out, recipe, code=42)
        self.assertIn("shard-1-of-2: expected the models and weights of the other", refused.stderr)

    def test_sets_are_split_and_packed(self):
        out = self.out()
        shutil.copytree(self.whole, out)
        for words in (("split", out, "--validation", "0.4", "--test", "0.2"), ("pack", out, self.out("tar"), "--kind", "tar")):
            made = sets(*words)
            self.assertEqual(made.returncode, 0, made.stderr)
        packed = self.out("tar")
        self.assertEqual([{**entry, "shard": 0, "split": 0} for entry in entries(packed)],
                         [{**entry, "shard": 0, "split": 0} for entry in entries(out)])
        self.verified(packed)
        self.verified(out)

    def test_manifest_lists_leaders_that_may_be_mended_later(self):
        out, mended, manifest = self.out(), self.folder / "mended.bvh", self.out("list.tsv")
        manifest.write_text(f"leader\tlabels\tseed\ttake\n{self.leaders}/kick.bvh\thug=1\t5\tseven\n"
                            f"{mended}\thug=1\t\t\n", encoding="utf-8")
        recipe = self.recipe(text="output { formats: FORMAT_NPY %s }")
        result = self.batch(out, recipe, "--manifest", manifest, code=42)
        self.assertIn("1 done, 0 rejected, 1 failed", result.stdout)
        self.assertIn("mended.bvh: no such file", result.stderr)
        (entry,) = entries(out)
        self.assertEqual((entry["seed"], entry["extra"]), (5, {"take": "seven"}))
        (failed,) = entries(out, "failed.jsonl")
        self.assertEqual(failed["error"]["code"], "NOT_FOUND")
        shutil.copy(tools.sample("push"), mended)
        self.batch(out, recipe, "--manifest", manifest, "--retry-failed")
        self.assertEqual([entry["item"] for entry in entries(out)], [0, 1])
        self.verified(out)

    def test_damage_is_found_and_repaired_even_if_the_repair_is_killed(self):
        out, files = self.copy_of_whole()
        files[0].unlink()
        change(files[1], files[1].stat().st_size // 2)
        os.truncate(files[2], 1000)
        change(out / ".duet-batch" / "journal", 3000)
        change(out / "index.jsonl", 200)
        os.truncate(out / "dataset.json", 100)
        found = self.verified(out, 42).stderr
        for problem in (f"{files[0]}: no such file", f"{files[1]}: was changed", f"{files[2]}: was changed",
                        "dataset.json: expected a JSON object", "repeat the duet batch command with --verify"):
            self.assertIn(problem, found)
        self.kill_often(self.command(out, self.recipe(), "--verify"))
        self.check_whole(out)

    def test_a_damaged_identity_says_how_to_go_on(self):
        out, _ = self.copy_of_whole()
        job = out / ".duet-batch" / "job.json"
        os.truncate(job, job.stat().st_size // 2)
        refused = self.batch(out, self.recipe(), code=42)
        self.assertIn(f"{job}: is damaged: ", refused.stderr)
        self.assertIn("delete it and run the command that made the set again", refused.stderr)
        job.unlink()
        refused = self.batch(out, self.recipe(text=RECIPE.replace("seed: 7", "seed: 8")), code=42)
        self.assertIn("as the set was begun with, got", refused.stderr)
        self.batch(out, self.recipe())
        self.check_whole(out)

    def test_places_that_cannot_be_written_are_no_reason_to_try_again(self):
        loop = self.out("loop")
        loop.symlink_to(loop)
        refused = self.batch(loop, self.recipe(), code=42)
        self.assertIn("Too many levels of symbolic links", refused.stderr)

    def test_rejected_recipe_does_not_block_another(self):
        out = self.out()
        self.batch(out, self.recipe(text="output { formats: FORMAT_NPY %s }"), code=42)  # has no reactions
        self.batch(out, self.recipe())
        self.check_whole(out)
        result = self.batch(out, self.recipe(text=RECIPE.replace("seed: 7", "seed: 8")), code=42)
        self.assertIn("modified: seed: 7 -> 8", result.stderr)


if __name__ == "__main__":
    tools.main()
