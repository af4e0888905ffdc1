#!/usr/bin/env python3
"""Writes files/text_z_up_24.fbx, FBX as text, with assimp's exporter (package assimp-utils, 5.2).

    tests/formats/fbx/make_text_file.py

It has the motion of files/metres_z_up_24.fbx. assimp 5.2 writes a second between frames; this script changes
that to the file's rate.
"""

import pathlib
import re
import subprocess
import tempfile

FILES = pathlib.Path(__file__).resolve().parent / "files"
SECOND, RATE_HZ = 46186158000, 24


def at_rate(keys):
    """The times of some keys, at the file's rate."""
    return re.sub(r"\d+", lambda time: str(round(int(time[0]) / RATE_HZ)), keys[0])


def main():
    with tempfile.TemporaryDirectory() as folder:
        exported = pathlib.Path(folder) / "text.fbx"
        subprocess.run(["assimp", "export", FILES / "metres_z_up_24.fbx", exported, "-ffbxa"], check=True,
                       stdout=subprocess.DEVNULL)
        text = exported.read_text(encoding="utf-8")
    text, count = re.subn(rf"(?<=a: )0,{SECOND}(,\d+)*(?=\n)", at_rate, text)
    assert count > 0, "no times of keys"
    (FILES / "text_z_up_24.fbx").write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
