"""Pairs staged from captures of single people, for a first run of the training.

They show how one person moves, not how two people react: walkers get a second walker beside them,
dancers their mirror image, and who reaches out somebody who reaches out to the same place.
"""

import numpy

from everyday.captures import FRAME_RATE_HZ, Pair, resample

BESIDE_METRES = (0.6, 0.85)     # between two people who walk side by side
MIRROR_METRES = (0.6, 0.85)     # from a person to the plane of the mirror
HANDS_METRES = (0.02, 0.1)      # between two hands that meet
LATE_FRAMES = 3                 # the second person of a walk or a mirror is late by at most this
NEAR_METRES = 0.5               # a mirrored person stays this near its first place
REACH_METRES = 0.45             # a hand this far before the hips is offered
REACH_HEIGHTS = (-0.05, 0.8)    # of an offered hand above the hips, metres
REACH_ASIDE_METRES = 0.3        # an offered hand is this near the middle of the body
STANDING_METRES = 0.75          # the hips of a person who stands are higher
APART_METRES = 0.55             # the hips of two people whose hands meet stay this far apart
BEFORE_SECONDS, AFTER_SECONDS = (1.0, 2.0), (0.6, 1.4)  # of a stretch, around the meeting of hands
SHORTEST_SECONDS = 2.0

# The column `class` of the table of single captures, and what becomes of it.
WALKS = ("walk", "turn")
MIRRORED = ("dance", "exercise", "martial", "stand", "jump", "talk")
REACHES = ("talk", "stand", "pick", "throw", "exercise")


def _yaw(pose, joints):
    """The direction that a pose faces, radians about y; 0 is +z."""
    across = sum(pose[joints.index("L" + part)] - pose[joints.index("R" + part)]
                 for part in ("Hip", "Shoulder"))
    return numpy.arctan2(-across[2], across[0])


def _turned(positions, yaw):
    cosine, sine = numpy.cos(yaw), numpy.sin(yaw)
    x, y, z = positions[..., 0], positions[..., 1], positions[..., 2]
    return numpy.stack([cosine * x + sine * z, y, cosine * z - sine * x], axis=-1)


def _facing(positions, joints, yaw):
    """Moved so that the first pose stands above the origin and faces `yaw`."""
    moved = positions - positions[0, 0] * [1, 0, 1]
    return _turned(moved, yaw - _yaw(moved[0], joints))


def mirrored(positions, joints):
    """The mirror image through the plane x = 0."""
    swap = [joints.index({"L": "R", "R": "L"}.get(name[0], name[0]) + name[1:])
            if name[1:] in ("Shoulder", "Elbow", "Wrist", "Hand", "Hip", "Knee", "Ankle", "Toe")
            else i for i, name in enumerate(joints)]
    return positions[:, swap] * [-1, 1, 1]


def _late(leader, follower, random):
    late = int(random.integers(0, LATE_FRAMES + 1))
    return leader[late:], follower[:len(follower) - late]


def beside(positions, joints, random):
    """Two people who walk side by side, in step: (leader, follower)."""
    leader = _facing(positions, joints, 0)
    side = random.choice([-1, 1]) * random.uniform(*BESIDE_METRES)
    # The second walker keeps beside the first one, so it turns with its hips.
    path = leader[:, 0] * [1, 0, 1]
    yaw = numpy.unwrap([_yaw(pose, joints) for pose in leader])
    kernel = numpy.ones(FRAME_RATE_HZ) / FRAME_RATE_HZ
    half = FRAME_RATE_HZ // 2
    yaw = numpy.convolve(numpy.pad(yaw, (half, half - 1), mode="edge"), kernel, mode="valid")
    offset = side * numpy.stack([numpy.cos(yaw), 0 * yaw, -numpy.sin(yaw)], axis=1)
    return _late(leader, leader - path[:, None] + (path + offset)[:, None], random)


def mirror(positions, joints, random):
    """A person and its mirror image, face to face: (leader, follower), or None if it walks."""
    leader = _facing(positions, joints, 0)
    if numpy.hypot(leader[:, 0, 0], leader[:, 0, 2]).max() > NEAR_METRES:
        return None
    image = mirrored(leader, joints)
    # A mirror image through the plane z = distance.
    image = _turned(image, numpy.pi) + [0, 0, 2 * random.uniform(*MIRROR_METRES)]
    return _late(leader, image, random)


def _reach(positions, joints, hand):
    """How far an offered hand is before the hips: [frames], metres; 0 where it is not offered."""
    yaw = numpy.array([_yaw(pose, joints) for pose in positions])
    way = positions[:, joints.index(hand)] - positions[:, 0]
    ahead = way[:, 0] * numpy.sin(yaw) + way[:, 2] * numpy.cos(yaw)
    aside = way[:, 0] * numpy.cos(yaw) - way[:, 2] * numpy.sin(yaw)
    is_offered = ((ahead > REACH_METRES) & (numpy.abs(aside) < REACH_ASIDE_METRES)
                  & (REACH_HEIGHTS[0] < way[:, 1]) & (way[:, 1] < REACH_HEIGHTS[1])
                  & (positions[:, 0, 1] > STANDING_METRES))
    return ahead * is_offered


def meetings(positions, joints, random):
    """Two people whose hands meet where one of them reaches farthest: [(leader, follower)].

    The follower is the leader, turned by half a turn about the place where the hands meet.
    """
    found = []
    for hand in ("RHand", "LHand"):
        reach = _reach(positions, joints, hand)
        while reach.any():
            at = int(reach.argmax())
            seconds = random.uniform(*BEFORE_SECONDS), random.uniform(*AFTER_SECONDS)
            before, after = (round(one * FRAME_RATE_HZ) for one in seconds)
            reach[max(0, at - before - after):at + before + after] = 0
            first = max(0, at - before)
            leader = positions[first:at + after]
            yaw = _yaw(positions[at], joints)
            ahead = numpy.array([numpy.sin(yaw), 0, numpy.cos(yaw)])
            place = positions[at, joints.index(hand)] + ahead * random.uniform(*HANDS_METRES) / 2
            follower = _turned(leader - place * [1, 0, 1], numpy.pi) + place * [1, 0, 1]
            apart = numpy.linalg.norm((leader - follower)[:, 0] * [1, 0, 1], axis=1)
            if apart.min() > APART_METRES:
                found.append(_late(leader, follower, random))
    return found


def pairs(archive, classes, seed=0):
    """Staged pairs. `classes`: {key of the archive: class of the single capture}."""
    random = numpy.random.default_rng(seed)
    motions = {key: resample(archive.arrays[key], archive.frame_rate_hz) for key in classes}
    motions = {key: motion for key, motion in motions.items()
               if len(motion) >= SHORTEST_SECONDS * FRAME_RATE_HZ}
    found = []

    def add(key, label, people):
        if people is not None and len(people[0]) >= SHORTEST_SECONDS * FRAME_RATE_HZ:
            seconds = len(people[0]) / FRAME_RATE_HZ
            found.append(Pair(f"{label}_{key}", people, 0, ((label, 0, seconds),), (key,)))

    for key, motion in motions.items():
        if classes[key] in WALKS:
            add(key, "walk", beside(motion, archive.joints, random))
        if classes[key] in MIRRORED:
            add(key, "mirror", mirror(motion, archive.joints, random))
        if classes[key] in REACHES:
            for number, people in enumerate(meetings(motion, archive.joints, random), start=1):
                add(f"{key}_{number}", "meet_hands", people)
    return found
