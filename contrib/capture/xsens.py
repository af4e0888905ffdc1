"""Reads the network stream of Xsens MVN: message MXTP02 (position and orientation as quaternion).

Source: MVN's real-time network streaming protocol specification.
"""

import struct
from typing import List, Optional, Set

import numpy as np

from frames import MAX_POSITION, Frame, Reader, checked

SEGMENTS = 23
# Sample, datagram, items, time code, character; then the numbers of body segments, props and finger
# segments, and reserved bytes.
_HEADER = struct.Struct(">6sIBBIB3xHH")
_ITEM = struct.Struct(">I7f")


class XsensReader(Reader):
    """The positions of the 23 segments are their joints, in the world, z up. The first character that
    arrives leads; others are ignored. A sample may span datagrams. Props and fingers are ignored."""

    joint_names = ["Hips", "Spine5", "Spine3", "Spine12", "Spine8", "Neck", "Head",
                   "RightShoulder", "RightUpperArm", "RightLowerArm", "RightHand",
                   "LeftShoulder", "LeftUpperArm", "LeftLowerArm", "LeftHand",
                   "RightUpperLeg", "RightLowerLeg", "RightFoot", "RightToes",
                   "LeftUpperLeg", "LeftLowerLeg", "LeftFoot", "LeftToes"]

    def __init__(self) -> None:
        super().__init__()
        self._character: Optional[int] = None
        self._others = False
        self._sample: Optional[int] = None
        self._arrived: Set[int] = set()
        self._positions = np.zeros((SEGMENTS, 3))
        self._last_time: Optional[int] = None  # of the last complete sample

    def read(self, datagram: bytes) -> List[Frame]:
        if not datagram.startswith(b"MXTP"):
            raise ValueError("Xsens: expected a datagram that begins with MXTP02, got "
                             f"{datagram[:6]!r}")
        if not datagram.startswith(b"MXTP02"):
            raise ValueError(f"Xsens: expected MXTP02, got {datagram[:6]!r}; in MVN's network streamer, "
                             "select Position + Orientation (Quaternion)")
        if len(datagram) < _HEADER.size:
            raise ValueError(f"Xsens: expected a header, got {len(datagram)} bytes")
        _, sample, _, items, time_code, character, _, _ = _HEADER.unpack_from(datagram)
        body = datagram[_HEADER.size:]
        if len(body) < items * _ITEM.size:
            raise ValueError(f"Xsens: expected a header and {items} segments of {_ITEM.size} bytes, got "
                             f"{len(datagram)} bytes")
        if self._character is None:
            self._character = character
        if character != self._character:
            if not self._others:
                self.notes.append(f"Xsens: character {self._character} leads; the other characters of the "
                                  "stream are ignored")
            self._others = True
            return []
        if sample != self._sample:
            self._sample = sample
            self._arrived.clear()
        for segment, x, y, z, *_ in _ITEM.iter_unpack(body[:items * _ITEM.size]):
            if not 1 <= segment <= SEGMENTS:
                continue
            if any(checked(value, MAX_POSITION) is None for value in (x, y, z)):
                raise ValueError(f"Xsens: segment {segment}: expected a position within {MAX_POSITION:g} m, "
                                 f"got {x}, {y}, {z}")
            self._positions[segment - 1] = (x, z, -y)
            self._arrived.add(segment)
        if len(self._arrived) < SEGMENTS:
            return []
        self._arrived.clear()
        # A time code that stands still while samples go on is no time.
        seconds = None if time_code == self._last_time else time_code / 1000
        self._last_time = time_code
        return [Frame(seconds, self._positions.copy())]

    def missing(self) -> str:
        return f"Xsens: expected the {SEGMENTS} segments of a body, got {len(self._arrived)}"
