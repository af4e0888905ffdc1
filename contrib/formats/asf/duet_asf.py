#!/usr/bin/env python3
"""Converts motions in Acclaim's format (.amc with its .asf), such as CMU's, to BVH: duet_asf.py IN.amc OUT.bvh

The skeleton is 01_02.asf or 01.asf in the folder of 01_02.amc; --skeleton names another file. A bone's name denotes
the joint at its start (lfemur is the hip). Lengths become centimetres by the unit that the skeleton states.
"""

import argparse
import math
import pathlib
import sys
from typing import Dict, Iterator, List, NamedTuple, Optional, Sequence, Tuple

import numpy as np

CMU_RATE_HZ = 120.0  # the files do not state a rate
INCH_CM = 2.54
MOST_FRAMES, MOST_BONES = 200_000, 1024
_AXES = {"x": 0, "y": 1, "z": 2}


class Bone:
    """From the joint where it starts to the one where it ends."""

    def __init__(self, name: str = "") -> None:
        self.name = name
        self.parent = ""                # of the root: none
        self.direction = np.zeros(3)
        self.length = 0.0
        self.axes = np.eye(3)           # of its rotations, in the world's axes
        self.freedoms: List[str] = []   # tx ... rz, in the order of the motion's values

    @property
    def extent(self) -> np.ndarray:
        """From start to end at rest, in the world's axes and the file's unit."""
        norm = float(np.linalg.norm(self.direction))
        return self.direction * (self.length / norm if norm > 0 else 0)


class Skeleton(NamedTuple):
    bones: Dict[str, Bone]  # parents first; the first is the root
    position: np.ndarray    # of the root at rest
    radians: bool
    centimetres: float      # in one unit of the file


class FileError(ValueError):
    """A file cannot be read. The message names the file and the line."""


class _Lines:
    """The words of each line that has some, and errors that name the line."""

    def __init__(self, path: pathlib.Path) -> None:
        self.path, self.number = path, 0
        self._lines = path.read_text(encoding="utf-8-sig", errors="replace").splitlines()

    def __iter__(self) -> Iterator[List[str]]:
        for self.number, line in enumerate(self._lines, start=1):
            words = line.split()
            if words and not words[0].startswith("#"):
                yield words

    def error(self, message: str) -> FileError:
        return FileError(f"{self.path}:{self.number}: {message}")

    def numbers(self, words: Sequence[str], count: int) -> np.ndarray:
        """The numbers after the first word."""
        try:
            values = np.array([float(word) for word in words[1:]])
        except ValueError:
            values = np.array([math.nan])
        if len(values) != count or not (np.abs(values) <= 1e7).all():
            raise self.error(f"{words[0]}: expected {count} numbers, got {' '.join(words[1:])[:60]!r}")
        return values


def turn(axes: Sequence[int], angles: Sequence[float]) -> np.ndarray:
    """The product of rotations about axes 0 to 2, radians. The first axis applies first."""
    product = np.eye(3)
    for axis, angle in zip(axes, angles):
        i, j = (axis + 1) % 3, (axis + 2) % 3
        about = np.eye(3)
        about[i, i] = about[j, j] = math.cos(angle)
        about[j, i], about[i, j] = math.sin(angle), -math.sin(angle)
        product = about @ product
    return product


def read_skeleton(path: pathlib.Path) -> Skeleton:
    """Raises FileError for a malformed file, and if the bones are not a tree below the root."""
    lines = _Lines(path)
    bones = {"root": Bone("root")}
    position, orientation, root_order = np.zeros(3), np.zeros(3), "xyz"
    radians, units_per_inch, section = False, None, ""
    bone: Optional[Bone] = None  # whose block is open

    def order(text: str) -> List[int]:
        if sorted(text.lower()) != ["x", "y", "z"]:
            raise lines.error(f"axis: expected an order of axes such as XYZ, got {text!r}")
        return [_AXES[letter] for letter in text.lower()]

    def axes(text: str, angles: np.ndarray) -> np.ndarray:
        in_radians = angles if radians else np.radians(angles)
        places = order(text)
        return turn(places, in_radians[places])

    def freedoms(words: Sequence[str], known: Sequence[str]) -> List[str]:
        given = [word.lower() for word in words[1:]]
        if len(set(given)) < len(given) or not set(given) <= set(known):
            raise lines.error(f"{words[0]}: expected {' '.join(known)}, each at most once, got {words[1:]}")
        return given

    for words in lines:
        key = words[0]
        if key.startswith(":"):
            section = key.lower()
        elif section == ":units" and key == "length":
            [units_per_inch] = lines.numbers(words, 1)
        elif section == ":units" and key == "angle":
            radians = words[-1] == "rad"
        elif section == ":root":
            if key == "order":
                bones["root"].freedoms = freedoms(words, ["tx", "ty", "tz", "rx", "ry", "rz"])
            elif key == "axis":
                root_order = words[-1]
            elif key == "position":
                position = lines.numbers(words, 3)
            elif key == "orientation":
                orientation = lines.numbers(words, 3)
            bones["root"].axes = axes(root_order, orientation)
        elif section == ":bonedata":
            if key == "begin":
                bone = Bone()
            elif bone is None:
                raise lines.error(f"bone data: expected begin, got {key!r}")
            elif key == "end":
                if not bone.name or bone.name in bones or len(bones) >= MOST_BONES:
                    raise lines.error(f"name: expected a new bone, and at most {MOST_BONES}, got {bone.name!r}")
                bones[bone.name], bone = bone, None
            elif key == "name":
                bone.name = words[-1]
            elif key == "direction":
                bone.direction = lines.numbers(words, 3)
            elif key == "length":
                [bone.length] = lines.numbers(words, 1)
            elif key == "axis":
                bone.axes = axes(words[-1], lines.numbers(words[:-1], 3))
            elif key == "dof":
                bone.freedoms = freedoms(words, ["rx", "ry", "rz"])
        elif section == ":hierarchy" and words not in (["begin"], ["end"]):
            for name in words:
                if name not in bones:
                    raise lines.error(f"hierarchy: expected a bone, got {name!r}")
            for child in words[1:]:
                if bones[child].parent or child == "root":
                    raise lines.error(f"hierarchy: expected one parent for {child!r}, got two")
                bones[child].parent = key
    if bone is not None or len(bones) < 2:
        raise lines.error(":bonedata: expected at least 1 complete bone; is this an ASF file?")
    ordered = ["root"]
    for name in ordered:  # grows
        ordered += [child for child in bones if bones[child].parent == name]
    if len(ordered) < len(bones):
        raise lines.error(f"hierarchy: expected all {len(bones) - 1} bones below the root, got {len(ordered) - 1}")
    # Without a statement, the unit of CMU's files.
    scale = INCH_CM / (units_per_inch if units_per_inch and units_per_inch > 0 else 0.45)
    return Skeleton({name: bones[name] for name in ordered}, position, radians, scale)


def read_motion(path: pathlib.Path, skeleton: Skeleton) -> Tuple[np.ndarray, np.ndarray]:
    """The root's positions ``[frames, 3]`` in the file's unit, and each bone's rotation relative to its parent,
    ``[frames, bones, 3, 3]``. Raises FileError for a malformed file."""
    lines = _Lines(path)
    radians = skeleton.radians
    frames: List[Dict[str, np.ndarray]] = []
    moving = {name for name, bone in skeleton.bones.items() if bone.freedoms}

    def check_frame() -> None:
        lacking = moving - set(frames[-1]) if frames else set()
        if lacking:
            raise lines.error(f"frame {len(frames)}: expected values for {min(lacking)!r}, got none")

    for words in lines:
        name = words[0]
        if name.startswith(":"):
            radians = {":degrees": False, ":radians": True}.get(name.lower(), radians)
        elif name.isdigit():
            check_frame()
            frames.append({})
            if len(frames) > MOST_FRAMES:
                raise lines.error(f"expected at most {MOST_FRAMES} frames, got more")
        elif not frames or name not in skeleton.bones or name in frames[-1]:
            raise lines.error(f"expected a frame's number, or a bone of the skeleton once a frame, got {name!r}")
        else:
            frames[-1][name] = lines.numbers(words, len(skeleton.bones[name].freedoms))
    if not frames:
        raise lines.error("expected at least 1 frame, got none; is this an AMC file?")
    check_frame()
    positions = np.tile(skeleton.position, (len(frames), 1))
    rotations = np.tile(np.eye(3), (len(frames), len(skeleton.bones), 1, 1))
    for frame, values in enumerate(frames):
        for place, bone in enumerate(skeleton.bones.values()):
            axes, angles = [], []
            for freedom, value in zip(bone.freedoms, values.get(bone.name, ())):
                axis = _AXES[freedom[1]]
                if freedom[0] == "t":
                    positions[frame, axis] += value
                else:
                    axes.append(axis)
                    angles.append(value if radians else math.radians(value))
            rotations[frame, place] = bone.axes @ turn(axes, angles) @ bone.axes.T
    return positions, rotations


def joint_positions(skeleton: Skeleton, root: np.ndarray, rotations: np.ndarray) -> Dict[str, np.ndarray]:
    """``[frames, 3]`` in centimetres of the start of each bone, and of the end (``head.end``) of each bone without
    children."""
    world: Dict[str, np.ndarray] = {}
    at: Dict[str, np.ndarray] = {}
    ends: Dict[str, np.ndarray] = {}
    for place, bone in enumerate(skeleton.bones.values()):
        world[bone.name] = world[bone.parent] @ rotations[:, place] if bone.parent else rotations[:, place]
        at[bone.name] = ends[bone.parent] if bone.parent else root
        ends[bone.name] = at[bone.name] + world[bone.name] @ bone.extent
    parents = {bone.parent for bone in skeleton.bones.values()}
    at.update({f"{name}.end": end for name, end in ends.items() if name not in parents})
    return {name: positions * skeleton.centimetres for name, positions in at.items()}


def to_bvh(skeleton: Skeleton, root: np.ndarray, rotations: np.ndarray, rate_hz: float) -> str:
    """The motion as BVH in centimetres. Every bone is a joint at its start."""
    hierarchy, order = ["HIERARCHY"], []
    names = list(skeleton.bones)

    def add(name: str, depth: int) -> None:
        bone, indent = skeleton.bones[name], "  " * depth
        order.append(names.index(name))
        above = skeleton.bones[bone.parent].extent if bone.parent else np.zeros(3)
        channels = "3 " if bone.parent else "6 Xposition Yposition Zposition "
        hierarchy.extend([f"{indent}{'JOINT' if bone.parent else 'ROOT'} {name}", indent + "{",
                          f"{indent}  OFFSET {numbers(above * skeleton.centimetres)}",
                          f"{indent}  CHANNELS {channels}Zrotation Yrotation Xrotation"])
        children = [child for child in names if skeleton.bones[child].parent == name]
        for child in children:
            add(child, depth + 1)
        if not children:
            end = numbers(bone.extent * skeleton.centimetres)
            hierarchy.extend([f"{indent}  End Site", indent + "  {", f"{indent}    OFFSET {end}", indent + "  }"])
        hierarchy.append(indent + "}")

    def numbers(values: Sequence[float]) -> str:
        return " ".join(f"{value:.6g}" for value in values)

    add("root", 0)
    r = rotations[:, order]
    angles = np.degrees(np.stack([np.arctan2(r[..., 1, 0], r[..., 0, 0]), np.arcsin(np.clip(-r[..., 2, 0], -1, 1)),
                                  np.arctan2(r[..., 2, 1], r[..., 2, 2])], axis=-1)).reshape(len(root), -1)
    rows = np.concatenate([root * skeleton.centimetres, angles], axis=1)
    return "\n".join(hierarchy + ["MOTION", f"Frames: {len(rows)}", f"Frame Time: {1 / rate_hz:.9f}"]
                     + [" ".join(f"{value:.5f}" for value in row) for row in rows]) + "\n"


def skeleton_of(motion: pathlib.Path) -> pathlib.Path:
    """The skeleton in a motion's folder: 01_02.asf, then 01.asf for 01_02.amc."""
    names = [motion.stem + ".asf"] + [motion.stem.rpartition("_")[0] + ".asf"] * ("_" in motion.stem[1:])
    for name in names:
        if (motion.parent / name).exists():
            return motion.parent / name
    raise FileError(f"{motion}: skeleton: expected {' or '.join(names)} in the same folder, got none")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("motion", type=pathlib.Path, metavar="IN.amc")
    parser.add_argument("out", type=pathlib.Path, metavar="OUT.bvh")
    parser.add_argument("--skeleton", type=pathlib.Path, metavar="FILE.asf")
    parser.add_argument("--frame-rate", type=float, default=CMU_RATE_HZ, metavar="HZ",
                        help="of the motion (default: 120, as CMU's captures have)")
    options = parser.parse_args()
    try:
        skeleton = read_skeleton(options.skeleton or skeleton_of(options.motion))
        root, rotations = read_motion(options.motion, skeleton)
        options.out.write_text(to_bvh(skeleton, root, rotations, options.frame_rate), encoding="utf-8")
    except (OSError, FileError) as error:
        sys.exit(f"duet_asf: {error}")


if __name__ == "__main__":
    main()
