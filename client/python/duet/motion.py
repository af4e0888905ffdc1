"""One character's motion as an array of joint positions."""

from __future__ import annotations

import dataclasses
from typing import Any, Sequence, Tuple

import numpy as np
import numpy.typing as npt

from duet._wire import UNITS, UP_AXES

Positions = npt.NDArray[np.float32]

# Metres in one unit of length.
_METRES = {"metres": 1.0, "millimetres": 0.001}
# What turns a row vector of each axis convention to y up: rotations about x, so that handedness is
# kept. The wire's own definition (docs/decisions/0006).
_TO_Y_UP = {
    "y-up": np.diag([1.0, 1.0, 1.0]),
    "z-up": np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]]),
    "y-down": np.diag([1.0, -1.0, -1.0]),
}


@dataclasses.dataclass(frozen=True, eq=False, repr=False)
class Motion:
    """Joint positions over time, in a right-handed world.

    Args:
        positions: ``[frames, joints, 3]``; anything that numpy makes such an array of. Kept as
            ``float32``, as a copy that cannot be written to: changes make a new motion
            (:meth:`with_positions`).
        joint_names: one for each joint, no duplicates.
        frame_rate_hz: frames a second.
        unit: ``"metres"``, ``"millimetres"`` or ``"sbu-normalised"``.
        up_axis: ``"y-up"``, ``"z-up"`` or ``"y-down"``.

    Raises:
        ValueError: a field is malformed; the message names it, what came and what was wanted.
    """

    positions: Positions
    joint_names: Tuple[str, ...]
    frame_rate_hz: float
    unit: str = "metres"
    up_axis: str = "y-up"

    def __init__(self, positions: npt.ArrayLike, joint_names: Sequence[str], frame_rate_hz: float,
                 unit: str = "metres", up_axis: str = "y-up") -> None:
        kept = np.array(positions, dtype=np.float32)
        kept.setflags(write=False)
        if isinstance(joint_names, str):
            raise ValueError(f"joint_names: {joint_names!r}, wanted a sequence of names")
        values = {"positions": kept, "joint_names": tuple(joint_names),
                  "frame_rate_hz": float(frame_rate_hz), "unit": unit, "up_axis": up_axis}
        for name, value in values.items():
            object.__setattr__(self, name, value)
        self._check()

    def _check(self) -> None:
        shape = self.positions.shape
        if len(shape) != 3 or shape[2] != 3:
            raise ValueError(f"positions: shape {shape}, wanted (frames, joints, 3)")
        if shape[1] != len(self.joint_names):
            raise ValueError(f"positions: {shape[1]} joints, wanted the {len(self.joint_names)} of "
                             "joint_names")
        twice = {name for name in self.joint_names if self.joint_names.count(name) > 1}
        if twice:
            raise ValueError(f"joint_names: {', '.join(sorted(twice))} more than once")
        if self.unit not in UNITS:
            raise ValueError(f"unit: {self.unit!r}, wanted one of {', '.join(UNITS)}")
        if self.up_axis not in UP_AXES:
            raise ValueError(f"up_axis: {self.up_axis!r}, wanted one of {', '.join(UP_AXES)}")

    @property
    def frame_count(self) -> int:
        return int(self.positions.shape[0])

    @property
    def joint_count(self) -> int:
        return int(self.positions.shape[1])

    @property
    def duration_seconds(self) -> float:
        """From the first frame to the last."""
        return max(self.frame_count - 1, 0) / self.frame_rate_hz

    @property
    def times(self) -> npt.NDArray[np.float64]:
        """The time of every frame in seconds, ``[frames]``."""
        return np.arange(self.frame_count) / self.frame_rate_hz

    def joint(self, name: str) -> Positions:
        """The positions of one joint, ``[frames, 3]``.

        Raises:
            KeyError: there is no such joint.
        """
        if name not in self.joint_names:
            raise KeyError(f"joint {name!r}, wanted one of {', '.join(self.joint_names)}")
        return self.positions[:, self.joint_names.index(name)]

    def select(self, joint_names: Sequence[str]) -> Motion:
        """Some of the joints, or all in another order."""
        chosen = [self.joint(name) for name in joint_names]
        return dataclasses.replace(self, positions=np.stack(chosen, axis=1),
                                   joint_names=tuple(joint_names))

    def with_positions(self, positions: npt.ArrayLike) -> Motion:
        """Other positions of the same joints, rate, unit and axis; any number of frames."""
        return dataclasses.replace(self, positions=positions)

    def frames(self, start: int, stop: int | None = None) -> Motion:
        """The frames from ``start`` to before ``stop``, as Python slices count."""
        return self.with_positions(self.positions[start:stop])

    def converted(self, unit: str = "metres", up_axis: str = "y-up") -> Motion:
        """The same motion in another unit or with another axis up.

        Raises:
            ValueError: SBU's normalised unit, from or to which :func:`duet.read_motion` converts.
        """
        for name in (self.unit, unit):
            if name not in _METRES:
                raise ValueError(f"unit: {name!r}, wanted one of {', '.join(_METRES)}")
        if up_axis not in UP_AXES:
            raise ValueError(f"up_axis: {up_axis!r}, wanted one of {', '.join(UP_AXES)}")
        turn = _TO_Y_UP[self.up_axis] @ _TO_Y_UP[up_axis].T
        scale = _METRES[self.unit] / _METRES[unit]
        return dataclasses.replace(self, positions=self.positions @ turn * scale, unit=unit,
                                   up_axis=up_axis)

    def __getstate__(self) -> dict[str, Any]:
        return dict(self.__dict__)

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__init__(**state)  # type: ignore[misc]

    def __repr__(self) -> str:
        return (f"Motion({self.frame_count} frames at {self.frame_rate_hz:g} Hz, "
                f"{self.joint_count} joints, {self.unit}, {self.up_axis})")
