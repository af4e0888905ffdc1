"""Divides the items of a data set for training, validation and testing, by leader.

The digest of a leader's file decides its split, or the digest of its ``group`` if it has one. So a
leader keeps its split when others are added, in every shard of a job, and under every name.
"""

from __future__ import annotations

import collections
import dataclasses
import hashlib
import json
import os
import pathlib
from typing import Any, Dict, Mapping, Tuple, Union

from duet_motion.motion import finite_number
from duet_motion.sets.shards import DataSetError, Records

Path = Union[str, "os.PathLike[str]"]
TRAIN, VALIDATION, TEST = "train", "validation", "test"
_FILE = "splits.json"


@dataclasses.dataclass(frozen=True)
class Splits:
    """The shares of leaders for validation and testing; the others train.

    Raises:
        ValueError: a share is below 0, or both together are 1 or more.
    """

    validation: float = 0.0
    test: float = 0.0

    def __post_init__(self) -> None:
        for field in ("validation", "test"):
            share = finite_number(getattr(self, field))
            if share is None or share < 0:
                raise ValueError(f"{field}: expected 0 or more, got {getattr(self, field)!r}")
        if self.validation + self.test >= 1:
            raise ValueError(f"splits: expected less than 1 together, got {self.validation + self.test}")

    @property
    def names(self) -> Tuple[str, ...]:
        """"train", and the others that have a share."""
        return (TRAIN, *(name for name in (VALIDATION, TEST) if getattr(self, name) > 0))


def split_of(record: Mapping[str, Any], splits: Splits) -> str:
    """The split of an item. ``record`` is its line of ``index.jsonl``.

    "test" has the lowest digests and "validation" the highest, so that changing one share moves no
    leader of the other.
    """
    if "split" in record:  # of a packed set
        return str(record["split"])
    group = record.get("group", "")
    digest = hashlib.sha256(group.encode()).hexdigest() if group else record.get("leader_sha256", "")
    try:
        fraction = int(digest[:8], 16) / 2**32
    except ValueError:
        fraction = 0.0
    if fraction < splits.test:
        return TEST
    return VALIDATION if fraction >= 1 - splits.validation else TRAIN


def split(path: Path, *, validation: float = 0.0, test: float = 0.0) -> Dict[str, int]:
    """Divides a data set: writes ``splits.json``, which ``read_set`` and :func:`pack` follow. Repeat it with other shares as you like.

    Returns:
        The number of items of each split.

    Raises:
        ValueError: the shares are invalid.
        DataSetError: there is no data set.
    """
    folder, splits = pathlib.Path(path), Splits(validation, test)
    counts = collections.Counter({name: 0 for name in splits.names})
    counts.update(split_of(record, splits) for record in Records(folder / "index.jsonl"))
    (folder / _FILE).write_text(json.dumps(dataclasses.asdict(splits)) + "\n", encoding="utf-8")
    return dict(counts)


def read_splits(folder: pathlib.Path) -> Splits:
    """The splits of a set that is not packed; without any, all items train."""
    file = folder / _FILE
    if not file.is_file():
        return Splits()
    try:
        return Splits(**json.loads(file.read_text(encoding="utf-8")))
    except (TypeError, ValueError) as error:
        raise DataSetError(f"{file}: expected the shares of validation and test, got {error}") from error
