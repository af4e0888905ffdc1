"""The vertical of a camera, estimated from the people that it captured."""

from __future__ import annotations

import dataclasses
from typing import Tuple


@dataclasses.dataclass(frozen=True)
class VerticalEstimate:
    """The vertical of a capture with its standard error, as ``duet inspect`` reports it
    (docs/formats.md, "Tilted cameras"). ``str()`` is the verdict in one line.

    Args:
        verdict: ``"tilted"``: ``up`` is the vertical. ``"level"``: strong evidence that there is nothing
            to level. ``"unknown"``: cannot tell, because a tilted camera and people who lean, or a
            sloping floor, look the same here.
        text: the verdict in one line, such as ``"tilted by 9.7 degrees (-1.4 towards x, 9.6 towards z;
            +- 1.7)"``; x and z are those of a y-up world.
        up: the most likely vertical, of length 1, in the axes of the motion. Rely on it only if the
            verdict is ``"tilted"``.
        tilt_degrees: the angle between ``up`` and the up axis.
        error_degrees: the standard error of ``up`` in the direction in which it is least certain.
        deviations: the tilt, divided by its standard error.
        disagreement: the angle between the verticals of floor and bodies, divided by its standard
            error; 0 if one of the two is absent.
        places: the number of places where feet rest.
    """

    verdict: str
    text: str
    up: Tuple[float, float, float]
    tilt_degrees: float
    error_degrees: float
    deviations: float
    disagreement: float
    places: int

    def __str__(self) -> str:
        return self.text
