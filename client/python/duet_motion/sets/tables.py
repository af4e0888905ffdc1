"""Tables of the items of a data set, one for each split, for pandas and Hugging Face's datasets."""

from __future__ import annotations

import json
import pathlib
from typing import Any, Dict, List

from duet_motion.sets.records import Record, largest_class, member_name, read_json
from duet_motion.sets.shards import Records, Shards
from duet_motion.sets.splits import Path, read_splits, split_of

_COPIED = ("id", "name", "leader", "leader_sha256", "side", "group", "reaction", "model", "seed",
           "variety", "candidates", "frames", "frame_rate_hz", "skeleton", "unfamiliarity", "shard")


def table(path: Path, *, format: str = "csv") -> List[str]:
    """Writes ``items/train.csv`` and so on into a data set: a row for each item (docs/batch.md).

    Args:
        path: a data set, packed or not.
        format: "csv" or "parquet", which needs pyarrow.

    Returns:
        The tables, relative to the set.

    Raises:
        DataSetError: there is no data set.
        ImportError: pandas is missing, or pyarrow for "parquet".
        ValueError: the format is another.
    """
    import pandas
    if format not in ("csv", "parquet"):
        raise ValueError(f"format: expected csv or parquet, got {format!r}")
    folder = pathlib.Path(path)
    rows: Dict[str, List[Dict[str, Any]]] = rows_by_split(folder)
    (folder / "items").mkdir(exist_ok=True)
    written = []
    for split, of_split in rows.items():
        frame = pandas.DataFrame(of_split)
        name = f"items/{split}.{format}"
        if format == "csv":
            frame.to_csv(folder / name, index=False)
        else:
            frame.to_parquet(folder / name, index=False)
        written.append(name)
    return written


def rows_by_split(folder: pathlib.Path) -> Dict[str, List[Dict[str, Any]]]:
    """The rows of the items of each split that has any."""
    description = read_json(folder / "dataset.json")
    free = {model["name"]: model.get("free_for_all_uses", False) for model in description["models"]}
    splits, shards = read_splits(folder), Shards(folder)
    rows: Dict[str, List[Dict[str, Any]]] = {}
    for record in Records(folder / "index.jsonl"):
        row = _row(record, description["interaction_classes"], shards)
        row["split"] = split_of(record, splits)
        row["free_for_all_uses"] = free.get(record.get("model"), False)
        rows.setdefault(row["split"], []).append(row)
    return rows


def _row(record: Record, classes: List[str], shards: Shards) -> Dict[str, Any]:
    row: Dict[str, Any] = {field: record.get(field) for field in _COPIED}
    row["interaction_class"] = largest_class(record)
    labels = record.get("labels", {})
    for name in classes:  # empty where weights change over time
        row[f"label_{name}"] = None if "keyframes" in record else labels.get(name, 0.0)
    row["keyframes"] = json.dumps(record["keyframes"]) if "keyframes" in record else None
    row.update(record.get("quality", {}))
    files = record["files"]
    main = next((file for file in files if file["path"].endswith(".npy")), files[0])
    row.update(path=main["path"], offset=0, bytes=main["bytes"], sha256=main["sha256"],
               files=",".join(file["path"] for file in files),
               extra=json.dumps(record["extra"]) if "extra" in record else None)
    if "shard" in record:
        row["path"] = member_name(record["shard"], main["path"])
        row["offset"] = shards.place(record["shard"], row["path"])[0]
    return row
