"""What people look at: the card of a data set, and a sheet of its motions."""

from __future__ import annotations

import pathlib
from typing import Any, Dict, List, Mapping, Tuple

import numpy as np

from duet_motion.sets.reading import MotionSet, SetItem, read_set
from duet_motion.sets.records import largest_class, read_json, write
from duet_motion.sets.shards import DataSetError
from duet_motion.sets.splits import Path
from duet_motion.sets.tables import rows_by_split

_OWN_LINE = "<!-- duet_motion.sets replaces this file. To keep changes, remove this line. -->"
_SIZES = ((1_000, "n<1K"), (10_000, "1K<n<10K"), (100_000, "10K<n<100K"), (1_000_000, "100K<n<1M"))
_MOMENTS = 6


def card(path: Path) -> bool:
    """Writes ``README.md`` into a data set: the terms of its models, its splits, and how to read it,
    with the metadata that Hugging Face reads. Write the tables first (:func:`table`).

    Returns:
        False if the set has a ``README.md`` of your own, which stays.

    Raises:
        DataSetError: there is no data set.
    """
    folder = pathlib.Path(path)
    file = folder / "README.md"
    if file.is_file() and _OWN_LINE not in file.read_text(encoding="utf-8"):
        return False
    description = read_json(folder / "dataset.json")
    counts = {split: len(rows) for split, rows in rows_by_split(folder).items()}
    write(file, _card(description, counts))
    return True


def _card(description: Dict[str, Any], counts: Dict[str, int]) -> str:
    models = description["models"]
    names = ", ".join(model["name"] for model in models)
    is_free = all(model.get("free_for_all_uses", False) for model in models)
    size = next((text for most, text in _SIZES if sum(counts.values()) < most), "n>1M")
    lines = ["---", f'pretty_name: "Reactions by {names}"', "license: other",
             f"license_name: {'free-for-all-uses' if is_free else 'terms-of-the-models'}",
             "tags: [motion, human-motion, two-person-interaction, synthetic]",
             f"size_categories: [{size}]"]
    if counts:
        lines += ["configs:", "- config_name: default", "  data_files:"]
    for split in counts:
        lines += [f"  - split: {split}", f"    path: items/{split}.csv"]
    lines += ["---", "", _OWN_LINE, "", f"# Reactions by {names}", "",
              f"{sum(counts.values())} items with {description['frames']} frames: motions of two people, "
              "of whom the second (the follower) was synthesised in reaction to the first (the leader).",
              "", "## Terms", ""]
    for model in models:
        free = "**free for all uses.**" if model.get("free_for_all_uses") else "**not free for all uses.**"
        lines.append(f"- `{model['name']}`: {free} {_plain(model.get('terms', 'It states no terms.'))}")
    lines += ["", "Every item also contains the motion of its leader. The terms of the leaders' files "
              "apply to it; Duet does not know them. State them here before you pass the set on.",
              "", "## Splits", "", "| split | items | table |", "|---|---|---|"]
    lines += [f"| {split} | {count} | [items/{split}.csv](items/{split}.csv) |"
              for split, count in counts.items()]
    lines += ["", "All items of a leader's file, and of a group of leaders, are in one split.", "",
              "## Reading the set", "", "```python", "import duet_motion", "",
              'for item in duet_motion.read_set("."):', "    item.leader.positions, "
              "item.follower.positions, item.weights    # [frames, joints, 3], metres", "```", "",
              "## How it was made", "", "By `duet batch`, with these models:", ""]
    lines += [f"- `{model['name']}`: {_plain(model.get('description', ''))} SHA-256 of the weights: "
              f"{model.get('weights_sha256', 'unknown')}" for model in models]
    lines += ["", f"Recipe (SHA-256): {description['recipe_sha256']}. The motions are synthetic: they show "
              "what the models produce, not what people did."]
    return "\n".join(lines) + "\n"


def _plain(text: str) -> str:
    """One line of Markdown, without markup."""
    return " ".join(text.split()).replace("<", "&lt;")


def sheet(path: Path, out: Path, *, per_class: int = 12) -> int:
    """Draws some items of each class, each at six moments from the side.

    Args:
        path: a data set.
        out: the picture: .png, .pdf or .svg.
        per_class: maximum number of items of a class, the class of the largest weight. They are those
            with the lowest ids, which are digests: a random sample.

    Returns:
        The number of items drawn.

    Raises:
        DataSetError: there is no data set, it has no items, or a file cannot be read.
        ImportError: matplotlib is missing.
    """
    import matplotlib.collections
    import matplotlib.figure
    reactions = read_set(path)
    chosen = _sample(reactions, per_class)
    if not chosen:
        raise DataSetError(f"{reactions.path}: expected items to draw, got none")
    figure = matplotlib.figure.Figure(figsize=(2 * _MOMENTS, 2.2 * len(chosen)))
    axes = figure.add_axes((0, 0, 1, 1))  # in moments to the right, and items down
    axes.set(xlim=(0, _MOMENTS), ylim=(-len(chosen), 0))
    axes.axis("off")
    for row, item in enumerate(chosen):
        for colour, lines in _lines(item, reactions.skeleton_of(item.record)):
            axes.add_collection(matplotlib.collections.LineCollection(
                lines + (0, -row - 0.95), colors=colour, linewidths=2))
        axes.text(0.02, -row - 0.03, f"{item.name}: {largest_class(item.record)}", fontsize=8, va="top",
                  parse_math=False)
    figure.savefig(out)
    return len(chosen)


def _sample(reactions: MotionSet, per_class: int) -> List[SetItem]:
    by_class: Dict[str, List[Any]] = {}
    for index, record in enumerate(reactions.records):
        of_class = by_class.setdefault(largest_class(record), [])
        of_class.append((record.get("id", ""), index))
        of_class.sort()
        del of_class[per_class:]
    return [reactions[index] for name in sorted(by_class) for _, index in by_class[name]]


def _lines(item: SetItem, skeleton: Mapping[str, Any]) -> List[Tuple[str, Any]]:
    """The bones of each person at all moments, from the side, and the floor: a colour and an array
    [lines, 2 ends, 2], in places of moments, 1 wide and at most 0.85 high."""
    pair = item.pair
    root = item.leader.joint_names.index(skeleton["root_joint"])
    towards = (pair[1, :, root] - pair[0, :, root]).mean(axis=0) * (1, 0, 1)
    length = float(np.linalg.norm(towards))
    across = towards / length if length > 0 else np.array([1.0, 0.0, 0.0])
    moments = np.linspace(0, pair.shape[1] - 1, _MOMENTS).round().astype(int)
    shown = pair[:, moments]  # [2, moments, joints, 3]
    middles = (shown[:, :, root] @ across).mean(axis=0)
    side = np.stack([shown @ across - middles[:, None], shown[..., 1] - shown[..., 1].min()], axis=-1)
    side *= min(0.48 / max(float(np.abs(side[..., 0]).max()), 0.1),
                0.85 / max(float(side[..., 1].max()), 0.1))
    side[..., 0] += np.arange(_MOMENTS)[:, None] + 0.5
    bones = [(parent, child) for child, parent in enumerate(skeleton["parents"]) if parent >= 0]
    floor = np.array([[(moment + 0.05, 0), (moment + 0.95, 0)] for moment in range(_MOMENTS)])
    people = [side[person][:, bones].reshape(-1, 2, 2) for person in range(2)]
    return [("grey", floor), ("tab:orange", people[0]), ("tab:cyan", people[1])]
