"""Tests of embed_checkpoint.py."""

import argparse
import hashlib
import json
import pathlib
import tempfile
import unittest

import embed_checkpoint

TERMS = "Free for all uses."


class EmbedCheckpointTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        self.trained = self.root / "trained"
        self.trained.mkdir()
        (self.trained / "w.safetensors").write_bytes(b"weights")
        self.manifest = {"format_version": 2, "name": "studio", "version": 7, "description": "A.",
                         "created": "2026-01-02T03:04:05Z", "frame_rate_hz": 30.0,
                         "weights": {"file": "w.safetensors", "bytes": 7,
                                     "sha256": hashlib.sha256(b"weights").hexdigest()}}

    def embed(self, terms=TERMS, free=True):
        (self.trained / "manifest.json").write_text(json.dumps(self.manifest), encoding="utf-8")
        target = embed_checkpoint.embed(self.trained, ("salsa", 1), terms, free, self.root / "to")
        return target, json.loads((target / "manifest.json").read_text(encoding="utf-8"))

    def test_copies_under_the_new_name_with_terms(self):
        target, manifest = self.embed()
        self.assertEqual(target, self.root / "to/salsa/1")
        self.assertEqual((target / "weights.safetensors").read_bytes(), b"weights")
        self.assertEqual(manifest, {
            **self.manifest, "name": "salsa", "version": 1, "terms": TERMS,
            "free_for_all_uses": True,
            "weights": {**self.manifest["weights"], "file": "weights.safetensors"}})

    def test_keeps_the_terms_of_the_manifest_but_needs_some(self):
        with self.assertRaisesRegex(ValueError, "--terms: expected"):
            self.embed(terms=None)
        self.manifest["terms"] = "For the studio."
        self.assertEqual(self.embed(terms=None)[1]["terms"], "For the studio.")

    def test_rejects_other_weights(self):
        self.manifest["weights"]["sha256"] = "0" * 64
        with self.assertRaisesRegex(ValueError, "expected SHA-256 0000"):
            self.embed()
        self.assertFalse((self.root / "to").exists())

    def test_place_is_a_name_and_a_version(self):
        self.assertEqual(embed_checkpoint.place_of("salsa/12"), ("salsa", 12))
        for text in ("salsa", "salsa/0", "salsa/01", "../salsa/1", "salsa/1/2"):
            with self.assertRaises(argparse.ArgumentTypeError, msg=text):
                embed_checkpoint.place_of(text)

    def test_embedded_manifests_keep_their_form(self):
        for file in embed_checkpoint.EMBEDDED.glob("*/*/manifest.json"):
            text = file.read_text(encoding="utf-8")
            manifest = json.loads(text)
            kept = embed_checkpoint.with_terms(manifest, manifest["name"], manifest["version"],
                                               manifest["terms"],
                                               manifest.get("free_for_all_uses", False))
            self.assertEqual(json.dumps(kept, indent=1, ensure_ascii=False) + "\n", text, file)


if __name__ == "__main__":
    unittest.main()
