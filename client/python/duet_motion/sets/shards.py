"""The files of a data set: single ones, zip shards and tar shards.

The offsets in a shard are read once. Each array is then read through a newly opened file, so that
threads and forked processes share no file position.
"""

from __future__ import annotations

import hashlib
import io
import json
import os
import pathlib
import struct
import tarfile
import zipfile
from typing import Any, Callable, Dict, Iterator, List, Mapping, Optional, Tuple

import numpy as np
import numpy.typing as npt

# Header of a zip member: 30 bytes that end with the lengths of the name and the extra field.
_ZIP_HEADER = struct.Struct("<26xHH")


Record = Mapping[str, Any]


class DataSetError(ValueError):
    """A data set cannot be read. The message names the file, what was expected and what was
    found."""


class Records:
    """The lines of ``index.jsonl``, parsed on access because a set can have millions."""

    def __init__(self, path: pathlib.Path,
                 wanted: Optional[Callable[[Mapping[str, Any]], bool]] = None) -> None:
        """``wanted`` selects records; None: all of them."""
        self._path = path
        begins: List[int] = []
        at = 0
        with path.open("rb") as file:
            for line in file:
                if line.strip() and (wanted is None or wanted(self._parse(line, at))):
                    begins.append(at)
                at += len(line)
        self._begins = np.array(begins, dtype=np.int64)
        self._all = wanted is None

    def __len__(self) -> int:
        return len(self._begins)

    def __getitem__(self, index: int) -> Record:
        begin = int(self._begins[index])
        with self._path.open("rb") as file:
            file.seek(begin)
            record: Record = self._parse(file.readline(), begin)
        return record

    def __iter__(self) -> Iterator[Mapping[str, Any]]:
        if not self._all:
            yield from (self[at] for at in range(len(self)))
            return
        with self._path.open("rb") as file:
            for line in file:
                if line.strip():
                    yield self._parse(line, file.tell() - len(line))

    def _parse(self, line: bytes, begin: int) -> Any:
        try:
            return json.loads(line)
        except ValueError as error:
            raise DataSetError(f"{self._path}: byte {begin}: expected a record in JSON, got {error}; "
                               "python3 -m duet_motion.sets verify finds all damage") from error


class Shards:
    """The arrays in the shards of a folder."""

    def __init__(self, folder: pathlib.Path) -> None:
        self._folder = folder
        self._members: Dict[str, Dict[str, Tuple[int, int]]] = {}

    def read(self, shard: str, member: str) -> npt.NDArray[np.float32]:
        """Raises FileNotFoundError, KeyError or ValueError."""
        return parse_array(self.data(shard, member))

    def data(self, shard: str, member: str) -> bytes:
        """Raises FileNotFoundError, KeyError or ValueError."""
        offset, size = self.place(shard, member)
        with (self._folder / shard).open("rb") as file:
            file.seek(offset)
            return file.read(size)

    def place(self, shard: str, member: str) -> Tuple[int, int]:
        """The offset and the size in bytes of a member. Raises as :meth:`data`."""
        if shard not in self._members:
            self._members[shard] = _members_of(self._folder / shard)
        return self._members[shard][member]


def parse_array(data: bytes) -> npt.NDArray[np.float32]:
    """The array of a .npy file. Raises ValueError."""
    array: npt.NDArray[np.float32] = np.load(io.BytesIO(data), allow_pickle=False)
    return array


def _members_of(path: pathlib.Path) -> Dict[str, Tuple[int, int]]:
    """The offset and the size in bytes of each member."""
    try:
        return _tar_members(path) if path.suffix == ".tar" else _zip_members(path)
    except (tarfile.TarError, zipfile.BadZipFile) as error:
        raise ValueError(str(error)) from error


def _tar_members(path: pathlib.Path) -> Dict[str, Tuple[int, int]]:
    with tarfile.open(path, "r:") as archive:
        return {member.name: (member.offset_data, member.size) for member in archive}


def _zip_members(path: pathlib.Path) -> Dict[str, Tuple[int, int]]:
    members = {}
    with zipfile.ZipFile(path) as archive, path.open("rb") as file:
        for member in archive.infolist():
            if member.compress_type != zipfile.ZIP_STORED:
                raise ValueError(f"member {member.filename}: expected a stored member, got a "
                                 "compressed one")
            file.seek(member.header_offset)
            name, extra = _ZIP_HEADER.unpack(file.read(_ZIP_HEADER.size))
            begin = member.header_offset + _ZIP_HEADER.size + name + extra
            members[member.filename] = (begin, member.file_size)
    return members


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
