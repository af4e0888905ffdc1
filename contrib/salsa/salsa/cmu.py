"""The takes of the salsa couple from the files of the CMU motion capture database.

Subject 60 leads, subject 61 follows: 60.asf, 60_01.amc and so on, 61.asf, 61_01.amc and so on, in
one folder. `contrib/formats/asf/duet_asf.py` converts the files to BVH, which `duet convert` reads.
"""

import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy

from salsa.dataset_folder import joint_name
from salsa.takes import FOLLOW, LEAD, Take, TakesError

CONVERTER = Path(__file__).resolve().parents[2] / "formats" / "asf" / "duet_asf.py"
SUBJECTS = {LEAD: "60", FOLLOW: "61"}
FRAME_RATE_HZ = 60  # of these two subjects; the files do not state it
UNEQUAL_SECONDS = 0.1  # two recordings of one take may differ by this much; the longer one is cut

# The joint of the takes at the start of each bone of the files, and its parent.
_TRUNK = {"Hips": ("root", None), "Spine": ("upperback", "Hips"), "Chest": ("thorax", "Spine"),
          "Neck": ("lowerneck", "Chest"), "Head": ("head", "Neck"), "HeadTop": ("head.end", "Head")}
_LIMBS = (("Chest", (("Shoulder", "humerus"), ("Elbow", "radius"), ("Wrist", "wrist"),
                     ("Hand", "hand"))),
          ("Hips", (("Hip", "femur"), ("Knee", "tibia"), ("Ankle", "foot"), ("Toe", "toes"))))


def _joints():
    """{joint: (bone, parent joint)}, parents first."""
    joints = dict(_TRUNK)
    for beginning, limb in _LIMBS:
        for side in "LR":
            parent = beginning
            for name, bone in limb:
                joints[side + name] = (side.lower() + bone, parent)
                parent = side + name
    return joints


_BONES = _joints()
JOINTS = tuple(_BONES)
PARENTS = tuple(JOINTS.index(parent) if parent else -1 for _, parent in _BONES.values())


def _write_reading(folder):
    """What `duet convert` needs to find the joints: (skeleton, joint map)."""
    names = [joint_name(joint) for joint in JOINTS]
    skeleton, joint_map = folder / "skeleton.json", folder / "joints.txt"
    skeleton.write_text(json.dumps({
        "joint_names": names,
        "bones": [[parent, joint] for joint, parent in enumerate(PARENTS) if parent >= 0],
        "leader": [[[0, 0, 0]] * len(names)] * 2}), encoding="utf-8")
    joint_map.write_text("".join(f"{name}={bone}\n"
                                 for name, (bone, _) in zip(names, _BONES.values())),
                         encoding="utf-8")
    return skeleton, joint_map


def _read_motion(duet, file, folder, reading):
    """[frames, joints, 3] in metres, y up, in the world of the capture."""
    bvh, out = folder / f"{file.stem}.bvh", folder / "motion.npy"
    _run([sys.executable, str(CONVERTER), str(file), str(bvh), "--frame-rate", str(FRAME_RATE_HZ)], file)
    _run([duet, "convert", str(bvh), "--skeleton", str(reading[0]), "--joint-map", str(reading[1]),
          "--up-axis", "y-up", "--out", str(out), "--quiet"], file)
    return numpy.load(out).astype(float)


def _run(command, file):
    try:
        done = subprocess.run(command, capture_output=True, text=True, check=False)
    except OSError as error:
        raise TakesError(f"--duet: expected the program duet, got {command[0]}: "
                         f"{error.strerror}") from None
    if done.returncode != 0:
        raise TakesError(re.sub(r"^duet\w*: ", "", done.stderr.strip()) or f"{file}: cannot be read")


def _pairs(folder):
    """[(take, {person: file})]; every take has both people."""
    files = {person: {} for person in SUBJECTS}
    for person, subject in SUBJECTS.items():
        for file in folder.glob(f"{subject}_*.amc"):
            if re.fullmatch(subject + r"_\d+", file.stem):
                files[person][file.stem.split("_")[1]] = file
    takes = sorted(files[LEAD].keys() | files[FOLLOW].keys())
    if not takes:
        raise TakesError(f"{folder}: expected {SUBJECTS[LEAD]}_NN.amc and {SUBJECTS[FOLLOW]}_NN.amc,"
                         " got neither")
    for take in takes:
        for person, subject in SUBJECTS.items():
            if take not in files[person]:
                raise TakesError(f"{folder / f'{subject}_{take}.amc'}: expected a file, as the "
                                 "partner's exists, got none")
    return [(take, {person: files[person][take] for person in SUBJECTS}) for take in takes]


def _equally_long(take, files, people):
    counts = [len(positions) for positions in people]
    if max(counts) - min(counts) > UNEQUAL_SECONDS * FRAME_RATE_HZ:
        raise TakesError(f"{files[FOLLOW]}: expected {counts[0]} frames, as "
                         f"{files[LEAD].name} has, got {counts[1]}")
    lead, follow = (positions[:min(counts)] for positions in people)
    return Take(take, lead, follow, JOINTS, FRAME_RATE_HZ)


def read_folder(folder, duet):
    """Every take of both subjects in `folder`. `duet`: the program that reads the files."""
    takes = []
    with tempfile.TemporaryDirectory() as temporary:
        temporary = Path(temporary)
        reading = _write_reading(temporary)
        for take, files in _pairs(Path(folder)):
            people = [_read_motion(duet, files[person], temporary, reading)
                      for person in (LEAD, FOLLOW)]
            takes.append(_equally_long(take, files, people))
    return takes
