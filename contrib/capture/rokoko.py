"""Reads the live stream of Rokoko Studio: JSON v3, plain or as an LZ4 frame."""

import json
from typing import Any, List, Optional

import numpy as np

from frames import MAX_POSITION, MAX_SECONDS, MIRROR, Frame, Reader, checked

try:
    import lz4.frame
except ImportError:
    lz4 = None

MAX_JSON_BYTES = 512 * 1024  # decompressed
_LZ4_MAGIC = b"\x04\x22\x4d\x18"
_HINT = "; in Rokoko Studio, select the format JSON v3"
# Rokoko's joints and the bones of frames.BONES that they are.
_JOINTS = {"hip": "Hips", "spine": "Spine", "chest": "Chest", "neck": "Neck", "head": "Head",
           "leftShoulder": "LeftShoulder", "leftUpperArm": "LeftUpperArm",
           "leftLowerArm": "LeftLowerArm", "leftHand": "LeftHand", "rightShoulder": "RightShoulder",
           "rightUpperArm": "RightUpperArm", "rightLowerArm": "RightLowerArm",
           "rightHand": "RightHand", "leftUpLeg": "LeftUpperLeg", "leftLeg": "LeftLowerLeg",
           "leftFoot": "LeftFoot", "leftToe": "LeftToes", "rightUpLeg": "RightUpperLeg",
           "rightLeg": "RightLowerLeg", "rightFoot": "RightFoot", "rightToe": "RightToes"}


class RokokoReader(Reader):
    """Joints are at world positions in Unity's left-handed axes. Every datagram is a frame. Toes that an
    actor does not have are placed at the feet. The first actor with a body leads, and later the actor of
    the same name; others are ignored."""

    joint_names = list(_JOINTS.values())

    def __init__(self) -> None:
        super().__init__()
        self._actor: Optional[str] = None
        self._others = self._no_toes = False

    def read(self, datagram: bytes) -> List[Frame]:
        try:
            scene = _field(json.loads(_decompressed(datagram)), "scene")
        except (UnicodeDecodeError, json.JSONDecodeError, RecursionError) as error:
            raise ValueError(f"Rokoko: expected JSON, got an error: {error}{_HINT}") from None
        actors = _field(scene, "actors")
        if not isinstance(actors, list):
            raise ValueError(f"Rokoko: scene.actors: expected a list, got {_shown(actors)}{_HINT}")
        for actor in actors:
            body = _field(actor, "body")
            if not isinstance(body, dict) or _field(_field(actor, "meta"), "hasBody") is False:
                continue
            name = str(_field(actor, "name") or "")
            if self._actor not in (None, name):
                if not self._others:
                    self.notes.append(f"Rokoko: {self._actor!r} leads; the other actors of the scene are "
                                      "ignored")
                self._others = True
                continue
            frame = Frame(_number(_field(scene, "timestamp"), MAX_SECONDS), self._positions(body))
            self._actor = name
            return [frame]
        return []

    def missing(self) -> str:
        return "Rokoko: expected an actor with a body, got none"

    def _positions(self, body: Any) -> np.ndarray:
        positions: List[np.ndarray] = []
        for joint in _JOINTS:
            if joint.endswith("Toe") and joint not in body:
                if not self._no_toes:
                    self.notes.append("Rokoko: the actor has no toes; they are placed at the feet")
                self._no_toes = True
                positions.append(positions[-1])  # the foot comes before its toe
                continue
            position = _field(body.get(joint), "position")
            values = [_number(_field(position, axis), MAX_POSITION) for axis in "xyz"]
            if None in values:
                axis = "xyz"[values.index(None)]
                raise ValueError(f"Rokoko: body.{joint}.position.{axis}: expected a number within "
                                 f"{MAX_POSITION:g} m, got {_shown(_field(position, axis))}")
            positions.append(np.array(values) * MIRROR)
        return np.array(positions)


def _decompressed(datagram: bytes) -> bytes:
    if not datagram.startswith(_LZ4_MAGIC):
        return datagram
    if lz4 is None:
        raise ValueError("Rokoko: the stream is compressed; install python3-lz4, or switch LZ4 off in "
                         "Rokoko Studio")
    decompressor = lz4.frame.LZ4FrameDecompressor()
    try:
        text = decompressor.decompress(datagram, MAX_JSON_BYTES)
    except RuntimeError as error:
        raise ValueError(f"Rokoko: LZ4: expected a frame, got an error: {error}") from None
    if not decompressor.eof:
        raise ValueError(f"Rokoko: LZ4: expected a complete frame of at most {MAX_JSON_BYTES} bytes, got another")
    return text


def _field(value: Any, key: str) -> Any:
    """A field of an object; None if the value is no object or has no such field."""
    return value.get(key) if isinstance(value, dict) else None


def _number(value: Any, limit: float) -> Optional[float]:
    is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
    return checked(value, limit) if is_number and abs(value) <= limit else None


def _shown(value: Any) -> str:
    return "none" if value is None else repr(value)[:60]
