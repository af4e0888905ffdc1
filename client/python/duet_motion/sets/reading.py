"""Reads data sets of `duet batch` for training.

>>> reactions = duet.read_set("set", frame_rate_hz=30)
>>> item = reactions[0]
>>> item.leader.positions, item.follower.positions    # [frames, joints, 3], metres
>>> item.weights                                      # [frames, classes]
>>> batch = duet.pad([reactions[index] for index in range(8)])
>>> batch.pairs, batch.mask                           # [8, 2, frames, joints, 3], [8, frames]
"""

from __future__ import annotations

import dataclasses
import json
import os
import pathlib
from typing import Any, Dict, Iterator, List, Mapping, Optional, Sequence, Tuple, Union, overload

import numpy as np
import numpy.typing as npt

from duet_motion.sets.shards import DataSetError, Records, Shards, parse_array
from duet_motion.sets.splits import Splits, read_splits, split_of
from duet_motion.motion import Motion, Positions, checked_number, resample

Path = Union[str, "os.PathLike[str]"]
Weights = npt.NDArray[np.float32]

_NEWEST_FORMAT = 1


@dataclasses.dataclass(frozen=True, eq=False)
class SetItem:
    """One item of a data set: leader, follower and labels."""

    record: Mapping[str, Any]
    """The item's line of ``index.jsonl``: seed, model, quality, digests (docs/batch.md)."""
    pair: Positions
    """``[2, frames, joints, 3]``: leader first, in ``leader.unit``."""
    leader: Motion
    follower: Motion
    interaction_classes: Tuple[str, ...]
    """The class of each column of ``weights``."""
    weights: Weights
    """``[frames, classes]``: the label vector, the same in each frame."""

    @property
    def name(self) -> str:
        """The name of the item's files, without extension."""
        return str(self.record["name"])


@dataclasses.dataclass(frozen=True, eq=False)
class PaddedBatch:
    """Items of different lengths in arrays of one shape."""

    pairs: Positions
    """``[items, 2, frames, joints, 3]``, leader first. An item's last frame is repeated to the
    end."""
    weights: Weights
    """``[items, frames, classes]``. An item's last weights are repeated to the end."""
    mask: npt.NDArray[np.bool_]
    """``[items, frames]``: True for an item's frames, False for padding."""
    records: Tuple[Mapping[str, Any], ...]


class MotionSet(Sequence[SetItem]):
    """A data set that `duet batch` wrote. Create one with :func:`read_set`.

    Items are read on access, so a set may be larger than memory. It may be pickled and shared by
    threads and processes, so PyTorch's ``DataLoader`` accepts it directly.
    """

    def __init__(self, path: Path, frame_rate_hz: Optional[float] = None,
                 split: Optional[str] = None) -> None:
        self.path = pathlib.Path(path)
        """The set's folder."""
        self.frame_rate_hz = (None if frame_rate_hz is None else
                              checked_number("frame_rate_hz", frame_rate_hz, above=0))
        """Frames per second of every item after resampling; None: each item keeps its rate."""
        index = self.path / "index.jsonl"
        if not index.is_file():
            raise DataSetError(f"{self.path}: expected a data set of duet batch, got no "
                               "index.jsonl in it")
        self.split = split
        """The split whose items these are; None: all items."""
        splits = read_splits(self.path)
        self.records = Records(
            index, None if split is None else lambda record: split_of(record, splits) == split)
        """The record of each item, in order."""
        self.description: Mapping[str, Any] = _read_description(self.path)
        """``dataset.json``: counts, models and their terms, skeletons (docs/batch.md)."""
        self._check_split(splits)
        self._skeletons: List[Mapping[str, Any]] = self.description["skeletons"]
        self.interaction_classes = tuple(self.description["interaction_classes"])
        """Every class with weights in any item, in the order of the label vector."""
        self._shards = Shards(self.path)

    def __len__(self) -> int:
        return len(self.records)

    @overload
    def __getitem__(self, index: int) -> SetItem: ...
    @overload
    def __getitem__(self, index: slice) -> List[SetItem]: ...

    def __getitem__(self, index: Any) -> Any:
        if isinstance(index, slice):
            return [self[at] for at in range(*index.indices(len(self)))]
        return self._item(self.records[index])

    def __iter__(self) -> Iterator[SetItem]:
        return map(self._item, self.records)

    def __repr__(self) -> str:
        return (f"MotionSet({str(self.path)!r}: {len(self)} items of "
                f"{', '.join(self.interaction_classes)})")

    @property
    def joint_names(self) -> Tuple[str, ...]:
        """The joints of every item, in the order of the arrays.

        Raises:
            DataSetError: the set has several skeletons, or none.
        """
        return tuple(self._only_skeleton()["joint_names"])

    @property
    def parents(self) -> Tuple[int, ...]:
        """For each joint the index of its parent, -1 for none.

        Raises:
            DataSetError: the set has several skeletons, or none.
        """
        return tuple(self._only_skeleton()["parents"])

    def skeleton_of(self, record: Mapping[str, Any]) -> Mapping[str, Any]:
        """The joints of an item, a DatasetSkeleton of ``dataset.json``.

        Args:
            record: the item's line of ``index.jsonl``.
        """
        skeleton: int = record["skeleton"]
        return self._skeletons[skeleton]

    def _only_skeleton(self) -> Mapping[str, Any]:
        if len(self._skeletons) != 1:
            raise DataSetError(f"{self.path}: expected one skeleton, got {len(self._skeletons)}; "
                               "use item.leader.joint_names")
        return self._skeletons[0]

    def _check_split(self, splits: Splits) -> None:
        packed = self.description.get("splits", ())
        names = [named["name"] for named in packed] or list(splits.names)
        if self.split is not None and self.split not in names:
            raise DataSetError(f"{self.path}: split: expected {' or '.join(names)}, got "
                               f"{self.split!r}")

    def _item(self, record: Mapping[str, Any]) -> SetItem:
        pair = self._read(record)
        rate = float(record["frame_rate_hz"])
        if self.frame_rate_hz is not None and rate != self.frame_rate_hz and pair.shape[1] > 1:
            pair = np.stack([resample(person, rate, self.frame_rate_hz) for person in pair])
            rate = self.frame_rate_hz
        try:
            names = self.skeleton_of(record)["joint_names"]
            leader, follower = (Motion(person, names, rate) for person in pair)
        except (LookupError, ValueError) as error:
            raise DataSetError(f"{self.path}: {record['name']}: {error}") from error
        labels = record.get("labels", {})
        weights = np.tile(np.array([labels.get(name, 0.0) for name in self.interaction_classes],
                                   dtype=np.float32), (pair.shape[1], 1))
        return SetItem(record, pair, leader, follower, self.interaction_classes, weights)

    def _read(self, record: Mapping[str, Any]) -> Positions:
        """``[2, frames, joints, 3]``, leader first."""
        name = record["name"]
        try:
            if "shard" in record:
                pair = self._shards.read(record["shard"], f"{name}.npy")
            else:
                pair = self._read_file(record)
        except FileNotFoundError as error:
            raise DataSetError(f"{self.path}: {name}: expected the file {error.filename}, got none; "
                               "python3 -m duet_motion.sets verify lists what is missing") from error
        except KeyError as error:
            raise DataSetError(f"{self.path / str(record['shard'])}: expected the array {error}, got "
                               "none") from error
        except ValueError as error:
            raise DataSetError(f"{self.path}: {name}: {error}") from error
        if pair.ndim != 4 or pair.shape[0] != 2 or pair.shape[3] != 3:
            raise DataSetError(f"{self.path}: {name}: expected the shape (2, frames, joints, 3), got "
                               f"{pair.shape}")
        return pair.astype(np.float32, copy=False)

    def _read_file(self, record: Mapping[str, Any]) -> Positions:
        files = {pathlib.PurePosixPath(file["path"]).suffix: self.path / file["path"]
                 for file in record["files"]}
        if ".npy" not in files:
            raise ValueError(f"expected .npy, got {', '.join(files)}; add FORMAT_NPY to the recipe's "
                             "output formats")
        return parse_array(files[".npy"].read_bytes())


def read_set(path: Path, *, frame_rate_hz: Optional[float] = None,
             split: Optional[str] = None) -> MotionSet:
    """Opens a data set of `duet batch`: loose files, or npz or tar shards.

    Args:
        path: the set's folder, which contains ``index.jsonl``.
        frame_rate_hz: frames per second of every item after linear resampling at the same speed.
            None: each item keeps its rate.
        split: "train", "validation" or "test": only the items of this split. None: all items.

    Raises:
        DataSetError: the folder contains no data set, or one of a later format, or the set has no
            such split.
        ValueError: the rate is invalid.
    """
    return MotionSet(path, frame_rate_hz, split)


def pad(items: Sequence[SetItem], frames: Optional[int] = None) -> PaddedBatch:
    """Combines items of different lengths in arrays of one shape. Shorter items repeat their last
    frame, longer ones are truncated. Use it as ``collate_fn`` of PyTorch's ``DataLoader``.

    Args:
        items: at least one, all with the same joints.
        frames: number of frames in the result, at least 1. None: the longest item's.

    Raises:
        ValueError: there are no items, their joints differ, or ``frames`` is below 1.
    """
    if not items:
        raise ValueError("items: expected at least one, got none")
    longest = max(item.pair.shape[1] for item in items) if frames is None else frames
    if longest < 1:
        raise ValueError(f"frames: expected 1 or more, got {longest}")
    for item in items:
        if item.leader.joint_names != items[0].leader.joint_names:
            raise ValueError(f"items: expected the joints of {items[0].name} in all of them, got "
                             f"others in {item.name}")
    at = [np.minimum(np.arange(longest), item.pair.shape[1] - 1) for item in items]
    return PaddedBatch(
        np.stack([item.pair[:, frames_of] for item, frames_of in zip(items, at)]),
        np.stack([item.weights[frames_of] for item, frames_of in zip(items, at)]),
        np.stack([np.arange(longest) < item.pair.shape[1] for item in items]),
        tuple(item.record for item in items))


def _read_description(path: pathlib.Path) -> Mapping[str, Any]:
    file = path / "dataset.json"
    try:
        description: Dict[str, Any] = json.loads(file.read_text(encoding="utf-8"))
        version = description["format_version"]
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise DataSetError(f"{file}: expected a JSON object with format_version, got {error!r}; duet "
                           "batch writes it at the end of a run") from error
    if version > _NEWEST_FORMAT:
        raise DataSetError(f"{file}: format_version: expected at most {_NEWEST_FORMAT}, got "
                           f"{version}; upgrade duet-motion")
    return description
