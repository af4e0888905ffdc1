"""A standing person for every take: whom a generator of leads takes for its leader."""

import dataclasses
import json

import numpy

from salsa.dataset_folder import joint_name

DISTANCE_METRES = 2.0  # in front of the lead as the take begins

# The direction of the bone to each joint of a person who stands and faces +z, the left side at +x.
_DOWN, _UP, _FORWARD = (0, -1, 0), (0, 1, 0), (0, -0.4, 1)
_DIRECTIONS = {"Spine": _UP, "Chest": _UP, "Neck": _UP, "Head": _UP, "HeadTop": _UP}
for _side, _x in (("L", 1), ("R", -1)):
    _DIRECTIONS |= {_side + "Shoulder": (_x, 0.6, 0), _side + "Hip": (_x, -0.3, 0),
                    _side + "Toe": _FORWARD}
    _DIRECTIONS |= {_side + joint: (0.12 * _x, -1, 0) for joint in ("Elbow", "Wrist", "Hand")}
    _DIRECTIONS |= {_side + joint: _DOWN for joint in ("Knee", "Ankle")}


def pose(take, parents):
    """The lead's limbs standing at the origin, the lowest joint on the floor: [joints, 3]."""
    places = numpy.zeros((len(take.joints), 3))
    for joint, parent in enumerate(parents):  # parents come before their children
        if parent < 0:
            continue
        length = numpy.linalg.norm(take.lead[:, joint] - take.lead[:, parent], axis=1).mean()
        direction = numpy.array(_DIRECTIONS[take.joints[joint]], dtype=float)
        places[joint] = places[parent] + length * direction / numpy.linalg.norm(direction)
    places[:, 1] -= places[:, 1].min()
    return places


def write_motion(take, parents, seconds, path):
    """Writes the standing person as a motion file (docs/formats.md), a leader to generate from."""
    standing = numpy.round(pose(take, parents), 4).tolist()
    path.write_text(json.dumps({
        "format": "duet-motion", "version": 1, "frame_rate_hz": take.frame_rate_hz,
        "unit": "metres", "up_axis": "y-up",
        "joint_names": [joint_name(joint) for joint in take.joints],
        "bones": [[parent, joint] for joint, parent in enumerate(parents) if parent >= 0],
        "leader": [standing] * round(seconds * take.frame_rate_hz)}) + "\n", encoding="utf-8")


def leads(take, parents):
    """The take with the standing person as the lead, and the lead as the follow."""
    first = take.lead[0]
    across = first[take.joint("LHip")] - first[take.joint("RHip")]
    forward = numpy.array([-across[2], 0.0, across[0]])  # where the lead looks
    forward /= numpy.linalg.norm(forward)
    back = -forward  # where the standing person looks
    left = numpy.array([back[2], 0.0, -back[0]])
    person = pose(take, parents) @ numpy.array([left, [0.0, 1.0, 0.0], back])
    person += first[take.joint("Hips")] * [1, 0, 1] + DISTANCE_METRES * forward
    return dataclasses.replace(take, lead=numpy.broadcast_to(person, take.lead.shape),
                               follow=take.lead)
