"""Writes the items of a data set as captures, which loaders of SBU and K3HI and `duet-train` read."""

from __future__ import annotations

import collections
import json
import pathlib
import re
import shutil
from typing import Counter, Dict, List, Tuple

import numpy as np

from duet_motion.motion import Positions
from duet_motion.sets.reading import MotionSet, SetItem, read_set
from duet_motion.sets.records import Record
from duet_motion.sets.shards import DataSetError
from duet_motion.sets.splits import Path

# For each layout, its rate in Hz and the folder of each class (docs/datasets.md).
_LAYOUTS: Dict[str, Tuple[float, Dict[str, str]]] = {
    "sbu": (15.0, {"kick": "03", "push": "04", "shake_hands": "05", "hug": "06",
                   "exchange_object": "07", "punch": "08"}),
    "k3hi": (30.0, {"approach": "approaching", "depart": "departing", "exchange_object": "exchanging",
                    "kick": "kicking", "point": "pointing", "punch": "punching", "push": "pushing",
                    "shake_hands": "shaking"})}
JOINTS = ("head", "neck", "torso", "left_shoulder", "left_elbow", "left_hand", "right_shoulder",
          "right_elbow", "right_hand", "left_hip", "left_knee", "left_foot", "right_hip", "right_knee",
          "right_foot")
_SBU_SET = re.compile(r"s\d\ds\d\d")


def captures(path: Path, out: Path, *, layout: str = "sbu") -> int:
    """Writes both people of each item as text, the leader on the side that it has in its own file, with
    ``index.tsv``, which names the leaders, and ``index.jsonl``. An item is in the folder of the class of
    its largest weight. In SBU's layout, that is in the last part of its leader's path of the form
    ``sXXsYY``, or ``s00s00``.

    Args:
        path: a data set of a model with SBU's joints.
        out: the folder to make.
        layout: "sbu": ``sXXsYY/<class>/<sequence>/skeleton_pos.txt`` at 15 Hz. "k3hi":
            ``<class>/<sequence>.txt`` at 30 Hz. Both are in SBU's normalised unit.

    Returns:
        The number of items.

    Raises:
        DataSetError: there is no data set, a file is missing, or the layout lacks a joint or a class.
        FileExistsError: ``out`` exists.
        ValueError: the layout is another.
    """
    if layout not in _LAYOUTS:
        raise ValueError(f"layout: expected {' or '.join(_LAYOUTS)}, got {layout!r}")
    rate, folders = _LAYOUTS[layout]
    reactions, target = read_set(path, frame_rate_hz=rate), pathlib.Path(out)
    if target.exists():
        raise FileExistsError(f"{target}: expected a new folder, got one that exists")
    partial = target.with_name(target.name + ".partial")
    shutil.rmtree(partial, ignore_errors=True)
    partial.mkdir(parents=True)
    clips: Counter[str] = collections.Counter()
    rows, records = ["path\tleader_side\n"], []
    for item in reactions:
        folder = _class_folder(reactions, item, folders)
        if layout == "sbu":
            parts = pathlib.PurePath(item.record["leader"]).parts
            folder = f"{next((part for part in reversed(parts) if _SBU_SET.fullmatch(part)), 's00s00')}/{folder}"
        clips[folder] += 1
        name = f"{folder}/{clips[folder]:03d}" + ("/skeleton_pos.txt" if layout == "sbu" else ".txt")
        file = partial / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(_text(item.pair, item.record["side"]), encoding="utf-8")
        rows.append(f"{name}\t{item.record['side']}\n")
        records.append({**item.record, "frames": item.pair.shape[1], "frame_rate_hz": rate,
                        "files": [{"path": name}]})
    (partial / "index.tsv").write_text("".join(rows), encoding="utf-8")
    (partial / "index.jsonl").write_text("".join(json.dumps(record) + "\n" for record in records),
                                         encoding="utf-8")
    partial.rename(target)
    return len(records)


def largest_class(record: Record) -> str:
    """The class of the largest weight, over all keyframes; "none" without a weight above 0."""
    best, largest = "none", 0.0
    for labels in (keyframe.get("labels", {}) for keyframe in record.get("keyframes", [record])):
        for name, weight in labels.items():
            if weight > largest:
                best, largest = name, weight
    return best


def _class_folder(reactions: MotionSet, item: SetItem, folders: Dict[str, str]) -> str:
    if item.leader.joint_names != JOINTS:
        raise DataSetError(f"{reactions.path}: {item.name}: expected the joints {', '.join(JOINTS)}, got "
                           f"{', '.join(item.leader.joint_names)}")
    of_item = largest_class(item.record)
    if of_item not in folders:
        raise DataSetError(f"{reactions.path}: {item.name}: class of the largest weight: expected "
                           f"{', '.join(folders)}, got {of_item}")
    return folders[of_item]


def _text(pair: Positions, side: str) -> str:
    """A line for each frame: its number, and the joints of the left and the right person."""
    people = pair[::-1] if side == "right" else pair
    # From metres, y up, to SBU's normalised unit, y down.
    values = (people * [-1.0, -1.0, 1.0] + [1.28, 0.96, 0.0]) / [2.56, 1.92, 1.28]
    lines: List[str] = []
    for number, frame in enumerate(np.swapaxes(values, 0, 1).astype(np.float32), 1):
        lines.append(",".join([str(number), *map(str, frame.ravel())]) + "\n")
    return "".join(lines)
