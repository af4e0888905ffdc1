"""duet_motion.read_set on data sets that the tests write in the form of docs/batch.md."""

import io
import json
import pathlib
import tarfile
import tempfile
import unittest

import support  # noqa: F401
import duet_motion as duet
import numpy as np

JOINTS = ["root", "left", "right"]
CLASSES = ["kick", "hug"]
DESCRIPTION = {
    "format_version": 1, "items": {"done": 2, "rejected": 0, "failed": 0, "missing": 0},
    "skeletons": [{"joint_names": JOINTS, "parents": [-1, 0, 0], "root_joint": "root"}],
    "models": [{"name": "m@1", "interaction_classes": CLASSES, "skeleton": 0}],
    "interaction_classes": CLASSES, "a field of the future": 1}


def pair_of(number, frames):
    """Positions that are distinct over all items."""
    return np.arange(2 * frames * 9, dtype=np.float32).reshape(2, frames, 3, 3) + 1000 * number


def npy(array):
    file = io.BytesIO()
    np.save(file, array)
    return file.getvalue()


class Item:
    def __init__(self, number, frames, rate, **asked):
        self.name, self.pair = f"walks/{number}-hug", pair_of(number, frames)
        self.record = {"item": number, "name": self.name, "model": "m@1", "frames": frames,
                       "frame_rate_hz": rate, "state": "done", "skeleton": 0,
                       **(asked or {"labels": {"hug": 1}}),
                       "files": [{"path": f"{self.name}.npy", "bytes": 1, "sha256": ""}]}


ITEMS = (Item(0, 4, 30.0), Item(1, 7, 15.0, labels={"kick": 0.5, "hug": -1}),
         Item(2, 4, 30.0))


class SetsTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name) / "set"

    def write(self, packing="none", items=ITEMS, description=DESCRIPTION, **changes):
        self.folder.mkdir(exist_ok=True)
        getattr(self, f"_write_{packing}")(items)
        shard = {} if packing == "none" else {"shard": f"set-000000.{packing}"}
        (self.folder / "index.jsonl").write_text("".join(
            json.dumps({**item.record, **shard, **changes}) + "\n" for item in items),
            encoding="utf-8")
        if description is not None:
            (self.folder / "dataset.json").write_text(json.dumps(description), encoding="utf-8")
        return self.folder

    def _write_none(self, items):
        for item in items:
            file = self.folder / f"{item.name}.npy"
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_bytes(npy(item.pair))

    def _write_npz(self, items):
        np.savez(self.folder / "set-000000.npz", **{item.name: item.pair for item in items})

    def _write_tar(self, items):
        with tarfile.open(self.folder / "set-000000.tar", "w") as archive:
            for item in items:
                for ending, data in ((".npy", npy(item.pair)),
                                     (".json", json.dumps(item.record).encode())):
                    member = tarfile.TarInfo(item.name + ending)
                    member.size = len(data)
                    archive.addfile(member, io.BytesIO(data))

    def test_split_selects_its_items(self):
        self.write()
        index = self.folder / "index.jsonl"
        lines = [json.loads(line) for line in index.read_text(encoding="utf-8").splitlines()]
        for line, split in zip(lines, ("train", "test", "train")):
            line["split"] = split
        index.write_text("".join(json.dumps(line) + "\n" for line in lines), encoding="utf-8")
        (self.folder / "dataset.json").write_text(
            json.dumps({**DESCRIPTION, "splits": [{"name": "train"}, {"name": "test"}]}),
            encoding="utf-8")
        train = duet.read_set(self.folder, split="train")
        self.assertEqual([item.name for item in train], [ITEMS[0].name, ITEMS[2].name])
        self.assertEqual(train[-1].name, ITEMS[2].name)
        self.assertEqual([item.name for item in duet.read_set(self.folder, split="test")],
                         [ITEMS[1].name])
        self.assertEqual(len(duet.read_set(self.folder)), 3)
        with self.assertRaisesRegex(duet.DataSetError, "split: expected train or test, got 'dev'"):
            duet.read_set(self.folder, split="dev")

    def test_set_without_splits_is_for_training(self):
        self.write()
        self.assertEqual(len(duet.read_set(self.folder, split="train")), len(ITEMS))
        with self.assertRaises(duet.DataSetError):
            duet.read_set(self.folder, split="test")

    def test_every_packing_is_read_alike(self):
        for packing in ("none", "npz", "tar"):
            with self.subTest(packing=packing):
                reactions = duet.read_set(self.write(packing))
                self.assertEqual(len(reactions), 3)
                self.assertEqual((reactions.joint_names, reactions.parents),
                                 (tuple(JOINTS), (-1, 0, 0)))
                self.assertEqual(reactions.interaction_classes, tuple(CLASSES))
                for read, wrote in zip(reactions, ITEMS):
                    self.assertEqual((read.name, read.record["item"]),
                                     (wrote.name, wrote.record["item"]))
                    np.testing.assert_array_equal(read.pair, wrote.pair)
                    np.testing.assert_array_equal(read.leader.positions, wrote.pair[0])
                    np.testing.assert_array_equal(read.follower.positions, wrote.pair[1])
                    self.assertEqual(read.leader.frame_rate_hz, wrote.record["frame_rate_hz"])
                    self.assertEqual(read.follower.joint_names, tuple(JOINTS))
                self.assertEqual(reactions[-1].name, ITEMS[-1].name)
                self.assertEqual([item.name for item in reactions[1:]],
                                 [item.name for item in ITEMS[1:]])

    def test_weights_are_label_vectors_of_each_frame(self):
        plain, mixed, _ = duet.read_set(self.write())
        np.testing.assert_array_equal(plain.weights, [[0, 1]] * 4)
        np.testing.assert_array_equal(mixed.weights, [[0.5, -1]] * 7)

    def test_items_are_resampled_to_one_rate(self):
        items = list(duet.read_set(self.write("npz"), frame_rate_hz=30))
        self.assertEqual([item.leader.frame_rate_hz for item in items], [30] * 3)
        self.assertEqual([item.leader.frame_count for item in items], [4, 13, 4])
        np.testing.assert_array_equal(items[1].pair[:, ::2], ITEMS[1].pair)
        np.testing.assert_allclose(items[1].pair[:, 1], ITEMS[1].pair[:, :2].mean(axis=1))
        half = duet.read_set(self.folder, frame_rate_hz=15)[2]
        np.testing.assert_array_equal(half.weights, [[0, 1]] * 3)
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
        self.assertEqual([record["item"] for record in batch.records], [0, 1])
        cut = duet.pad(items, frames=2)
        np.testing.assert_array_equal(cut.pairs[1], ITEMS[1].pair[:, :2])
        self.assertTrue(cut.mask.all())
        with self.assertRaisesRegex(ValueError, "items: expected at least one, got none"):
            duet.pad([])
        with self.assertRaisesRegex(ValueError, "frames: expected 1 or more, got 0"):
            duet.pad(items, frames=0)

    def test_an_item_has_its_own_skeleton(self):
        other = {"joint_names": ["a", "b", "c"], "parents": [-1, 0, 1]}
        several = {**DESCRIPTION, "skeletons": [*DESCRIPTION["skeletons"], other]}
        of_item = duet.read_set(self.write(items=ITEMS[:1], description=several, skeleton=1))
        self.assertEqual(of_item[0].leader.joint_names, ("a", "b", "c"))

    def test_missing_and_damaged_sets_are_rejected(self):
        with self.assertRaisesRegex(duet.DataSetError, "set: expected a data set of duet batch, got"):
            duet.read_set(self.folder)
        self.write("npz")
        (self.folder / "set-000000.npz").unlink()
        with self.assertRaisesRegex(duet.DataSetError, "walks/0-hug: expected the file .*000.npz"):
            duet.read_set(self.folder)[0]
        self.write("npz", items=ITEMS[:1])
        with (self.folder / "index.jsonl").open("a", encoding="utf-8") as file:
            file.write(json.dumps({**ITEMS[1].record, "shard": "set-000000.npz"}) + "\n{broken\n")
        reactions = duet.read_set(self.folder)
        with self.assertRaisesRegex(duet.DataSetError, "expected the array 'walks/1-hug.npy', got no"):
            reactions[1]
        with self.assertRaisesRegex(duet.DataSetError, r"index.jsonl: byte \d+: expected a record in JSON"):
            reactions[2]
        with self.assertRaises(IndexError):
            reactions[3]
        (self.folder / "set-000000.npz").write_bytes(b"no zip")
        with self.assertRaisesRegex(duet.DataSetError, "walks/0-hug: File is not a zip file"):
            duet.read_set(self.folder)[0]
        self.write(description={"format_version": 2})
        with self.assertRaisesRegex(duet.DataSetError, "format_version: expected at most 1, got 2"):
            duet.read_set(self.folder)
        self.write(description=[])
        with self.assertRaisesRegex(duet.DataSetError, "dataset.json: expected a JSON object"):
            duet.read_set(self.folder)

    def test_arrays_are_checked(self):
        self.write()
        file = self.folder / f"{ITEMS[0].name}.npy"
        file.write_bytes(npy(ITEMS[0].pair[0]))
        with self.assertRaisesRegex(duet.DataSetError, r"0-hug: expected the shape \(2, frames, joi"):
            duet.read_set(self.folder)[0]
        file.write_bytes(npy(np.array([object()])))
        with self.assertRaisesRegex(duet.DataSetError, "0-hug: .*allow_pickle=False"):
            duet.read_set(self.folder)[0]
        holes = ITEMS[0].pair.copy()
        holes[1, 2, 1, 0] = np.nan
        file.write_bytes(npy(holes))
        with self.assertRaisesRegex(duet.DataSetError, "0-hug: .*got nan at frame 2, joint 'left', x"):
            duet.read_set(self.folder)[0]


if __name__ == "__main__":
    unittest.main()
