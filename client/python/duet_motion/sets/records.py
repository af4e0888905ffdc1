"""What the tools for data sets share: the files of an item, and durable writing."""

from __future__ import annotations

import hashlib
import json
import os
import pathlib
from typing import Any, Dict, Iterator, Mapping, Tuple

from duet_motion.sets.shards import DataSetError, Shards

Record = Mapping[str, Any]


def sha256_of(file: pathlib.Path) -> str:
    """The digest of a file of any size."""
    digest = hashlib.sha256()
    with file.open("rb") as opened:
        while block := opened.read(1 << 20):
            digest.update(block)
    return digest.hexdigest()


def read_json(file: pathlib.Path) -> Dict[str, Any]:
    """An object. Raises DataSetError."""
    try:
        value = json.loads(file.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise DataSetError(f"{file}: expected a JSON object, got {error}") from error
    if not isinstance(value, dict):
        raise DataSetError(f"{file}: expected a JSON object, got {type(value).__name__}")
    return value


def to_json(value: Mapping[str, Any]) -> str:
    """In the form of `duet batch`."""
    return json.dumps(value, indent=2, ensure_ascii=False) + "\n"


def write(file: pathlib.Path, text: str) -> None:
    """Replaces a file at once: it has the old content or the new one, whenever the process ends."""
    partial = file.with_name(file.name + ".partial")
    with partial.open("w", encoding="utf-8", newline="") as out:
        out.write(text)
        out.flush()
        os.fsync(out.fileno())
    partial.replace(file)


def checked(data: bytes, file: Record, place: str) -> bytes:
    """``data``, if it has the digest of a file of a record. Raises DataSetError."""
    if hashlib.sha256(data).hexdigest() != file["sha256"]:
        raise DataSetError(f"{place}: was changed")
    return data


def contents(folder: pathlib.Path, record: Record, shards: Shards) -> Iterator[Tuple[str, bytes]]:
    """The path and the content of each file of an item, from its folder or its shard.

    Raises:
        DataSetError: a file is missing or was changed.
    """
    for file in record["files"]:
        path = file["path"]
        place = folder / record.get("shard", "") / path
        try:
            if "shard" in record:
                data = shards.data(record["shard"], path)
            else:
                data = place.read_bytes()
        except (OSError, KeyError, ValueError) as error:
            missing = isinstance(error, (FileNotFoundError, KeyError))
            raise DataSetError(f"{place}: {'no such file' if missing else error}") from error
        yield path, checked(data, file, str(place))
