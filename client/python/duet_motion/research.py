"""Arrays of research: the layouts of HumanML3D, InterGen and Inter-X, and body models of the SMPL family.

>>> leader, = duet.research.read("000001.npy", layout="humanml3d")
>>> duet.research.write("pair.npy", [leader, follower], layout="intergen-262")

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
_WRITTEN = tuple(layout for layout in LAYOUTS if layout != "humanml3d-263")

# Source: Loper et al. 2015 (SMPL), Pavlakos et al. 2019 (SMPL-X). A foot is its ball.
JOINTS: Tuple[str, ...] = (
    "pelvis", "left_hip", "right_hip", "spine1", "left_knee", "right_knee", "spine2", "left_ankle",
    "right_ankle", "spine3", "left_foot", "right_foot", "neck", "left_collar", "right_collar", "head",
    "left_shoulder", "right_shoulder", "left_elbow", "right_elbow", "left_wrist", "right_wrist")
PARENTS = (-1, 0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 9, 9, 12, 13, 14, 16, 17, 18, 19)
_PELVIS, _LEFT_HIP, _RIGHT_HIP = 0, 1, 2
_FEET = [7, 10, 8, 11]  # left ankle and ball, right ankle and ball
_INTERHUMAN = 62 * 3 + 51 * 6
_MAX_POSITION = 1e7

# InterGen: the direction of the bone that ends at each joint in a T pose that faces z.
_T_REST = np.tile([0.0, 1.0, 0.0], (22, 1))
_T_REST[[1, 2]], _T_REST[[13, 14]] = [(0.6, -0.8, 0), (-0.6, -0.8, 0)], [(0.6, 0.8, 0), (-0.6, 0.8, 0)]
_T_REST[[16, 18, 20]], _T_REST[[17, 19, 21]] = (1, 0, 0), (-1, 0, 0)
_T_REST[[4, 5, 7, 8]] = (0, -1, 0)
_T_REST[[10, 11]] = np.array([0, -0.4, 0.9]) / np.hypot(0.4, 0.9)
_PRIOR_WEIGHT = 1e-3  # of a joint's rotation to be its parent's: decides the twist of a single bone


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
        layout: one of :data:`LAYOUTS`.

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
        layout: one of :data:`LAYOUTS` but ``"humanml3d-263"``: HumanML3D's own program makes these features of
            the positions.

    Raises:
        ValueError: joints are missing, or there is less than one frame of features.
    """
    rate = LAYOUTS[checked_choice("layout", layout, _WRITTEN)]
    bodies = [to_body(person).resampled(rate).positions.astype(np.float64) for person in people]
    if not 1 <= len(bodies) <= 2:
        raise ValueError(f"people: expected one or two, got {len(bodies)}")
    if layout == "intergen-262":
        if min(map(len, bodies)) < 2:
            raise ValueError(f"frames: expected at least 2 for layout {layout}, got fewer")
        bodies = [_intergen(body) for body in _at_intergen_start(bodies)]
    result: Positions = (bodies[0] if len(bodies) == 1 else np.stack(bodies)).astype(np.float32)
    return result


def read_smpl(motion: Path, body_model: Path, frame_rate_hz: Optional[float] = None) -> Motion:
    """Poses the joints of a body model (SMPL, SMPL+H, SMPL-X) by a motion of AMASS, SMPL or Inter-X.

    Args:
        motion: .npz with ``poses`` [frames, 66 or more], or ``root_orient`` (``global_orient``) and ``pose_body``
            (``body_pose``), in radians (axis times angle); and perhaps ``trans`` or ``transl``, ``betas``, and
            ``mocap_framerate``, ``mocap_frame_rate`` or ``fps``.
        body_model: .npz with ``v_template``, ``shapedirs``, ``kintree_table`` and a dense ``J_regressor``.
        frame_rate_hz: frames per second; overrides the file's, and is required if it states none.

    Raises:
        ValueError: an array is missing or has another shape.
        OSError: a file cannot be read.
    """
    with np.load(motion, allow_pickle=False) as file:
        poses = _first(file, "poses")
        if poses is None:
            root, body = _first(file, "root_orient", "global_orient"), _first(file, "pose_body", "body_pose")
            if root is None or body is None:
                raise ValueError(f"{motion}: expected poses, or root_orient and pose_body, got "
                                 f"{', '.join(file.files)}")
            poses = np.concatenate([root.reshape(len(root), -1), body.reshape(len(root), -1)], axis=1)
        poses = poses.reshape(len(poses), -1)
        trans = _first(file, "trans", "transl")
        betas = np.atleast_2d(np.zeros(1) if _first(file, "betas") is None else file["betas"])[0]
        rate = frame_rate_hz or _first(file, "mocap_framerate", "mocap_frame_rate", "fps")
    trans = np.zeros((len(poses), 3)) if trans is None else trans
    if poses.shape[1] < 66 or not len(poses) or trans.shape != (len(poses), 3):
        raise ValueError(f"{motion}: expected at least 66 numbers of pose and 3 of place for each frame, got "
                         f"{poses.shape} and {trans.shape}")
    if rate is None:
        raise ValueError(f"frame_rate_hz: expected a rate for {motion}, which states none, got None")
    rest = _rest_joints(body_model, betas)
    local = _axis_angles(poses[:, :66].reshape(-1, 22, 3).astype(np.float64))
    world, at = local.copy(), np.zeros((len(poses), 22, 3))
    at[:, 0] = rest[0] + trans
    for joint, parent in list(enumerate(PARENTS))[1:]:
        world[:, joint] = world[:, parent] @ local[:, joint]
        at[:, joint] = at[:, parent] + world[:, parent] @ (rest[joint] - rest[parent])
    upwards = (at[:, _PELVIS] - at[:, [7, 8]].mean(axis=1)).mean(axis=0)
    return Motion(at, JOINTS, float(rate), up_axis="z-up" if np.argmax(np.abs(upwards)) == 2 else "y-up")


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


def _at_intergen_start(people: Sequence[Array]) -> List[Array]:
    """Everybody's lowest joint on the floor; the first person at x = z = 0, facing z across the hips."""
    first = people[0][0]
    return [_placed(person, first[_PELVIS], first[_RIGHT_HIP] - first[_LEFT_HIP]) for person in people]


def _intergen(at: Array) -> Array:
    """InterGen's 262 numbers for each frame t but the last, of a placed person:

    0-65 positions; 66-131 ways to t + 1; 132-257 rotations of joints 1 to 21 relative to their parents, each as
    the rows of the first two columns of its matrix; 258-261 whether ankles and balls of the feet stay on the floor.

    Source: Liang et al. 2024, "InterGen: diffusion-based multi-human motion generation under complex
    interactions", and process_motion_np of github.com/tr3e/InterGen, written anew from its definition. InterGen
    copies the rotations from the fit of a body model. Positions do not hold them: here they are those of a person
    whose rest pose is a T pose, with the least rotation from parent to child that the bones allow.
    """
    count = len(at) - 1
    world = np.zeros((len(at), 22, 3, 3))
    local = np.zeros_like(world)
    start = _about_y(-_heading(np.cross([0, 1, 0], at[:, _RIGHT_HIP] - at[:, _LEFT_HIP])))
    for joint, parent in enumerate(PARENTS):
        above = start if parent < 0 else world[:, parent]
        world[:, joint] = above
        children = [child for child in range(22) if PARENTS[child] == joint]
        if children:
            bones = _unit(at[:, children] - at[:, joint:joint + 1], _T_REST[children])
            world[:, joint] = _nearest_rotation(
                np.einsum("tci,cj->tij", bones, _T_REST[children]) + _PRIOR_WEIGHT * above)
        local[:, joint] = np.swapaxes(above, 1, 2) @ world[:, joint]
    stays = (_squared_ways(at) < 0.001) & (at[:-1, _FEET, 1] < [0.12, 0.05, 0.12, 0.05])
    return np.concatenate([at[:-1].reshape(count, -1), (at[1:] - at[:-1]).reshape(count, -1),
                           local[:-1, 1:, :, :2].reshape(count, -1), stays], axis=1)


def _rest_joints(body_model: Path, betas: Array) -> Array:
    """``[22, 3]``: J_regressor (v_template + shapedirs betas), Loper et al. 2015, equations 8 and 10."""
    with np.load(body_model, allow_pickle=False) as file:
        lacking = {"v_template", "J_regressor", "kintree_table"} - set(file.files)
        if lacking:
            raise ValueError(f"{body_model}: expected {', '.join(sorted(lacking))}, got {', '.join(file.files)}")
        vertices, regressor, table = file["v_template"], file["J_regressor"], file["kintree_table"]
        if betas.any():
            shapes = file["shapedirs"]
            vertices = vertices + shapes[..., :len(betas)] @ betas[:shapes.shape[-1]]
    if table.ndim != 2 or tuple(table[0, 1:22]) != PARENTS[1:]:
        raise ValueError(f"{body_model}: kintree_table: expected the parents of SMPL, SMPL+H or SMPL-X, got others")
    if regressor.ndim != 2 or len(regressor) < 22 or vertices.shape != (regressor.shape[1], 3):
        raise ValueError(f"{body_model}: expected J_regressor (22 or more joints, vertices) and v_template "
                         f"(vertices, 3), got {regressor.shape} and {vertices.shape}")
    rest: Array = regressor[:22] @ vertices
    return rest


def _first(file: Mapping[str, Array], *names: str) -> Optional[Array]:
    return next((file[name] for name in names if name in file), None)


def _placed(body: Array, origin: Array, across: Array) -> Array:
    """On the floor, with `origin` at x = z = 0, and turned so that `across` is the line of one who faces z."""
    moved = body - origin * [1, 0, 1] - [0, body[..., 1].min(), 0]
    placed: Array = moved @ _about_y(_heading(np.cross([0, 1, 0], across))).T
    return placed


def _squared_ways(at: Array) -> Array:
    ways: Array = ((at[1:, _FEET] - at[:-1, _FEET]) ** 2).sum(axis=-1)
    return ways


def _heading(ahead: Array) -> Array:
    """The angle about y that takes a horizontal direction to z."""
    return np.asarray(-np.arctan2(ahead[..., 0], ahead[..., 2]))


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


def _nearest_rotation(matrices: Array) -> Array:
    """The rotations R that maximise trace(R^T matrix) (Kabsch)."""
    u, _, vt = np.linalg.svd(matrices)
    u[..., -1] *= np.linalg.det(u @ vt)[..., None]
    rotations: Array = u @ vt
    return rotations


def _axis_angles(v: Array) -> Array:
    """``[..., 3, 3]`` from axis times angle."""
    angle = np.linalg.norm(v, axis=-1)[..., None, None]
    k = _skew(v) / np.maximum(angle, 1e-12)
    rotations: Array = np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * k @ k
    return rotations


def _skew(v: Array) -> Array:
    x, y, z = np.moveaxis(v, -1, 0)
    zero = np.zeros_like(x)
    rows: Array = np.stack([zero, -z, y, z, zero, -x, -y, x, zero], axis=-1)
    return rows.reshape(x.shape + (3, 3))


def _along(path: Sequence[Array], share: float) -> Array:
    """``[frames, 3]``: the place at a share of the length of a path."""
    points = np.stack(path, axis=1)
    lengths = np.linalg.norm(np.diff(points, axis=1), axis=-1)
    left = share * lengths.sum(axis=1, keepdims=True) - np.cumsum(lengths, axis=1) + lengths
    inside = np.clip(left / np.maximum(lengths, 1e-12), 0, 1)
    moved: Array = points[:, 0] + (inside[..., None] * np.diff(points, axis=1)).sum(axis=1)
    return moved
