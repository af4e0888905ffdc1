"""Compares every file of a data set with its recorded digest."""

from __future__ import annotations

import dataclasses
import pathlib
from typing import Any, Dict, List, Optional

from duet_motion.sets.shards import (DataSetError, Records, Shards, contents, read_json, sha256_of)
from duet_motion.sets.splits import Path


@dataclasses.dataclass(frozen=True)
class VerifyReport:
    """What :func:`verify` found."""

    items: int
    files: int
    problems: List[str]
    """Files and shards that are missing or were changed."""
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
    shards = Shards(folder)
    problems: List[str] = []
    items = files = 0
    for record in Records(index):
        items += 1
        files += len(record["files"])
        try:
            for _ in contents(folder, record, shards):
                pass
        except DataSetError as error:
            problems.append(str(error))
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
