"""Arrays of research: the layouts of HumanML3D, InterGen and Inter-X.

>>> leader, = duet.research.read("000001.npy", layout="humanml3d")
>>> duet.research.write("pair.npy", [leader, follower], layout="intergen")

docs/guides/research_layouts.md lists shapes, rates and what the features keep. People have the 22 body joints
that SMPL, SMPL+H and SMPL-X share (:data:`JOINTS`). Write them to a .json or .csv file to read them with
:func:`duet_motion.read_motion`, `duet` or `duet-import`, which find their own joints by name.
"""

from __future__ import annotations

import os
from typing import Any, Dict, List, Mapping, Optional, Sequence, Tuple, Union

import numpy as np
import numpy.typing as npt

from duet_motion.motion import Motion, Positions, checked_array, checked_choice

Array = npt.NDArray[Any]
Path = Union[str, "os.PathLike[str]"]

LAYOUTS: Mapping[str, float] = {"humanml3d": 20.0, "humanml3d-263": 20.0, "intergen": 30.0,
                                "intergen-262": 30.0, "inter-x": 30.0}
"""The layouts and their frame rates."""
_WRITTEN = ("humanml3d", "intergen", "inter-x")

# Source: Loper et al. 2015 (SMPL), Pavlakos et al. 2019 (SMPL-X). A foot is its ball.
JOINTS: Tuple[str, ...] = (
    "pelvis", "left_hip", "right_hip", "spine1", "left_knee", "right_knee", "spine2", "left_ankle",
    "right_ankle", "spine3", "left_foot", "right_foot", "neck", "left_collar", "right_collar", "head",
    "left_shoulder", "right_shoulder", "left_elbow", "right_elbow", "left_wrist", "right_wrist")
_INTERHUMAN = 62 * 3 + 51 * 6
_MAX_POSITION = 1e7


def read(source: Union[Path, npt.ArrayLike], layout: str = "",
         frame_rate_hz: Optional[float] = None) -> List[Motion]:
    """Reads one person or two from an array of a layout, in metres.

    Args:
        source: a .npy file, or the array. Features of a network must be multiplied by the data set's ``Std``
            and have its ``Mean`` added before.
        layout: one of :data:`LAYOUTS`. Empty: recognised by a width that no other layout has (263, 262, 524
            or 492 numbers in a row).
        frame_rate_hz: frames per second; overrides the layout's.

    Raises:
        ValueError: the array has another shape, or holds a value that is no position.
        OSError: the file cannot be read.
    """
    array = checked_array("array", np.load(source, allow_pickle=False)
                          if isinstance(source, (str, os.PathLike)) else source).astype(np.float64)
    if not layout:
        layout = {263: "humanml3d-263", 262: "intergen-262", 524: "intergen-262",
                  _INTERHUMAN: "intergen"}.get(array.shape[-1] if array.ndim > 1 else 0, "")
        if not layout:
            raise ValueError(f"layout: expected one of {', '.join(LAYOUTS)} for an array of shape "
                             f"{array.shape}, got none")
    checked_choice("layout", layout, LAYOUTS)
    up_axis = "y-up"
    if layout == "humanml3d-263" and array.ndim == 2 and array.shape[1] == 263:
        people = _from_humanml3d(array)[np.newaxis]
    elif layout == "intergen-262" and array.ndim == 2 and array.shape[1] == 524:
        people = np.stack(np.split(array, 2, axis=1))[..., :66]
    elif layout == "intergen-262" and array.ndim in (2, 3) and array.shape[-1] == 262:
        people = array[..., :66]
    elif layout == "intergen" and array.ndim == 2 and array.shape[1] == _INTERHUMAN:
        people, up_axis = array[:, :66], "z-up"
    elif layout not in ("humanml3d-263", "intergen-262") and array.ndim > 1 and (
            array.shape[-1] == 66 or array.shape[-2:] in ((22, 3), (24, 3), (52, 3), (55, 3))):
        people = array if array.shape[-1] == 66 else array[..., :22, :]
    else:
        raise ValueError(f"array: expected a shape of layout {layout}, got {array.shape}")
    positional = people.shape[-2:] == (22, 3)
    people = people.reshape((-1,) + people.shape[people.ndim - (3 if positional else 2):])
    if len(people) > 2 or people.shape[1] < 1:
        raise ValueError(f"array: expected one person or two and at least one frame, got {array.shape}")
    people = people.reshape(len(people), -1, 22, 3)
    if not (np.abs(people) <= _MAX_POSITION).all():
        raise ValueError(f"array: expected finite positions within {_MAX_POSITION:g} m, got others")
    return [Motion(person, JOINTS, frame_rate_hz or LAYOUTS[layout], up_axis=up_axis) for person in people]


def write(path: Path, people: Sequence[Motion], layout: str) -> None:
    """Writes the array of :func:`to_array` as a .npy file.

    Args:
        path: of the file.
        people: one person or two.
        layout: see :func:`to_array`.

    Raises:
        ValueError: see :func:`to_array`.
        OSError: the file cannot be written.
    """
    np.save(path, to_array(people, layout))


def to_array(people: Sequence[Motion], layout: str) -> Positions:
    """The array of a layout, at its frame rate. Joints that a motion lacks are estimated from the others
    (:func:`to_body`).

    Args:
        people: one person or two, in metres or millimetres.
        layout: ``"humanml3d"``, ``"intergen"`` or ``"inter-x"``: the data sets' own programs make features of
            the positions.

    Raises:
        ValueError: joints are missing.
    """
    rate = LAYOUTS[checked_choice("layout", layout, _WRITTEN)]
    bodies = [to_body(person).resampled(rate).positions.astype(np.float64) for person in people]
    if not 1 <= len(bodies) <= 2:
        raise ValueError(f"people: expected one or two, got {len(bodies)}")
    result: Positions = (bodies[0] if len(bodies) == 1 else np.stack(bodies)).astype(np.float32)
    return result


def to_body(person: Motion) -> Motion:
    """The 22 body joints of a motion, in metres, y up.

    A motion that has all of them keeps them. Otherwise joints are taken by their meaning (wrist or hand, ankle
    or foot, toe). Pelvis and spine are placed on the way from the hips to the neck, collars between neck, spine
    and shoulder, the head's joint half way from the neck to the head's middle, and a missing ball of the foot
    ahead of the ankle at a right angle to the shin.

    Args:
        person: a motion with other joints, such as those of Duet's models.

    Raises:
        ValueError: joints are missing.
    """
    person = person.converted()
    if set(JOINTS) <= set(person.joint_names):
        return person.select(JOINTS)
    lacking: List[str] = []

    def find(*names: str) -> Array:
        for name in names:
            if name in person.joint_names:
                return person.joint(name).astype(np.float64)
        lacking.append(names[0])
        return np.zeros((person.frame_count, 3))

    body: Dict[str, Array] = {"neck": find("neck")}
    for side in ("left", "right"):
        for joint, *names in (("shoulder", "shoulder"), ("elbow", "elbow"), ("wrist", "wrist", "hand"),
                              ("hip", "hip"), ("knee", "knee"), ("ankle", "ankle", "foot")):
            body[f"{side}_{joint}"] = find(*(f"{side}_{name}" for name in names))
    body["head"] = (body["neck"] + find("head")) / 2
    if lacking:
        raise ValueError(f"joints: expected {', '.join(lacking)}, got only {', '.join(person.joint_names)}")
    hips = (body["left_hip"] + body["right_hip"]) / 2
    path = [hips] + [find(name) for name in ("spine", "torso", "chest") if name in person.joint_names]
    path.append(body["neck"])
    pelvis = [name for name in ("hips", "pelvis") if name in person.joint_names]
    path[0] = find(*pelvis) if pelvis else _along(path, 0.15)
    body["pelvis"] = path[0]
    for name, share in (("spine1", 0.21), ("spine2", 0.48), ("spine3", 0.58)):
        body[name] = _along(path, share)
    ahead = _unit(np.cross([0, 1, 0], body["right_hip"] - body["left_hip"]), (0, 0, 1))
    for side in ("left", "right"):
        ankle = body[f"{side}_ankle"]
        shin = _unit(ankle - body[f"{side}_knee"], (0, -1, 0))
        flat = _unit(ahead - shin * (ahead * shin).sum(axis=-1, keepdims=True), ahead)
        toe = f"{side}_toe"
        body[f"{side}_foot"] = find(toe) if toe in person.joint_names else ankle + 0.13 * flat + 0.06 * shin
        body[f"{side}_collar"] = 0.25 * (body["neck"] + body["spine3"]) + 0.5 * body[f"{side}_shoulder"]
    return Motion(np.stack([body[name] for name in JOINTS], axis=1), JOINTS, person.frame_rate_hz)


def _from_humanml3d(features: Array) -> Array:
    """``[frames, 22, 3]``: the positions that the numbers 0 to 66 describe."""
    angles = -2 * np.concatenate([[0.0], np.cumsum(features[:-1, 0])])
    back = _about_y(angles)
    steps = np.zeros((len(features), 1, 3))
    steps[1:, 0, 0], steps[1:, 0, 2] = features[:-1, 1], features[:-1, 2]
    root = np.cumsum(_rotated(back, steps), axis=0)
    joints = _rotated(back, features[:, 4:67].reshape(-1, 21, 3)) + root
    return np.concatenate([root + features[:, None, 3:4] * [0, 1, 0], joints], axis=1)


def _about_y(angle: Array) -> Array:
    """``[..., 3, 3]``"""
    c, s, zero, one = np.cos(angle), np.sin(angle), np.zeros_like(angle), np.ones_like(angle)
    rows: Array = np.stack([c, zero, s, zero, one, zero, -s, zero, c], axis=-1)
    return rows.reshape(np.shape(angle) + (3, 3))


def _rotated(turns: Array, points: Array) -> Array:
    """``[frames, joints, 3]``: the points of each frame, rotated by its matrix."""
    return np.asarray(points @ np.swapaxes(turns, 1, 2))


def _unit(v: Array, otherwise: npt.ArrayLike) -> Array:
    length = np.linalg.norm(v, axis=-1, keepdims=True)
    return np.asarray(np.where(length > 1e-9, v / np.maximum(length, 1e-9), otherwise))


def _along(path: Sequence[Array], share: float) -> Array:
    """``[frames, 3]``: the place at a share of the length of a path."""
    points = np.stack(path, axis=1)
    lengths = np.linalg.norm(np.diff(points, axis=1), axis=-1)
    left = share * lengths.sum(axis=1, keepdims=True) - np.cumsum(lengths, axis=1) + lengths
    inside = np.clip(left / np.maximum(lengths, 1e-12), 0, 1)
    moved: Array = points[:, 0] + (inside[..., None] * np.diff(points, axis=1)).sum(axis=1)
    return moved
