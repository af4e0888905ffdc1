"""Data sets of duet batch that were damaged or made in several goes: repaired, gathered and grown by the
real program, which is killed at the worst moments, to the same bytes as without all that.

    batch_repair_test.py [KILLS] [test...]     how often each kill test kills; 4
"""

import os
import random
import shutil
import subprocess
import sys

KILLS = int(sys.argv.pop(1)) if sys.argv[1:] and sys.argv[1].isdigit() else 4

import tools  # noqa: E402
from batch_test import digests, entries, sets  # noqa: E402

RECIPE = """
seed: 7
reactions { each_class {} }
samples: 2
output { formats: FORMAT_NPY }
"""
def change(path, at):
    """Flips a bit of a file in place."""
    with path.open("r+b") as file:
        file.seek(at)
        byte = file.read(1)
        file.seek(at)
        file.write(bytes([byte[0] ^ 1]))


class BatchRepairTest(tools.ServedTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.leaders = cls.folder / "leaders"
        cls.leaders.mkdir()
        for name in ("kick", "hug", "push"):
            shutil.copy(tools.sample(name), cls.leaders)
        # The set that an undisturbed run makes.
        (cls.folder / "recipe.textproto").write_text(RECIPE, encoding="utf-8")
        made = tools.run(*cls.command("whole"), cwd=cls.folder)
        assert made.returncode == 0, made.stderr
        cls.whole = cls.folder / "whole"

    @classmethod
    def command(cls, out, *flags, leaders="leaders"):
        return [tools.PROGRAMS / "duet", "batch", leaders, "--recipe", "recipe.textproto", "--out", out,
                "--server", cls.server.address, "--quiet", *flags]

    def run_in_folder(self, *command, code=0):
        result = tools.run(*command, cwd=self.folder)
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        return result

    def copy_of_whole(self, name):
        """The undisturbed set under another name, and its motions."""
        out = self.folder / name
        shutil.copytree(self.whole, out)
        return out, sorted(out.rglob("*.npy"))

    def verified(self, out, code=0):
        result = sets("verify", out)
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        return result

    def check_whole(self, out):
        self.verified(out)
        self.assertEqual(digests(out), digests(self.whole))

    def kill_often(self, command):
        """Kills the command again and again, and then lets it end."""
        dice, seconds = random.Random(), []
        for _ in range(KILLS):
            seconds.append(round(dice.uniform(0.01, 0.3), 3))
            client = subprocess.Popen(command, cwd=self.folder, stdout=subprocess.DEVNULL,
                                      stderr=subprocess.DEVNULL)
            try:
                client.wait(seconds[-1])
            except subprocess.TimeoutExpired:
                pass
            client.kill()
            client.wait()
        result = tools.run(*command, cwd=self.folder)
        self.assertEqual(result.returncode, 0, f"{seconds} {result.stderr}")

    def test_damage_is_found_and_repaired(self):
        out, files = self.copy_of_whole("damaged")
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
        self.run_in_folder(*self.command(out.name, "--verify"))
        self.check_whole(out)

    def test_killed_repair_is_repeated(self):
        out, files = self.copy_of_whole("killed")
        for file in files[::2]:
            change(file, file.stat().st_size // 2)
        files[1].unlink()
        self.kill_often(self.command(out.name, "--verify"))
        self.check_whole(out)

    def test_killed_gathering_is_repeated(self):
        out = self.folder / "gathered"
        for index in range(3):
            self.run_in_folder(*self.command(out.name, "--shard", f"{index}/3"))
        self.kill_often(self.command(out.name))
        self.assertEqual(list(out.glob("shard-*")), [])
        self.check_whole(out)

    def test_items_of_a_mended_leader_are_made_later(self):
        out, mended, manifest = self.folder / "late", self.folder / "mended.bvh", self.folder / "late.tsv"
        manifest.write_text(f"leader\n{self.leaders / 'hug.bvh'}\n{mended}\n{self.leaders / 'kick.bvh'}\n",
                            encoding="utf-8")
        command = [tools.PROGRAMS / "duet", "batch", "--manifest", manifest, "--recipe", "recipe.textproto",
                   "--out", out, "--server", self.server.address]
        self.run_in_folder(*command, code=42)
        before = {name: digest for name, digest in digests(out).items() if name.endswith(".npy")}
        self.assertEqual(len(before), 24)
        shutil.copy(tools.sample("push"), mended)
        self.run_in_folder(*command, "--retry-failed")
        after = digests(out)
        self.assertEqual({name: after[name] for name in before}, before)
        self.assertEqual([entry["item"] for entry in entries(out)], list(range(36)))
        self.verified(out)

    def test_a_damaged_identity_says_how_to_go_on(self):
        out, _ = self.copy_of_whole("identity")
        job = out / ".duet-batch" / "job.json"
        os.truncate(job, job.stat().st_size // 2)
        refused = self.run_in_folder(*self.command(out.name), code=42)
        self.assertIn(f"{job.relative_to(self.folder)}: is damaged: ", refused.stderr)
        self.assertIn("delete it and run the command that made the set again", refused.stderr)
        job.unlink()
        other = self.command(out.name)
        other[other.index("recipe.textproto")] = "other.textproto"
        (self.folder / "other.textproto").write_text(RECIPE.replace("seed: 7", "seed: 8"), encoding="utf-8")
        refused = self.run_in_folder(*other, code=42)
        self.assertIn("as the set was begun with, got", refused.stderr)
        self.run_in_folder(*self.command(out.name))
        self.check_whole(out)

    def test_places_that_cannot_be_written_are_no_reason_to_try_again(self):
        loop, closed = self.folder / "loop", self.folder / "closed"
        loop.symlink_to(loop)
        closed.mkdir()
        refused = self.run_in_folder(*self.command(loop), code=42)
        self.assertIn("Too many levels of symbolic links", refused.stderr)
        # In a mount namespace of its own, where the system permits one.
        read_only = ["unshare", "-rm", "sh", "-c", 'mount --bind "$0" "$0" && '
                     'mount -o remount,bind,ro "$0" && exec "$@"', closed]
        if not shutil.which("unshare") or tools.run(*read_only, "true").returncode != 0:
            self.skipTest("no read-only mount")
        refused = self.run_in_folder(*read_only, *self.command(closed / "set"), code=42)
        self.assertIn("Read-only file system", refused.stderr)

    def test_rejected_recipe_does_not_block_another(self):
        out, recipe = self.folder / "refused", self.folder / "refused.textproto"
        command = [tools.PROGRAMS / "duet", "batch", "leaders", "--recipe", recipe, "--out", out,
                   "--server", self.server.address]
        recipe.write_text("output { formats: FORMAT_NPY }", encoding="utf-8")
        self.run_in_folder(*command, code=42)  # has no reactions
        recipe.write_text(RECIPE, encoding="utf-8")
        self.run_in_folder(*command)
        self.assertEqual(digests(out), digests(self.whole))
        recipe.write_text(RECIPE.replace("seed: 7", "seed: 8"), encoding="utf-8")
        result = self.run_in_folder(*command, code=42)
        self.assertIn("modified: seed: 7 -> 8", result.stderr)


if __name__ == "__main__":
    tools.main()
