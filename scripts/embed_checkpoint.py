#!/usr/bin/env python3
"""Copies a trained checkpoint to model/embedded, with its terms of use.

    scripts/embed_checkpoint.py FOLDER NAME/VERSION [--terms TEXT] [--free]

FOLDER has a manifest.json and the weights that it names. --terms states the permitted uses; it may be absent
if the manifest states them. --free marks the weights as free for all uses. The copy replaces a checkpoint of
the same name and version. A new one also needs its name in model/embedded/CMakeLists.txt and its card in
model/embedded/README.md."""

import argparse
import hashlib
import json
import pathlib
import re
import shutil
import sys

EMBEDDED = pathlib.Path(__file__).resolve().parent.parent / "model" / "embedded"
WEIGHTS = "weights.safetensors"


def place_of(text):
    match = re.fullmatch(r"([A-Za-z0-9_-][A-Za-z0-9._-]{0,63})/([1-9][0-9]*)", text)
    if match is None:
        raise argparse.ArgumentTypeError(f'expected NAME/VERSION, such as salsa/1, got "{text}"')
    return match[1], int(match[2])


def with_terms(manifest, name, version, terms, free):
    """The manifest under a name and version, with its terms behind the description."""
    changed = {}
    for key, value in manifest.items():
        if key in ("terms", "free_for_all_uses"):
            continue
        changed[key] = {"name": name, "version": version}.get(key, value)
        if key == "description":
            changed["terms"] = terms
            if free:
                changed["free_for_all_uses"] = True
    changed["weights"] = {**manifest["weights"], "file": WEIGHTS}
    return changed


def embed(folder, place, terms, free, embedded=EMBEDDED):
    """Copies the checkpoint. Returns its new folder. Raises ValueError."""
    manifest = json.loads((folder / "manifest.json").read_text(encoding="utf-8"))
    weights = folder / manifest["weights"]["file"]
    digest = hashlib.sha256(weights.read_bytes()).hexdigest()
    if digest != manifest["weights"]["sha256"]:
        raise ValueError(f"{weights}: expected SHA-256 {manifest['weights']['sha256']}, got {digest}")
    terms = terms or manifest.get("terms")
    if not terms:
        raise ValueError("--terms: expected the permitted uses, which the manifest does not state, got none")
    target = embedded.joinpath(place[0], str(place[1]))
    target.mkdir(parents=True, exist_ok=True)
    shutil.copyfile(weights, target / WEIGHTS)
    text = json.dumps(with_terms(manifest, *place, terms, free), indent=1, ensure_ascii=False)
    (target / "manifest.json").write_text(text + "\n", encoding="utf-8")
    return target


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("folder", type=pathlib.Path, help="checkpoint with manifest.json and weights")
    parser.add_argument("place", type=place_of, metavar="NAME/VERSION", help="such as salsa/1")
    parser.add_argument("--terms", help="permitted uses of the weights and of their output")
    parser.add_argument("--free", action="store_true", help="anybody may use them for any purpose")
    flags = parser.parse_args()
    try:
        target = embed(flags.folder, flags.place, flags.terms, flags.free)
    except (OSError, KeyError, ValueError) as error:
        sys.exit(f"embed_checkpoint: {error}")
    print(f"wrote {target}")
    if "/".join(map(str, flags.place)) not in (EMBEDDED / "CMakeLists.txt").read_text():
        print("next: add it to model/embedded/CMakeLists.txt and model/embedded/README.md")


if __name__ == "__main__":
    main()
