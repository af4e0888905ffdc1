"""duet_motion.sets: reading, verifying, splitting and packing sets in the form of docs/batch.md.

tests/e2e/batch_test.py runs it on sets that duet batch wrote.
"""

import hashlib
import io
import json
import pathlib
import tarfile
import tempfile
import unittest
from unittest import mock

import support  # noqa: F401
import duet_motion as duet
from duet_motion import sets
from duet_motion.sets import __main__ as program
import numpy as np

JOINTS = ["root", "left", "right"]
CLASSES = ["kick", "hug"]
DESCRIPTION = {
    "format_version": 1, "items": {"done": 2, "rejected": 0, "failed": 0, "missing": 0},
    "skeletons": [{"joint_names": JOINTS, "parents": [-1, 0, 0], "root_joint": "root"}],
    "models": [{"name": "m@1", "interaction_classes": CLASSES, "skeleton": 0}],
    "interaction_classes": CLASSES, "a field of the future": 1}


def npy(array):
    file = io.BytesIO()
    np.save(file, array)
    return file.getvalue()


def digest(data):
    return hashlib.sha256(data).hexdigest()


class Item:
    """An item of a set, with positions that are distinct over all items."""

    def __init__(self, number, frames=4, rate=30.0, **more):
        self.name = f"walks/{number}-hug"
        self.pair = np.arange(2 * frames * 9, dtype=np.float32).reshape(2, frames, 3, 3) + 1000 * number
        data = npy(self.pair)
        self.record = {
            "item": number, "name": self.name, "model": "m@1", "frames": frames, "frame_rate_hz": rate, "state": "done",
            "skeleton": 0, "leader": f"walks/{number // 2}.bvh", "leader_sha256": digest(b"leader %d" % (number // 2)),
            "labels": {"hug": 1}, "files": [{"path": f"{self.name}.npy", "bytes": len(data), "sha256": digest(data)}], **more}


ITEMS = (Item(0), Item(1, 7, 15.0, labels={"kick": 0.5, "hug": -1}), Item(2))


class SetsTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        self.folder = self.root / "set"

    def write(self, items=ITEMS, description=DESCRIPTION):
        """A set, as a run would have left it."""
        for item in items:
            file = self.folder / f"{item.name}.npy"
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_bytes(npy(item.pair))
        (self.folder / "index.jsonl").write_text(
            "".join(json.dumps(item.record) + "\n" for item in items), encoding="utf-8")
        (self.folder / "dataset.json").write_text(json.dumps(description), encoding="utf-8")
        return self.folder

    def run_program(self, *words):
        out, err = io.StringIO(), io.StringIO()
        with mock.patch("sys.stdout", out), mock.patch("sys.stderr", err):
            code = program.main([str(word) for word in words])
        return code, out.getvalue(), err.getvalue()

    def rejects(self, message, index=None):
        with self.assertRaisesRegex(duet.DataSetError, message):
            reactions = duet.read_set(self.folder)
            reactions[index]  # pylint: disable=pointless-statement

    # Reading.

    def test_items_are_read(self):
        reactions = duet.read_set(self.write())
        self.assertEqual((reactions.joint_names, reactions.parents), (tuple(JOINTS), (-1, 0, 0)))
        self.assertEqual(reactions.interaction_classes, tuple(CLASSES))
        for read, wrote in zip(reactions, ITEMS, strict=True):
            self.assertEqual((read.name, read.record["item"]), (wrote.name, wrote.record["item"]))
            np.testing.assert_array_equal(read.pair, wrote.pair)
            np.testing.assert_array_equal(read.leader.positions, wrote.pair[0])
            np.testing.assert_array_equal(read.follower.positions, wrote.pair[1])
            self.assertEqual(read.leader.frame_rate_hz, wrote.record["frame_rate_hz"])
            self.assertEqual(read.follower.joint_names, tuple(JOINTS))
        self.assertEqual(reactions[-1].name, ITEMS[-1].name)
        self.assertEqual([item.name for item in reactions[1:]], [item.name for item in ITEMS[1:]])
        np.testing.assert_array_equal(reactions[0].weights, [[0, 1]] * 4)
        np.testing.assert_array_equal(reactions[1].weights, [[0.5, -1]] * 7)

    def test_items_are_resampled_to_one_rate(self):
        items = list(duet.read_set(self.write(), frame_rate_hz=30))
        self.assertEqual([item.leader.frame_rate_hz for item in items], [30] * 3)
        self.assertEqual([item.leader.frame_count for item in items], [4, 13, 4])
        np.testing.assert_array_equal(items[1].pair[:, ::2], ITEMS[1].pair)
        np.testing.assert_allclose(items[1].pair[:, 1], ITEMS[1].pair[:, :2].mean(axis=1))
        with self.assertRaisesRegex(ValueError, "frame_rate_hz: expected a finite number above 0"):
            duet.read_set(self.folder, frame_rate_hz=0)

    def test_padding_repeats_the_last_frame_and_masks_it(self):
        items = duet.read_set(self.write())[:2]
        batch = duet.pad(items)
        self.assertEqual((batch.pairs.shape, batch.pairs.dtype), ((2, 2, 7, 3, 3), np.float32))
        np.testing.assert_array_equal(batch.pairs[1], ITEMS[1].pair)
        np.testing.assert_array_equal(batch.pairs[0, :, 3:], ITEMS[0].pair[:, [3] * 4])
        np.testing.assert_array_equal(batch.mask, [[True] * 4 + [False] * 3, [True] * 7])
        self.assertEqual(batch.weights.shape, (2, 7, 2))
        cut = duet.pad(items, frames=2)
        np.testing.assert_array_equal(cut.pairs[1], ITEMS[1].pair[:, :2])
        self.assertTrue(cut.mask.all())
        for arguments, message in (([[]], "items: expected at least one, got none"),
                                   ([items, 0], "frames: expected 1 or more, got 0")):
            with self.assertRaisesRegex(ValueError, message):
                duet.pad(*arguments)

    def test_an_item_has_its_own_skeleton(self):
        other = {"joint_names": ["a", "b", "c"], "parents": [-1, 0, 1]}
        several = {**DESCRIPTION, "skeletons": [*DESCRIPTION["skeletons"], other]}
        of_item = duet.read_set(self.write([Item(0, skeleton=1)], several))
        self.assertEqual(of_item[0].leader.joint_names, ("a", "b", "c"))

    def test_missing_and_damaged_sets_are_rejected(self):
        self.rejects("set: expected a data set of duet batch, got")
        with (self.write() / "index.jsonl").open("a", encoding="utf-8") as file:
            file.write("{broken\n")
        self.rejects(r"index.jsonl: byte \d+: expected a record in JSON", 3)
        file = self.folder / f"{ITEMS[0].name}.npy"
        holes = ITEMS[0].pair.copy()
        holes[1, 2, 1, 0] = np.nan
        for data, message in ((npy(ITEMS[0].pair[0]), r"0-hug: expected the shape \(2, frames, joi"),
                              (npy(np.array([object()])), "0-hug: .*allow_pickle=False"),
                              (npy(holes), "0-hug: .*got nan at frame 2, joint 'left', x")):
            file.write_bytes(data)
            self.rejects(message, 0)
        file.unlink()
        self.rejects("walks/0-hug: expected the file .*0-hug.npy", 0)
        for description, message in (({"format_version": 2}, "format_version: expected at most 1, got 2"),
                                     ([], "dataset.json: expected a JSON object")):
            self.write(description=description)
            self.rejects(message)

    # What follows a run.

    def test_verify_names_every_kind_of_damage(self):
        folder = self.write()
        self.assertEqual(sets.verify(folder), sets.VerifyReport(3, 3, [], 0))
        (folder / "walks/0-hug.npy").unlink()
        (folder / "walks/1-hug.npy").write_bytes(npy(ITEMS[0].pair))
        (folder / "dataset.json").unlink()
        report = sets.verify(folder)
        self.assertIsNone(report.missing)
        for expected in ("0-hug.npy: no such file", "1-hug.npy: was changed", "dataset.json: expected"):
            self.assertTrue(any(expected in problem for problem in report.problems), report.problems)
        code, _, err = self.run_program("verify", folder)
        self.assertEqual(code, 42)
        self.assertIn("repeat the duet batch command with --verify", err)
        self.assertEqual(self.run_program("pack", folder, self.root / "out")[0], 42)
        self.assertFalse((self.root / "out").exists())

    def test_missing_items_are_an_exit_code_of_their_own(self):
        folder = self.write(description={**DESCRIPTION, "items": {"missing": 2}})
        self.assertEqual(self.run_program("verify", folder)[0], 1)
        self.assertEqual(self.run_program("verify", self.root)[0], 42)

    def test_items_of_a_leader_and_of_a_group_are_in_one_split(self):
        folder = self.write([Item(number, **({"group": "ann"} if number >= 30 else {})) for number in range(40)])
        self.assertEqual(len(duet.read_set(folder, split="train")), 40)  # a set without splits is for training
        counts = sets.split(folder, validation=0.2, test=0.3)
        items = {name: duet.read_set(folder, split=name) for name in counts}
        self.assertEqual({name: len(those) for name, those in items.items()}, counts)
        self.assertEqual(sum(counts.values()), 40)
        leaders = [{record.get("group", record["leader"]) for record in those.records}
                   for those in items.values()]
        self.assertEqual(sum(map(len, leaders)), len(set.union(*leaders)))
        self.assertTrue(all(leaders))
        with self.assertRaisesRegex(duet.DataSetError, "split: expected train or validation or test, got 'dev'"):
            duet.read_set(folder, split="dev")
        for shares, message in (({"validation": 0.5, "test": 0.5}, "expected less than 1 together"),
                                ({"test": -1}, "test: expected 0 or more, got -1")):
            with self.assertRaisesRegex(ValueError, message):
                sets.split(folder, **shares)

    def test_a_packed_set_is_read_like_the_set(self):
        folder = self.write([Item(number) for number in range(8)])
        sets.split(folder, test=0.5)
        for kind in ("npz", "tar"):
            with self.subTest(kind):
                out, again = self.root / f"packed-{kind}", self.root / f"again-{kind}"
                names = [sets.pack(folder, made, kind=kind, shard_bytes=2 * len(npy(ITEMS[0].pair)))
                         for made in (out, again)][0]
                self.assertGreater(len(names), 3)
                self.assertEqual(names, json.loads((out / "dataset.json").read_text())["shards"])
                for split in ("train", "test"):
                    loose, packed = duet.read_set(folder, split=split), duet.read_set(out, split=split)
                    self.assertEqual([item.name for item in packed], [item.name for item in loose])
                    np.testing.assert_array_equal(packed[0].pair, loose[0].pair)
                    self.assertTrue(all(f"-{split}-" in record["shard"] for record in packed.records))
                self.assertEqual(sets.verify(out).problems, [])
                files = sorted(path.name for path in out.iterdir())
                self.assertEqual([(out / name).read_bytes() for name in files],
                                 [(again / name).read_bytes() for name in files])
                with self.assertRaisesRegex(FileExistsError, "expected a new folder"):
                    sets.pack(folder, out, kind=kind)
                shard = out / names[0]
                data = bytearray(shard.read_bytes())
                data[len(data) // 3] ^= 1
                shard.write_bytes(data)
                self.assertIn(f"{shard}: was changed", sets.verify(out).problems)
                (out / "set-test-000000").with_suffix(f".{kind}").write_bytes(b"no archive")
                with self.assertRaisesRegex(duet.DataSetError, "File is not a zip file|truncated|invalid header"):
                    duet.read_set(out, split="test")[0]  # pylint: disable=expression-not-assigned
        with np.load(self.root / "again-npz" / "set-test-000000.npz") as arrays:
            first = json.loads(arrays["records.jsonl"].splitlines()[0])
            self.assertEqual(arrays[first["name"]].shape, (2, 4, 3, 3))
        with tarfile.open(self.root / "again-tar" / "set-test-000000.tar") as archive:
            self.assertEqual(archive.getnames()[:2], [f"{first['name']}.npy", f"{first['name']}.json"])


if __name__ == "__main__":
    unittest.main()
