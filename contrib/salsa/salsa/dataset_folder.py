"""Writes a data set in the layout of docs/datasets.md: whole takes, classes on a time line."""

import json

from salsa.moves import CLASSES, spans

# Duet's names of the joints of the takes.
_MIDDLE = {"Hips": "hips", "Spine": "spine", "Chest": "chest", "Neck": "neck", "Head": "head",
           "HeadTop": "head_top"}
_SIDES = {"L": "left", "R": "right"}
_LIMBS = {"arm": ("Shoulder", "Elbow", "Wrist", "Hand"), "leg": ("Hip", "Knee", "Ankle", "Toe")}


def joint_name(name):
    """`left_wrist` of LWrist."""
    return _MIDDLE.get(name) or f"{_SIDES[name[0]]}_{name[1:].lower()}"


def _parts():
    trunk = {"name": "trunk", "joints": list(_MIDDLE.values())}
    return [trunk] + [{"name": f"{_SIDES[side]}_{limb}",
                       "joints": [joint_name(side + joint) for joint in joints]}
                      for limb, joints in _LIMBS.items() for side in _SIDES]


def layout(joints, parents, frame_rate_hz):
    """The content of dataset.json. `parents`: the index of each joint's parent, -1 for the root."""
    names = [joint_name(joint) for joint in joints]
    return {
        "name": "salsa",
        "frame_rate_hz": frame_rate_hz,
        "unit": "metres",
        "up_axis": "y-up",
        "skeleton": {
            "joint_names": names,
            "bones": [[names[parent], names[joint]] for joint, parent in enumerate(parents)
                      if parent >= 0],
            "parts": _parts(),
            "root": "hips",
            "left_hip": "left_hip", "right_hip": "right_hip",
            "left_foot": "left_ankle", "right_foot": "right_ankle",
        },
        # Hands are held and bodies meet in every class.
        "classes": [{"name": name, "touches": True} for name in CLASSES],
    }


def _sequence(take):
    """One line for each frame: its number, the lead's positions, the follower's."""
    lines = []
    for frame, (lead, follow) in enumerate(zip(take.lead, take.follow)):
        values = ",".join(f"{value:.4f}" for value in (*lead.reshape(-1), *follow.reshape(-1)))
        lines.append(f"{frame},{values}\n")
    return "".join(lines)


def write(takes, parents, out):
    """Writes dataset.json, index.tsv, labels.tsv and takes/NN.txt to the new folder `out`."""
    (out / "takes").mkdir(parents=True)
    document = layout(takes[0].joints, parents, takes[0].frame_rate_hz)
    (out / "dataset.json").write_text(json.dumps(document, indent=1) + "\n", encoding="utf-8")
    index = ["path\tleader_side\tsubjects\n"]
    labels = ["path\tclass\tfrom_seconds\tto_seconds\n"]
    for take in takes:
        path = f"takes/{take.name}.txt"
        (out / path).write_text(_sequence(take), encoding="utf-8")
        # A take counts as a subject, so that whole takes can be left out.
        index.append(f"{path}\tleft\ttake_{take.name.split('_')[0]}\n")
        labels += [f"{path}\t{label}\t{begin / take.frame_rate_hz:.3f}\t"
                   f"{end / take.frame_rate_hz:.3f}\n" for label, begin, end in spans(take)]
    (out / "index.tsv").write_text("".join(index), encoding="utf-8")
    (out / "labels.tsv").write_text("".join(labels), encoding="utf-8")
