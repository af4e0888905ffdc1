"""What follows a run of duet batch: verify, split and pack.

tests/e2e/batch_test.py runs them on sets that duet batch wrote.
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

JOINTS = {"joint_names": ["hips", "head"], "parents": [-1, 0], "root_joint": "hips"}
CLASSES = ["kick", "hug"]
MADE_BY = {"cleaned_up": True, "engine": "cpu, bf16, AVX2", "server_version": "1.0.0"}


def digest(data):
    return hashlib.sha256(data).hexdigest()


def npy(number):
    file = io.BytesIO()
    np.save(file, np.arange(2 * 3 * 2 * 3, dtype=np.float32).reshape(2, 3, 2, 3) + number)
    return file.getvalue()


def record_of(number, state="done", **more):
    record = {"item": number, "id": digest(b"%d" % number)[:32], "state": state,
              "name": f"walks/{number}-hug", "leader": f"walks/{number // 2}.bvh",
              "leader_sha256": digest(b"leader %d" % (number // 2)), "side": "left", "reaction": "hug"}
    if state == "failed":
        del record["leader_sha256"]
        return {**record, "error": {"code": "NOT_FOUND", "message": "no\tsuch file"}, **more}
    record.update(labels={"hug": 1.0}, model="m@1", seed=number, frames=3, frame_rate_hz=30.0, skeleton=0,
                  quality={"distance_metres": 1.0}, answers=1, **MADE_BY)
    if state == "rejected":
        return {**record, "reasons": ["too far"], **more}
    return {**record, "files": [{"path": f"walks/{number}-hug.npy", "bytes": len(npy(number)),
                                 "sha256": digest(npy(number))}], **more}


class SetToolsTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)

    def write(self, name, records, missing=0):
        """A set of these records, as a run would have left it."""
        folder = self.root / name
        folder.mkdir(parents=True)
        for record in records:
            for file in record.get("files", ()):
                path = folder / file["path"]
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_bytes(npy(record["item"]))
        of_state = {state: [record for record in records if record["state"] == state]
                    for state in ("done", "rejected", "failed")}
        counts = {state: len(those) for state, those in of_state.items()}
        done = of_state["done"]
        files = {
            "index.jsonl": "".join(json.dumps(record, separators=(",", ":")) + "\n" for record in done),
            "dataset.json": sets.shards.to_json({
                "format": "duet-batch", "format_version": 1, "recipe_sha256": "ab",
                "items": {**counts, "missing": missing}, "frames": 3 * len(done),
                **({"frame_rate_hz": 30.0} if done else {}),
                "frame_rates": [{"frame_rate_hz": 30.0, "items": len(done)}] if done else [],
                "skeletons": [JOINTS],
                "models": [{"name": "m@1", "terms": "For\nall <uses>.", "free_for_all_uses": True,
                            "interaction_classes": CLASSES, "skeleton": 0, **(MADE_BY if done else {})}],
                "interaction_classes": CLASSES})}
        for path, text in files.items():
            (folder / path).write_text(text, encoding="utf-8")
        return folder

    def tree(self, folder):
        return {str(path.relative_to(folder)): path.read_bytes() for path in sorted(folder.rglob("*"))
                if path.is_file()}

    def run_program(self, *words):
        out, err = io.StringIO(), io.StringIO()
        with mock.patch("sys.stdout", out), mock.patch("sys.stderr", err):
            code = program.main([str(word) for word in words])
        return code, out.getvalue(), err.getvalue()

    def test_verify_names_every_kind_of_damage(self):
        folder = self.write("set", [record_of(number) for number in range(3)])
        self.assertEqual(sets.verify(folder), sets.VerifyReport(3, 3, [], 0))
        (folder / "walks/0-hug.npy").unlink()
        (folder / "walks/1-hug.npy").write_bytes(npy(7))
        (folder / "dataset.json").unlink()
        report = sets.verify(folder)
        self.assertIsNone(report.missing)
        for expected in ("0-hug.npy: no such file", "1-hug.npy: was changed", "dataset.json: expected"):
            with self.subTest(expected):
                self.assertTrue(any(expected in problem for problem in report.problems), report.problems)
        code, _, err = self.run_program("verify", folder)
        self.assertEqual(code, 42)
        self.assertIn("repeat the duet batch command with --verify", err)

    def test_missing_items_are_an_exit_code_of_their_own(self):
        folder = self.write("set", [record_of(0)], missing=2)
        self.assertEqual(self.run_program("verify", folder)[0], 1)
        self.assertEqual(self.run_program("verify", self.root)[0], 42)

    def test_items_of_a_leader_and_of_a_group_are_in_one_split(self):
        records = [record_of(number) for number in range(40)]
        for record in records[30:]:
            record["group"] = "ann"
        folder = self.write("set", records)
        counts = sets.split(folder, validation=0.2, test=0.3)
        self.assertEqual(sum(counts.values()), 40)
        items = {name: duet.read_set(folder, split=name) for name in counts}
        self.assertEqual({name: len(those) for name, those in items.items()}, counts)
        leaders = [{record.get("group", record["leader"]) for record in those.records}
                   for those in items.values()]
        self.assertEqual(sum(map(len, leaders)), len(set.union(*leaders)))
        self.assertTrue(all(leaders))
        with self.assertRaisesRegex(ValueError, "expected less than 1 together"):
            sets.split(folder, validation=0.5, test=0.5)
        with self.assertRaisesRegex(ValueError, "test: expected 0 or more, got -1"):
            sets.split(folder, test=-1)

    def test_a_packed_set_is_read_like_the_set(self):
        folder = self.write("set", [record_of(number) for number in range(8)])
        sets.split(folder, test=0.5)
        for kind in ("npz", "tar"):
            with self.subTest(kind):
                out = self.root / f"packed-{kind}"
                names = sets.pack(folder, out, kind=kind, shard_bytes=2 * len(npy(0)))
                self.assertGreater(len(names), 3)
                self.assertEqual(names, json.loads((out / "dataset.json").read_text())["shards"])
                for split in ("train", "test"):
                    loose, packed = duet.read_set(folder, split=split), duet.read_set(out, split=split)
                    self.assertEqual([item.name for item in packed], [item.name for item in loose])
                    np.testing.assert_array_equal(packed[0].pair, loose[0].pair)
                    self.assertTrue(all(f"-{split}-" in record["shard"] for record in packed.records))
                self.assertEqual(sets.verify(out).problems, [])
                again = self.root / f"again-{kind}"
                sets.pack(folder, again, kind=kind, shard_bytes=2 * len(npy(0)))
                self.assertEqual(self.tree(out), self.tree(again))
                shard = out / names[0]
                data = bytearray(shard.read_bytes())
                data[len(data) // 3] ^= 1
                shard.write_bytes(data)
                self.assertIn(f"{shard}: was changed", sets.verify(out).problems)
                with self.assertRaisesRegex(FileExistsError, "expected a new folder"):
                    sets.pack(folder, out, kind=kind)
        with np.load(self.root / "again-npz" / "set-test-000000.npz") as arrays:
            first = json.loads(arrays["records.jsonl"].splitlines()[0])
            self.assertEqual(arrays[first["name"]].shape, (2, 3, 2, 3))
        with tarfile.open(self.root / "again-tar" / "set-test-000000.tar") as archive:
            self.assertEqual(archive.getnames()[:2], [f"{first['name']}.npy", f"{first['name']}.json"])

    def test_a_changed_file_is_not_packed(self):
        folder = self.write("set", [record_of(0), record_of(1)])
        (folder / "walks/1-hug.npy").write_bytes(npy(5))
        self.assertEqual(self.run_program("pack", folder, self.root / "out")[0], 42)
        self.assertFalse((self.root / "out").exists())


if __name__ == "__main__":
    unittest.main()
