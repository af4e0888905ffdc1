"""Data sets of duet batch that were damaged or made in several goes: repaired, packed and grown by the
real program, which is killed at the worst moments, to the same bytes as without all that.

    batch_repair_test.py [KILLS] [test...]     how often each kill test kills; 4
"""

import json
import os
import random
import shutil
import subprocess
import sys
import tempfile
import time

KILLS = int(sys.argv.pop(1)) if sys.argv[1:] and sys.argv[1].isdigit() else 4

import tools  # noqa: E402
from batch_test import digests, entries, rows_of  # noqa: E402

RECIPE = """
seed: 7
reactions { each_class {} }
samples: 2
output { formats: FORMAT_NPY %s }
"""
PACKINGS = {"none": "", "tar": "packing: PACKING_TAR shard_bytes: 60000",
            "npz": "packing: PACKING_NPZ shard_bytes: 60000",
            # Two of the three leaders are in the split "test" or "validation".
            "split": "packing: PACKING_TAR shard_bytes: 60000 } splits { validation: 0.4 test: 0.2"}


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
        # The set of each packing that an undisturbed run makes.
        cls.whole = {}
        for packing, output in PACKINGS.items():
            recipe = cls.folder / f"{packing}.textproto"
            recipe.write_text(RECIPE % output, encoding="utf-8")
            made = tools.run(tools.PROGRAMS / "duet", "batch", "leaders", "--recipe", recipe.name,
                             "--out", f"whole-{packing}", "--server", cls.server.address,
                             "--quiet", cwd=cls.folder)
            assert made.returncode == 0, made.stderr
            cls.whole[packing] = cls.folder / f"whole-{packing}"

    def command(self, out, packing, *flags):
        return [tools.PROGRAMS / "duet", "batch", "leaders", "--recipe", f"{packing}.textproto",
                "--out", out, "--server", self.server.address, "--quiet", *flags]

    def run_in_folder(self, *command, code=0, cwd=None):
        result = tools.run(*command, cwd=cwd or self.folder)
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        return result

    def copy_of(self, packing, name):
        """The undisturbed set under another name, and its files."""
        out = self.folder / name
        shutil.copytree(self.whole[packing], out)
        return out, sorted(path for path in out.rglob("*")
                           if path.suffix in (".npy", ".tar", ".npz"))

    def check_whole(self, out, packing):
        self.run_in_folder(tools.PROGRAMS / "duet", "batch", "verify", out)
        self.assertEqual(digests(out), digests(self.whole[packing]))

    def test_damage_found_by_verify_is_repaired(self):
        for packing in PACKINGS:
            for again in ("repair", "rerun"):
                with self.subTest(packing, again=again):
                    out, files = self.copy_of(packing, f"{packing}-{again}")
                    files[0].unlink()
                    change(files[1], files[1].stat().st_size // 2)
                    os.truncate(files[2], 1000)
                    change(out / ".duet-batch" / "journal", 3000)
                    change(out / "index.jsonl", 200)
                    change(out / "items" / "train.csv", 300)
                    (out / "README.md").unlink()
                    os.truncate(out / "dataset.json", 100)
                    found = self.run_in_folder(tools.PROGRAMS / "duet", "batch", "verify", out,
                                               code=42)
                    self.assertIn("verify --repair", found.stderr)
                    for problem in ("items/train.csv: is not what the journal says",
                                    "README.md: no such file",
                                    "dataset.json: is not what the journal says"):
                        self.assertIn(problem, found.stderr)
                    if again == "rerun":
                        self.run_in_folder(*self.command(out.name, packing))
                    else:  # the command of the last run, from wherever this is started
                        self.run_in_folder(tools.PROGRAMS / "duet", "batch", "verify", "--repair",
                                           out, cwd=tempfile.gettempdir())
                    self.check_whole(out, packing)

    def test_killed_repair_is_repeated(self):
        dice = random.Random()
        for packing in PACKINGS:
            with self.subTest(packing):
                out, files = self.copy_of(packing, f"{packing}-killed")
                for file in files[::2]:
                    change(file, file.stat().st_size // 2)
                files[1].unlink()
                command = [tools.PROGRAMS / "duet", "batch", "verify", "--repair", out]
                seconds = []
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
                self.check_whole(out, packing)

    def test_killed_packing_is_repeated(self):
        for packing, first, middle in (("tar", "set-000000.tar", "set-000004.tar"),
                                       ("npz", "set-000000.npz", "set-000004.npz"),
                                       ("split", "set-validation-000000.tar",
                                        "set-test-000004.tar")):
            # The list of shards, the first shard, one in the middle; all of them and no index; the
            # first table and no index.
            for moment in (".duet-batch/shards", first, middle, "contact_sheet.html",
                           "items/train.csv"):
                with self.subTest(packing, moment=moment):
                    out = self.folder / f"{packing}-{moment.replace('/', '_')}"
                    client = subprocess.Popen(self.command(out.name, packing), cwd=self.folder)
                    while not (out / moment).exists() and client.poll() is None:
                        time.sleep(0.0005)
                    client.kill()
                    client.wait()
                    self.run_in_folder(*self.command(out.name, packing))
                    self.check_whole(out, packing)

    def test_items_of_a_mended_leader_go_to_a_new_shard(self):
        for packing in ("tar", "npz"):
            with self.subTest(packing):
                out, mended = self.folder / f"{packing}-mended", self.folder / f"{packing}.bvh"
                manifest = self.folder / f"{packing}.tsv"
                manifest.write_text(f"leader\n{self.leaders / 'hug.bvh'}\n{mended}\n"
                                    f"{self.leaders / 'kick.bvh'}\n", encoding="utf-8")
                command = [tools.PROGRAMS / "duet", "batch", "--manifest", manifest, "--recipe",
                           f"{packing}.textproto", "--out", out, "--server", self.server.address]
                result = self.run_in_folder(*command, code=42)
                self.assertIn("the shards leave out the 12 failed items", result.stderr)
                before = {name: digest for name, digest in digests(out).items()
                          if name.startswith("set-")}
                self.assertEqual(len(entries(out)), 24)
                self.run_in_folder(tools.PROGRAMS / "duet", "batch", "verify", out)
                shutil.copy(tools.sample("push"), mended)
                self.run_in_folder(*command, "--retry-failed")
                self.assertEqual(len(rows_of(out)), 36)
                after = digests(out)
                self.assertEqual({name: after[name] for name in before}, before)
                index = entries(out)
                self.assertEqual([entry["item"] for entry in index], list(range(36)))
                self.assertTrue(all(entry["shard"] not in before for entry in index[12:24]))
                self.run_in_folder(tools.PROGRAMS / "duet", "batch", "verify", out)
                change(out / index[12]["shard"], 2000)
                self.run_in_folder(tools.PROGRAMS / "duet", "batch", "verify", "--repair", out)
                self.assertEqual(digests(out), after)

    def test_changed_leader_is_rejected(self):
        for packing in PACKINGS:
            with self.subTest(packing):
                leaders, out = self.folder / f"{packing}-leaders", self.folder / f"{packing}-other"
                shutil.copytree(self.leaders, leaders)
                command = [tools.PROGRAMS / "duet", "batch", leaders, "--recipe",
                           f"{packing}.textproto", "--out", out, "--server", self.server.address]
                self.run_in_folder(*command, "--limit", "15")
                journal = (out / ".duet-batch" / "journal").read_bytes()
                with (leaders / "hug.bvh").open("a", encoding="utf-8") as file:
                    file.write("\n")
                result = self.run_in_folder(*command, code=42)
                self.assertIn(f"leader {leaders / 'hug.bvh'}: expected the file", result.stderr)
                self.assertEqual((out / ".duet-batch" / "journal").read_bytes(), journal)
                shutil.copy(tools.sample("hug"), leaders)
                self.run_in_folder(*command)
                self.run_in_folder(tools.PROGRAMS / "duet", "batch", "verify", out)

    def test_a_damaged_identity_says_how_to_go_on(self):
        for packing in PACKINGS:
            with self.subTest(packing):
                out, _ = self.copy_of(packing, f"{packing}-identity")
                job = out / ".duet-batch" / "job.json"
                os.truncate(job, job.stat().st_size // 2)
                command = self.command(out.name, packing)
                for damaged in (command, [tools.PROGRAMS / "duet", "batch", "verify", out]):
                    refused = self.run_in_folder(*damaged, code=42)
                    self.assertIn(f"{job.relative_to(self.folder)}: is damaged: ", refused.stderr)
                    self.assertIn("delete it and run the command that made the set again",
                                  refused.stderr)
                job.unlink()
                other = list(command)
                other[other.index(f"{packing}.textproto")] = "other.textproto"
                (self.folder / "other.textproto").write_text(
                    (self.folder / f"{packing}.textproto").read_text(encoding="utf-8").replace(
                        "seed: 7", "seed: 8"), encoding="utf-8")
                refused = self.run_in_folder(*other, code=42)
                self.assertIn('was begun with another recipe: seed: expected "7", got "8"',
                              refused.stderr)
                self.run_in_folder(*command)
                self.check_whole(out, packing)

    def test_places_that_cannot_be_written_are_no_reason_to_try_again(self):
        loop, closed = self.folder / "loop", self.folder / "closed"
        loop.symlink_to(loop)
        closed.mkdir()
        refused = self.run_in_folder(*self.command(loop, "none"), code=42)
        self.assertIn("Too many levels of symbolic links", refused.stderr)
        # In a mount namespace of its own, where the system permits one.
        read_only = ["unshare", "-rm", "sh", "-c", 'mount --bind "$0" "$0" && '
                     'mount -o remount,bind,ro "$0" && exec "$@"', closed]
        if not shutil.which("unshare") or tools.run(*read_only, "true").returncode != 0:
            self.skipTest("no read-only mount")
        refused = self.run_in_folder(*read_only, *self.command(closed / "set", "none"), code=42)
        self.assertIn("Read-only file system", refused.stderr)

    def test_rejected_recipe_does_not_block_another(self):
        out, recipe = self.folder / "refused", self.folder / "refused.textproto"
        command = [tools.PROGRAMS / "duet", "batch", "leaders", "--recipe", recipe, "--out", out,
                   "--server", self.server.address]
        recipe.write_text("output { formats: FORMAT_NPY }", encoding="utf-8")
        self.run_in_folder(*command, code=42)  # has no reactions
        recipe.write_text(RECIPE % "", encoding="utf-8")
        self.run_in_folder(*command)
        self.assertEqual(digests(out), digests(self.whole["none"]))
        recipe.write_text(RECIPE.replace("seed: 7", "seed: 8") % "", encoding="utf-8")
        result = self.run_in_folder(*command, code=42)
        self.assertIn('seed: expected "7", got "8"', result.stderr)

    def test_ids_that_are_invalid_file_names_are_kept(self):
        out, manifest = self.folder / "long", self.folder / "long.jsonl"
        lines = [{"id": "x" * 300, "leader": str(self.leaders / "hug.bvh")},
                 {"id": "a/" * 3000 + "b", "leader": str(self.leaders / "hug.bvh")}]
        manifest.write_text("\n".join(map(json.dumps, lines)), encoding="utf-8")
        for packing in PACKINGS:
            with self.subTest(packing):
                command = [tools.PROGRAMS / "duet", "batch", "--manifest", manifest, "--recipe",
                           f"{packing}.textproto", "--out", f"{out}-{packing}", "--server",
                           self.server.address]
                self.run_in_folder(*command)
                index = entries(self.folder / f"long-{packing}")
                self.assertEqual(len(index), 24)
                self.assertTrue(index[0]["full_name"].startswith("x" * 300))
                self.run_in_folder(tools.PROGRAMS / "duet", "batch", "verify", f"{out}-{packing}")

    def test_shards_of_a_job_are_repaired_and_merged(self):
        out = self.folder / "merged"
        for index in range(2):
            self.run_in_folder(*self.command(out.name, "tar", "--shard", f"{index}/2"))
        change(out / "shard-1-of-2" / ".duet-batch" / "spool", 1000)
        refused = self.run_in_folder(tools.PROGRAMS / "duet", "batch", "merge", out, code=1)
        self.assertIn("was changed", refused.stderr)
        self.run_in_folder(tools.PROGRAMS / "duet", "batch", "verify", "--repair",
                           out / "shard-1-of-2", cwd=tempfile.gettempdir())
        self.run_in_folder(tools.PROGRAMS / "duet", "batch", "merge", out)
        self.check_whole(out, "tar")


if __name__ == "__main__":
    tools.main()
