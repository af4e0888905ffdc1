"""duet batch on machines that are taken away, with copies of its shards as the only storage that outlives
them (docs/guides/object_storage.md).
"""

import random
import shutil
import signal
import subprocess

import tools
from batch_test import digests

RECIPE = """
seed: 7
reactions { each_class {} }
reactions { mixes { count: 6 } }
samples: 2
output { formats: FORMAT_NPY }
"""
JOURNAL = ".duet-batch/journal"
SHARDS = 2
MACHINES = 4  # of each shard that are taken away


def copy(source, target, files):
    """Copies all files but the journal, and then the journal: at most `files` of them."""
    names = sorted((path.relative_to(source).as_posix() for path in source.rglob("*") if path.is_file()),
                   key=lambda name: (name == JOURNAL, name))
    names = [name for name in names if "/lock" not in name and "/tmp/" not in name]
    for name in names[:files]:
        (target / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(source / name, target / name)
    return files is None or files >= len(names)


class ObjectStorageTest(tools.ServedTest):
    def command(self, recipe, out, *flags):
        return [tools.PROGRAMS / "duet", "batch", self.leaders, "--recipe", recipe, "--out", out,
                "--server", self.server.address, "--quiet", *flags]

    def slice(self, recipe, machine, shard, seconds):
        """Runs a shard until it ends or is told to, and returns the exit code."""
        process = subprocess.Popen(self.command(recipe, machine, "--shard", f"{shard}/{SHARDS}"))
        try:
            process.wait(seconds)
        except subprocess.TimeoutExpired:
            process.send_signal(signal.SIGTERM)
        return process.wait(tools.RUN_SECONDS)

    def test_sets_survive_machines_that_are_taken_away(self):
        type(self).leaders = self.folder / "leaders"
        self.leaders.mkdir()
        for name in ("kick", "hug", "push"):
            shutil.copy(tools.sample(name), self.leaders)
        dice = random.Random()
        recipe, whole, joined = (self.folder / name for name in ("recipe.textproto", "whole", "joined"))
        recipe.write_text(RECIPE, encoding="utf-8")
        self.assertEqual(tools.run(*self.command(recipe, whole)).returncode, 0)
        for shard in range(SHARDS):
            self.make_shard(recipe, shard, self.folder / "bucket", dice)
            name = f"shard-{shard}-of-{SHARDS}"
            copy(self.folder / "bucket" / name, joined / name, None)
        result = tools.run(*self.command(recipe, joined, "--verify"))
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(digests(joined), digests(whole))

    def make_shard(self, recipe, shard, bucket, dice):
        name = f"shard-{shard}-of-{SHARDS}"
        for number in range(100):
            machine = self.folder / f"machine-{shard}-{number}"
            if (bucket / name).exists():
                copy(bucket / name, machine / name, None)
            last = number >= MACHINES
            code = self.slice(recipe, machine, shard, None if last else dice.uniform(0.02, 0.3))
            self.assertIn(code, (0, 1, -signal.SIGTERM))
            if not (machine / name).exists():
                continue
            # The machine is lost while it copies, unless it is the last one.
            files = None if last else dice.randrange(1, 12)
            if copy(machine / name, bucket / name, files) and code == 0:
                return
        self.fail("the shard was never settled")


if __name__ == "__main__":
    tools.main()
