"""Whether a camera was tilted, estimated from the people that it captured."""

from __future__ import annotations

import reprlib

from duet_motion import files
from duet_motion.motion import Motion, axes_from_y_up
from duet_motion.result import VerticalEstimate


def estimate_vertical(leader: Motion, *others: Motion) -> VerticalEstimate:
    """Estimates the vertical of the camera that captured all of these people, like ``duet inspect``.

    More people and longer motions give stronger evidence, above all people who turn or face different
    ways. Everybody must be from one camera in one position.

    >>> camera = duet.estimate_vertical(*duet.read_pair("pair.bvh"))
    >>> client.synthesize(leader, {"hug": 1}, level=camera)      # levels only if the evidence is strong

    Args:
        leader: a person with the joints of Duet's skeleton, or with joints whose names are recognised;
            metres or millimetres. The estimate is in this motion's axes.
        others: further people.

    Raises:
        ValueError: a motion has no joints that are recognised, or is ``"sbu-normalised"``.
        FileNotFoundError: the program `duet` is missing.
    """
    people = []
    for person in (leader, *others):
        if not isinstance(person, Motion):
            raise ValueError(f"leader: expected a duet_motion.Motion, got {reprlib.repr(person)}")
        people.append(person.converted("metres", "y-up"))
    values = files.inspect(people)["tilt"]
    values["up"] = axes_from_y_up(values["up"], leader.up_axis)
    return VerticalEstimate(**values)
