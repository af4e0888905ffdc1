"""Packs a data set into shards: WebDataset's tar files, or files that ``numpy.load`` opens."""

from __future__ import annotations

import io
import json
import pathlib
import shutil
import tarfile
import zipfile
from typing import Any, Dict, List, Tuple, Union

from duet_motion.sets.shards import (DataSetError, Record, Records, Shards, contents,
                                     read_json, sha256_of, to_json, write)
from duet_motion.sets.splits import Path, Splits, read_splits, split_of

SHARD_BYTES = 256 << 20
_COPIED = ("README.md", "failed.jsonl", "rejected.jsonl")
_LONG_AGO = (1980, 1, 1, 0, 0, 0)  # the earliest date of a zip member


def pack(path: Path, out: Path, *, kind: str = "npz", shard_bytes: int = SHARD_BYTES) -> List[str]:
    """Writes a data set as shards into another folder, without times and owners, so that the same
    set gives the same bytes. Checks every file on the way. A shard holds one split.

    Args:
        path: a set of `duet batch`. An unfinished one is packed as it is.
        out: the folder to make. Packing again replaces nothing: remove it first.
        kind: "npz": an array of leader and follower for each item, and ``records.jsonl`` with their
            records. "tar": for each item its files (``key.npy``) and its record (``key.json``), as
            WebDataset groups them.
        shard_bytes: maximum bytes of motion in a shard. A larger item has its own.

    Returns:
        The names of the shards.

    Raises:
        DataSetError: there is no set, a file is missing or was changed, or ``kind`` is "npz" and the
            set has no arrays.
        FileExistsError: ``out`` exists.
        ValueError: an argument is invalid.
    """
    if kind not in ("npz", "tar"):
        raise ValueError(f"kind: expected npz or tar, got {kind!r}")
    if shard_bytes < 1:
        raise ValueError(f"shard_bytes: expected 1 or more, got {shard_bytes}")
    source, target = pathlib.Path(path), pathlib.Path(out)
    if target.exists():
        raise FileExistsError(f"{target}: expected a new folder, got one that exists")
    description = read_json(source / "dataset.json")
    partial = target.with_name(target.name + ".partial")
    shutil.rmtree(partial, ignore_errors=True)
    partial.mkdir(parents=True)
    packer = _Packer(source, partial, kind, shard_bytes, read_splits(source))
    names = packer.pack()
    write(partial / "dataset.json", to_json({
        **description, "packing": f"PACKING_{kind.upper()}", "shards": names,
        "shard_sha256": [sha256_of(partial / name) for name in names],
        "splits": [{"name": split, "items": count, "shards": packer.shards_of[split]}
                   for split, count in packer.items_of.items()]}))
    for file in _COPIED:
        if (source / file).is_file():
            shutil.copyfile(source / file, partial / file)
    partial.rename(target)
    return names


class _Packer:
    def __init__(self, source: pathlib.Path, out: pathlib.Path, kind: str, shard_bytes: int,
                 splits: Splits) -> None:
        self._source, self._out, self._kind, self._limit = source, out, kind, shard_bytes
        self._splits = splits
        self._open: Dict[str, Tuple[_Shard, int]] = {}  # by split: the shard and its bytes
        self._names: List[str] = []
        self.items_of = {split: 0 for split in splits.names}
        self.shards_of: Dict[str, List[str]] = {split: [] for split in splits.names}

    def pack(self) -> List[str]:
        with (self._out / "index.jsonl").open("w", encoding="utf-8") as index:
            shards = Shards(self._source)
            for record in Records(self._source / "index.jsonl"):
                split = split_of(record, self._splits)
                files = list(contents(self._source, record, shards))
                shard = self._shard_for(split, sum(len(data) for _, data in files))
                shard.add(record, files)
                self.items_of[split] += 1
                packed = {**record, "shard": shard.name}
                if len(self.items_of) > 1:
                    packed["split"] = split
                index.write(_line(packed))
        for shard, _ in self._open.values():
            shard.close()
        return self._names

    def _shard_for(self, split: str, size: int) -> _Shard:
        shard, used = self._open.get(split, (None, 0))
        if shard is None or used + size > self._limit:
            if shard is not None:
                shard.close()
            of_split = f"{split}-" if len(self.items_of) > 1 else ""
            name = f"set-{of_split}{len(self.shards_of[split]):06d}.{self._kind}"
            shard, used = _TarShard(self._out, name) if self._kind == "tar" else _NpzShard(self._out, name), 0
            self._names.append(name)
            self.shards_of[split].append(name)
        self._open[split] = (shard, used + size)
        return shard


class _TarShard:
    def __init__(self, out: pathlib.Path, name: str) -> None:
        self.name = name
        self._tar = tarfile.open(out / name, "w", format=tarfile.PAX_FORMAT)

    def add(self, record: Record, files: List[Tuple[str, bytes]]) -> None:
        for member, data in (*files, (f"{record['name']}.json", _line(record).encode())):
            info = tarfile.TarInfo(member)  # with no time and no owner
            info.size = len(data)
            self._tar.addfile(info, io.BytesIO(data))

    def close(self) -> None:
        self._tar.close()


class _NpzShard:
    def __init__(self, out: pathlib.Path, name: str) -> None:
        self.name = name
        self._zip = zipfile.ZipFile(out / name, "w", zipfile.ZIP_STORED)
        self._lines: List[str] = []

    def add(self, record: Record, files: List[Tuple[str, bytes]]) -> None:
        arrays = [(path, data) for path, data in files if path.endswith(".npy")]
        if not arrays:
            raise DataSetError(f"{record['name']}: expected an array for an npz shard, got "
                               f"{', '.join(path for path, _ in files)}; add FORMAT_NPY to the recipe's "
                               "output formats, or pack tar shards")
        for path, data in arrays:
            self._zip.writestr(zipfile.ZipInfo(path, _LONG_AGO), data)
        self._lines.append(_line(record))

    def close(self) -> None:
        self._zip.writestr(zipfile.ZipInfo("records.jsonl", _LONG_AGO), "".join(self._lines))
        self._zip.close()


_Shard = Union[_TarShard, _NpzShard]


def _line(record: Any) -> str:
    return json.dumps(record, ensure_ascii=False, separators=(",", ":")) + "\n"
