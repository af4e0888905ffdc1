"""One character's motion as an array of joint positions."""

from __future__ import annotations

import dataclasses
import math
import numbers
import reprlib
from typing import Any, Iterable, Optional, Sequence, Tuple, cast

import numpy as np
import numpy.typing as npt

from duet_motion.v1 import motion_pb2

# The names of units and axes, and their values on the wire.
UNITS = {"metres": motion_pb2.LENGTH_UNIT_METRES, "millimetres": motion_pb2.LENGTH_UNIT_MILLIMETRES,
         "sbu-normalised": motion_pb2.LENGTH_UNIT_SBU_NORMALISED}
UP_AXES = {"y-up": motion_pb2.UP_AXIS_Y_UP, "z-up": motion_pb2.UP_AXIS_Z_UP,
           "y-down": motion_pb2.UP_AXIS_Y_DOWN}

Positions = npt.NDArray[np.float32]

# Metres in one unit of length.
_METRES = {"metres": 1.0, "millimetres": 0.001}
# Rotate a row vector of each axis convention to y up, about x, which preserves handedness. The API
# defines these rotations (docs/decisions/contract.md).
_TO_Y_UP = {
    "y-up": np.diag([1.0, 1.0, 1.0]),
    "z-up": np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]]),
    "y-down": np.diag([1.0, -1.0, -1.0]),
}


@dataclasses.dataclass(frozen=True, eq=False, repr=False)
class Motion:
    """Joint positions of one person over time, in a right-handed world.

    Args:
        positions: ``[frames, joints, 3]``, x, y and z in ``unit``: anything that NumPy converts to
            such an array of finite real numbers. Stored as a read-only ``float32`` copy; use
            :meth:`with_positions` to create a changed motion.
        joint_names: the name of each joint, in the order of the array, without duplicates.
        frame_rate_hz: frames per second, finite and above 0.
        unit: ``"metres"``, ``"millimetres"`` or ``"sbu-normalised"``.
        up_axis: ``"y-up"``, ``"z-up"`` or ``"y-down"``.

    Raises:
        ValueError: an argument is malformed. The message has the form ``field: expected ..., got
            ...``; for a value in ``positions`` it names the frame, the joint and the axis.
    """

    positions: Positions
    joint_names: Tuple[str, ...]
    frame_rate_hz: float
    unit: str = "metres"
    up_axis: str = "y-up"

    def __init__(self, positions: npt.ArrayLike, joint_names: Sequence[str], frame_rate_hz: float,
                 unit: str = "metres", up_axis: str = "y-up") -> None:
        names = _checked_names(joint_names)
        kept = _checked_positions(positions, names).astype(np.float32)
        kept.setflags(write=False)
        values = {"positions": kept, "joint_names": names,
                  "frame_rate_hz": checked_number("frame_rate_hz", frame_rate_hz, above=0),
                  "unit": checked_choice("unit", unit, UNITS),
                  "up_axis": checked_choice("up_axis", up_axis, UP_AXES)}
        for name, value in values.items():
            object.__setattr__(self, name, value)

    @property
    def frame_count(self) -> int:
        return int(self.positions.shape[0])

    @property
    def joint_count(self) -> int:
        return int(self.positions.shape[1])

    def joint(self, name: str) -> Positions:
        """Returns the positions of one joint, ``[frames, 3]`` in ``unit``.

        Args:
            name: one of ``joint_names``.

        Raises:
            KeyError: there is no such joint.
        """
        if name not in self.joint_names:
            raise KeyError(f"joint: expected one of {', '.join(self.joint_names)}, got {name!r}")
        return self.positions[:, self.joint_names.index(name)]

    def select(self, joint_names: Sequence[str]) -> Motion:
        """Returns a motion with some of the joints, or all in another order.

        Args:
            joint_names: names from ``joint_names``, in the order of the result.

        Raises:
            KeyError: there is no such joint.
        """
        chosen = [self.joint(name) for name in joint_names]
        return dataclasses.replace(self, positions=np.stack(chosen, axis=1),
                                   joint_names=tuple(joint_names))

    def with_positions(self, positions: npt.ArrayLike) -> Motion:
        """Returns a motion with other positions and the same joints, rate, unit and axis.

        Args:
            positions: ``[frames, joints, 3]`` in ``unit``, with any number of frames.

        Raises:
            ValueError: see the constructor.
        """
        # The constructor converts what is like an array.
        return dataclasses.replace(self, positions=cast(Positions, positions))

    def frames(self, start: int, stop: int | None = None) -> Motion:
        """Returns the frames from ``start`` to before ``stop``.

        Args:
            start: the first frame; negative numbers count from the end, as in slices.
            stop: the frame after the last one; None: until the end.
        """
        return self.with_positions(self.positions[start:stop])

    def resampled(self, frame_rate_hz: float) -> Motion:
        """Resamples the motion linearly to another rate at the same speed.

        The last frame is never earlier than the motion's end, so the result is up to one frame
        longer. A motion of fewer than two frames keeps its frames.

        Args:
            frame_rate_hz: frames per second of the result, finite and above 0.

        Raises:
            ValueError: the rate is invalid.
        """
        to_hz = checked_number("frame_rate_hz", frame_rate_hz, above=0)
        if to_hz == self.frame_rate_hz or self.frame_count < 2:
            return dataclasses.replace(self, frame_rate_hz=to_hz)
        return dataclasses.replace(self, frame_rate_hz=to_hz, positions=resample(
            self.positions, self.frame_rate_hz, to_hz))

    def converted(self, unit: str = "metres", up_axis: str = "y-up") -> Motion:
        """Converts the motion to another unit or up axis.

        Args:
            unit: ``"metres"`` or ``"millimetres"``.
            up_axis: ``"y-up"``, ``"z-up"`` or ``"y-down"``.

        Raises:
            ValueError: the unit of this motion or of the result is ``"sbu-normalised"``; only
                :func:`duet_motion.read_motion` converts from it.
        """
        for name in (self.unit, unit):
            checked_choice("unit", name, _METRES)
        checked_choice("up_axis", up_axis, UP_AXES)
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


def checked_array(field: str, values: npt.ArrayLike) -> npt.NDArray[Any]:
    """Converts ``values`` to an array of real numbers; masked values become NaN."""
    if isinstance(values, np.ma.MaskedArray):
        values = np.ma.filled(values.astype(np.float64), np.nan)  # type: ignore[no-untyped-call]
    try:
        array = np.asarray(values)
    except ValueError as error:  # such as rows of different lengths
        raise ValueError(f"{field}: expected an array of numbers, got {error}") from error
    if array.dtype.kind not in "fiu":
        raise ValueError(f"{field}: expected real numbers, got values of type {array.dtype}")
    return array


def checked_number(field: str, value: object, *, above: float) -> float:
    """Returns ``value`` as a finite float above a bound, or raises ValueError."""
    number = finite_number(value)
    if number is None or number <= above:
        raise ValueError(f"{field}: expected a finite number above {above:g}, got "
                         f"{reprlib.repr(value)}")
    return number


def finite_number(value: object) -> Optional[float]:
    """Returns ``value`` as a float; None if it is not a finite number."""
    if not isinstance(value, numbers.Real) or isinstance(value, bool):
        return None
    try:
        number = float(value)
    except OverflowError:
        return None
    return number if math.isfinite(number) else None


def first_not_finite(array: npt.NDArray[Any]) -> Optional[Tuple[int, ...]]:
    """The index of the first value that is not finite as float32; None if all are."""
    with np.errstate(over="ignore"):
        finite = np.isfinite(array.astype(np.float32, copy=False))
    if finite.all():
        return None
    return tuple(int(at) for at in np.argwhere(~finite)[0])


def resample(positions: Positions, from_hz: float, to_hz: float) -> Positions:
    """Resamples ``[frames, ...]`` like ``duet convert --resample``: linearly, up to one frame
    longer, at least two frames."""
    last = (len(positions) - 1) * to_hz / from_hz
    count = max(2, math.ceil(last - 1e-6) + 1)  # tolerance: do not round up a whole number
    at = np.clip(np.arange(count) * from_hz / to_hz, 0, len(positions) - 1)
    before = at.astype(np.int64)
    after = np.minimum(before + 1, len(positions) - 1)
    share = (at - before).astype(np.float32).reshape(-1, *[1] * (positions.ndim - 1))
    moved: Positions = positions[before] + (positions[after] - positions[before]) * share
    return moved


def _checked_names(names: Sequence[str]) -> Tuple[str, ...]:
    if isinstance(names, str) or not isinstance(names, Iterable):
        raise ValueError(f"joint_names: expected a sequence of names, got {reprlib.repr(names)}")
    kept = tuple(names)
    for name in kept:
        if not isinstance(name, str) or not name:
            raise ValueError(f"joint_names: expected a name for each joint, got {name!r}")
    twice = sorted({name for name in kept if kept.count(name) > 1})
    if twice:
        raise ValueError("joint_names: expected each name once, got duplicates of "
                         f"{', '.join(twice)}")
    return tuple(str(name) for name in kept)


def _checked_positions(given: npt.ArrayLike, names: Tuple[str, ...]) -> npt.NDArray[Any]:
    array = checked_array("positions", given)
    if array.ndim != 3 or array.shape[2] != 3 or not array.shape[1]:
        raise ValueError(f"positions: expected the shape (frames, joints, 3), got {array.shape}")
    if array.shape[1] != len(names):
        raise ValueError(f"positions: expected the {len(names)} joints of joint_names, got "
                         f"{array.shape[1]}")
    found = first_not_finite(array)
    if found is not None:
        frame, joint, axis = found
        raise ValueError(f"positions[{frame}, {joint}, {axis}]: expected a finite float32, got "
                         f"{array[found]} at frame {frame}, joint {names[joint]!r}, {'xyz'[axis]}")
    return array


def checked_choice(field: str, value: object, choices: Iterable[str]) -> str:
    """Returns ``value`` if it is one of the choices, or raises ValueError."""
    if isinstance(value, str) and value in choices:
        return value
    raise ValueError(f"{field}: expected one of {', '.join(choices)}, got {reprlib.repr(value)}")
