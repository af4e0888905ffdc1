"""From the joints of a capture to those of a model."""

from typing import Mapping, Optional, Sequence

import numpy as np

# A model's joint, without its side, and the capture's.
_LIMBS = {"shoulder": "UpperArm", "elbow": "LowerArm", "wrist": "Hand", "hand": "Hand", "hip": "UpperLeg",
          "knee": "LowerLeg", "ankle": "Foot", "foot": "Foot", "toe": "Toes"}
# The places of a model's joints of the trunk on the way from the middle of the hip joints to the neck; the
# capture's spine joint nearest to that place is used.
_TRUNK = {"torso": 0.5, "chest": 0.77, "spine": 0.46}
# Fractions of the distance from hips to neck: capture software has the head's joint at the base of the
# skull, and models in the middle of the head; and the top of the head above its joint.
_HEAD_RISE, _HEAD_TOP_RISE = 0.19, 0.22
_HAND_REACH = 0.3  # of the knuckles beyond the wrist, as a fraction of the forearm


class BodyMap:
    """Positions of a model's joints from those of a capture: ``[model joints, 3]`` are linear combinations of
    ``[capture joints, 3]``, chosen with the first frame.

    Args:
        capture_joints: names of the reader's joints, as in frames.BONES; several joints of the spine begin
            with ``Spine`` or end with ``Chest``.
        model_joints: names of the model's joints.
        first: ``[capture joints, 3]``, metres.
        overrides: from joints of the model to joints of the capture.

    Raises:
        ValueError: no joint of the capture is known for a joint of the model.
    """

    def __init__(self, capture_joints: Sequence[str], model_joints: Sequence[str], first: np.ndarray,
                 overrides: Mapping[str, str]) -> None:
        self._names = list(capture_joints)
        self._first = first
        self._model = set(model_joints)
        for joint, name in overrides.items():
            if joint not in self._model or name not in self._names:
                raise ValueError(f"--joint {joint}={name}: expected MODEL=CAPTURE with one of "
                                 f"{', '.join(model_joints)} and one of {', '.join(self._names)}")
        rows = {joint: self._one(overrides[joint]) if joint in overrides else self._row(joint)
                for joint in model_joints}
        unknown = [joint for joint, row in rows.items() if row is None]
        if unknown:
            raise ValueError(f"joints: expected joints for {', '.join(unknown)}, got none; the capture has "
                             f"{', '.join(self._names)}; specify --joint {unknown[0]}=NAME")
        self.weights = np.array([rows[joint] for joint in model_joints])

    def apply(self, positions: np.ndarray) -> np.ndarray:
        """``[model joints, 3]``"""
        return self.weights @ positions

    def _one(self, name: str) -> np.ndarray:
        return np.eye(len(self._names))[self._names.index(name)]

    def _row(self, joint: str) -> Optional[np.ndarray]:
        hips = (self._one("LeftUpperLeg") + self._one("RightUpperLeg")) / 2
        neck, head = self._one("Neck"), self._one("Head")
        spine_length = float(np.linalg.norm((neck - hips) @ self._first))
        side, _, part = joint.partition("_")
        if side in ("left", "right") and part in _LIMBS:
            row = self._one(side.capitalize() + _LIMBS[part])
            if part == "hand" and f"{side}_wrist" in self._model:
                row += _HAND_REACH * (row - self._one(side.capitalize() + "LowerArm"))
            return row
        if joint == "head" and "head_top" not in self._model:
            neck_length = max(float(np.linalg.norm((head - neck) @ self._first)), 0.05 * spine_length)
            return head + _HEAD_RISE * spine_length / max(neck_length, 1e-6) * (head - neck)
        if joint in _TRUNK:
            place = hips + _TRUNK[joint] * (neck - hips)
            spine = [self._one(name) for name in self._names
                     if name.startswith("Spine") or name.endswith("Chest")]
            return min(spine, key=lambda row: float(np.linalg.norm((row - place) @ self._first)))
        return {"head": head, "neck": neck, "hips": self._one("Hips"),
                "head_top": head + _HEAD_TOP_RISE * (neck - hips)}.get(joint)
