"""Writes a data set in the layout of docs/datasets.md: pairs, with classes on a time line."""

import json

# Who may lead, and whether bodies may meet. Mirroring is safe in every class.
CLASSES = {
    "meet_hands": {"symmetric": True, "touches": True},
    "pull": {"touches": True},
    "walk": {"symmetric": True, "touches": True},
}

# Duet's names of the joints of the archives.
_MIDDLE = {"Hips": "hips", "Spine": "spine", "Chest": "chest", "Neck": "neck", "Head": "head",
           "HeadTop": "head_top"}
_SIDES = {"L": "left", "R": "right"}
_LIMBS = {"arm": ("Shoulder", "Elbow", "Wrist", "Hand"), "leg": ("Hip", "Knee", "Ankle", "Toe")}


def joint_name(name):
    """`left_wrist` of LWrist."""
    return _MIDDLE.get(name) or f"{_SIDES[name[0]]}_{name[1:].lower()}"


def skeleton(joints, parents):
    """The field `skeleton` of dataset.json. `parents`: indices, -1 for the root."""
    names = [joint_name(joint) for joint in joints]
    limbs = [{"name": f"{_SIDES[side]}_{limb}",
              "joints": [joint_name(side + joint) for joint in parts]}
             for limb, parts in _LIMBS.items() for side in _SIDES]
    return {
        "joint_names": names,
        "bones": [[names[parent], names[joint]] for joint, parent in enumerate(parents)
                  if parent >= 0],
        "parts": [{"name": "trunk", "joints": list(_MIDDLE.values())}] + limbs,
        "root": "hips",
        "left_hip": "left_hip", "right_hip": "right_hip",
        "left_foot": "left_ankle", "right_foot": "right_ankle",
    }


def _sequence(pair):
    """One line for each frame: its number, the positions of the two people."""
    return "".join(f"{frame}," + ",".join(f"{value:.4f}" for person in poses
                                          for value in person.reshape(-1)) + "\n"
                   for frame, poses in enumerate(zip(*pair.people)))


def write(pairs, joints, parents, rate, out):
    """Writes dataset.json, index.tsv, labels.tsv and pairs/NAME.txt to the new folder `out`."""
    (out / "pairs").mkdir(parents=True)
    document = {"name": "everyday", "frame_rate_hz": rate, "unit": "metres", "up_axis": "y-up",
                "skeleton": skeleton(joints, parents),
                "classes": [{"name": name, **flags} for name, flags in CLASSES.items()]}
    (out / "dataset.json").write_text(json.dumps(document, indent=1) + "\n", encoding="utf-8")
    index, labels = ["path\tleader_side\tsubjects\n"], ["path\tclass\tfrom_seconds\tto_seconds\n"]
    for pair in pairs:
        path = f"pairs/{pair.name}.txt"
        (out / path).write_text(_sequence(pair), encoding="utf-8")
        index.append(f"{path}\t{('left', 'right')[pair.leader]}\t{','.join(pair.subjects)}\n")
        labels += [f"{path}\t{name}\t{begin:.3f}\t{end:.3f}\n" for name, begin, end in pair.spans]
    (out / "index.tsv").write_text("".join(index), encoding="utf-8")
    (out / "labels.tsv").write_text("".join(labels), encoding="utf-8")
