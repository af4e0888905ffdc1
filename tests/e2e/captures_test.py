"""Every SBU sequence of the six classes through the real client and server, if the data is available.

Looks in $DUET_DATA_DIR, else in ../shared/data beside the repository.
"""

import csv
import os
import pathlib
import tempfile
import unittest

import tools

CLASS_OF_FOLDER = {"03": "kick", "04": "push", "05": "shake_hands", "06": "hug",
                   "07": "exchange_object", "08": "punch"}


def find_sbu():
    data = os.environ.get("DUET_DATA_DIR") or tools.SOURCE.parent / "shared" / "data"
    sbu = pathlib.Path(data) / "sbu"
    if not (sbu / "index.tsv").is_file():
        tools.skip(f"no SBU Kinect Interaction data in {sbu}; set DUET_DATA_DIR")
    return sbu


def sequences(sbu):
    """(file, class, leader's side) of every sequence of the six classes."""
    with open(sbu / "index.tsv", encoding="utf-8", newline="") as index:
        for row in csv.reader(index, delimiter="\t"):
            name = CLASS_OF_FOLDER.get(row[2]) if len(row) > 6 else None
            if name:
                yield sbu / row[0], name, row[6]


class CapturesTest(unittest.TestCase):
    def test_every_sequence_is_answered(self):
        failures, count = [], 0
        with tools.running_server() as server, tempfile.TemporaryDirectory() as folder:
            out = pathlib.Path(folder) / "pair.npy"
            for file, name, side in sequences(find_sbu()):
                result = tools.duet("synthesize", "--server", server.address, "--leader", file,
                                    "--leader-side", side, "--label", f"{name}=1", "--out", out,
                                    "--quiet")
                count += 1
                if result.returncode != 0 or not out.is_file():
                    failures.append(f"{file}: {result.returncode} {result.stderr}")
                out.unlink(missing_ok=True)
        self.assertEqual(failures, [])
        self.assertGreater(count, 100)
        print(f"{count} sequences")


if __name__ == "__main__":
    find_sbu()
    tools.main()
