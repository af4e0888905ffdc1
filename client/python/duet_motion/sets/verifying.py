"""Compares every file of a data set with its recorded digest."""

from __future__ import annotations

import dataclasses
import hashlib
import json
import pathlib
from typing import Any, Dict, Iterator, List, Optional, Tuple

from duet_motion.sets.records import Makers, contents, read_json, sha256_of
from duet_motion.sets.shards import DataSetError, Records, Shards
from duet_motion.sets.splits import Path


@dataclasses.dataclass(frozen=True)
class VerifyReport:
    """What :func:`verify` found."""

    items: int
    files: int
    problems: List[str]
    """Files that are missing or were changed, answers that were made in another way than the
    others, and lines of the index that differ from the journal."""
    missing: Optional[int]
    """Planned items that are neither done, rejected nor failed; None: unknown, because no run has
    ended yet."""


def verify(path: Path) -> VerifyReport:
    """Verifies a data set, packed or not, or a copy of it. Changes nothing.

    To make files again that are missing or were changed, repeat the command that made the set with
    ``--verify``.

    Raises:
        DataSetError: the folder holds no data set, or its index cannot be read.
    """
    folder = pathlib.Path(path)
    index = folder / "index.jsonl"
    if not index.is_file():
        raise DataSetError(f"{folder}: expected a data set of duet batch, got no index.jsonl in it")
    shards, makers, problems = Shards(folder), Makers(), []
    items = files = 0
    for record in Records(index):
        items += 1
        files += len(record["files"])
        try:
            for _ in contents(folder, record, shards):
                pass
        except DataSetError as error:
            problems.append(str(error))
        difference = makers.difference(record)
        if difference:
            problems.append(difference)
    problems += _compare_with_journal(folder)
    missing: Optional[int] = None
    try:
        description = read_json(folder / "dataset.json")
        missing = int(description["items"]["missing"])
        problems += _changed_shards(folder, description)
    except DataSetError as error:
        problems.append(str(error))
    except (KeyError, TypeError, ValueError) as error:
        problems.append(f"dataset.json: expected the number of missing items, got {error}")
    return VerifyReport(items, files, problems, missing)


def _changed_shards(folder: pathlib.Path, description: Dict[str, Any]) -> List[str]:
    """Shards that differ, even where no item does."""
    digests = zip(description.get("shards", ()), description.get("shard_sha256", ()))
    return [f"{folder / shard}: was changed" for shard, digest in digests
            if (folder / shard).is_file() and sha256_of(folder / shard) != digest]


def _compare_with_journal(folder: pathlib.Path) -> List[str]:
    journal = _Journal(folder)
    problems = []
    with (folder / "index.jsonl").open(encoding="utf-8", newline="\n") as lines:
        done = (text for text in journal.texts() if json.loads(text)["state"] == "done")
        for number, text in enumerate(done, 1):
            if lines.readline() != text + "\n":
                problems.append(f"index.jsonl:{number}: is not what the journal says")
                break
        else:
            if journal.path.is_file() and lines.readline():
                problems.append("index.jsonl: has more lines than the journal")
    return problems


class _Journal:
    """The results of items in the order in which runs settled them. Keeps a few bytes for each item.

    A line is the first eight hex digits of the SHA-256 of its rest, the item's number, and its record.
    The last line of an item counts. A line that does not match its digest is as good as none.
    """

    def __init__(self, folder: pathlib.Path) -> None:
        self.path = folder / ".duet-batch" / "journal"
        self._places: Dict[int, Tuple[int, int]] = {}  # of lines without their digests, by item
        if not self.path.is_file():
            return
        at = 0
        with self.path.open("rb") as file:
            for line in file:
                digest, _, rest = line.rstrip(b"\n").partition(b" ")
                number = rest.partition(b" ")[0]
                if number.isdigit() and hashlib.sha256(rest).hexdigest()[:8].encode() == digest:
                    self._places[int(number)] = (at + len(digest) + 1, len(rest))
                at += len(line)

    def text(self, item: int) -> str:
        """The record of an item, as in ``index.jsonl``."""
        begin, size = self._places[item]
        with self.path.open("rb") as file:
            file.seek(begin)
            return file.read(size).partition(b" ")[2].decode()

    def texts(self) -> Iterator[str]:
        """The records of all items, by number."""
        return map(self.text, sorted(self._places))
