"""Pairs staged from captures of single people, for a first run of the training.

They show how one person moves, not how two people react: walkers get a second walker beside them,
and who reaches out, or walks and reaches out at the end, somebody who reaches out to the same place.
"""

import numpy

from everyday.captures import FRAME_RATE_HZ, Pair, resample

BESIDE_METRES = (0.6, 0.85)     # between two people who walk side by side
HANDS_METRES = (0.02, 0.1)      # between two hands that meet
LATE_FRAMES = 3                 # the second person is late by at most this
REACH_METRES = 0.45             # a hand this far before the hips is offered
REACH_HEIGHTS = (-0.05, 0.8)    # of an offered hand above the hips, metres
REACH_ASIDE_METRES = 0.3        # an offered hand is this near the middle of the body
STANDING_METRES = 0.75          # the hips of a person who stands are higher
APART_METRES = 0.55             # the hips of two people whose hands meet stay this far apart
BEFORE_SECONDS, AFTER_SECONDS = (1.0, 2.0), (0.6, 1.4)  # of a stretch, around the meeting of hands
SHORTEST_SECONDS = 2.0
# Of a walk that ends in front of a partner: until it slows down, while it does, and at rest.
WALK_SECONDS, HALT_SECONDS, REST_SECONDS = (0.3, 1.2), (0.6, 1.0), (0.6, 1.4)
APPROACH_EVERY_FRAMES = 90      # of a walk; each becomes a walk of its own
LEAST_WALK_METRES = 0.4         # who walks less far does not walk up
RAISE_SECONDS = (0.4, 0.7)      # to reach out, before the hands meet
UPPER_ARM, FOREARM = (0.1, -0.85, 0.5), (0.1, 0.0, 1.0)  # of an offered hand: inwards, up, ahead
FIVE = 0.9                      # a hand is offered at most this much higher

# The column `class` of the table of single captures, and what becomes of it.
WALKS = ("walk", "turn")
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


def _met(leader, at, joints, hand, random):
    """(leader, follower), whose hands meet in frame `at`, or None if their bodies are too near.

    The follower is the leader, turned by half a turn about the place where the hands meet.
    """
    yaw = _yaw(leader[at], joints)
    ahead = numpy.array([numpy.sin(yaw), 0, numpy.cos(yaw)])
    place = leader[at, joints.index(hand)] + ahead * random.uniform(*HANDS_METRES) / 2
    follower = _turned(leader - place * [1, 0, 1], numpy.pi) + place * [1, 0, 1]
    apart = numpy.linalg.norm((leader - follower)[:, 0] * [1, 0, 1], axis=1)
    return _late(leader, follower, random) if apart.min() > APART_METRES else None


def meetings(positions, joints, random):
    """Two people whose hands meet where one of them reaches farthest: [(leader, follower)]."""
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
            people = _met(leader, at - first, joints, hand, random)
            if people is not None:
                found.append(people)
    return found


def _halting(positions, at, joints, random):
    """The walk around frame `at`, which slows down, stands and stays: a motion, or None."""
    walk, halt, rest = (round(random.uniform(*seconds) * FRAME_RATE_HZ)
                        for seconds in (WALK_SECONDS, HALT_SECONDS, REST_SECONDS))
    ankles = [joints.index(side + "Ankle") for side in "LR"]
    feet = numpy.linalg.norm(positions[:, ankles[0]] - positions[:, ankles[1]], axis=1)
    # It stops in the frame in which the feet are closest. Half of the time passes while it slows down.
    last = at + int(feet[at:at + FRAME_RATE_HZ // 2].argmin())
    first = last - walk - halt // 2
    if first < 0 or last >= len(positions):
        return None
    slow = numpy.arange(1, halt + 1) - numpy.arange(1, halt + 1) ** 2 / (2 * halt)
    times = numpy.concatenate([numpy.arange(walk + 1), walk + slow, numpy.full(rest, walk + halt / 2)])
    return _at(positions, numpy.minimum(first + times, last))


def _at(positions, times):
    before = numpy.minimum(times.astype(int), len(positions) - 2)
    share = (times - before)[:, None, None]
    return (1 - share) * positions[before] + share * positions[before + 1]


def _reaching(positions, joints, side, share, higher):
    """The motion with an arm that is offered, `share` of the way in each frame."""
    result = positions.copy()
    arm = [joints.index(side + part) for part in ("Shoulder", "Elbow", "Wrist", "Hand")]
    yaw = numpy.array([_yaw(pose, joints) for pose in positions])
    inwards = 1 if side == "R" else -1
    for (above, joint), offered in zip(zip(arm, arm[1:]), (UPPER_ARM, FOREARM, FOREARM)):
        bone = positions[:, joint] - positions[:, above]
        length = numpy.linalg.norm(bone, axis=1, keepdims=True)
        wanted = numpy.array(offered) * [inwards, 1, 1] + [0, higher, 0]
        wanted = numpy.stack([_turned(wanted, one) for one in yaw]) / numpy.linalg.norm(wanted)
        way = bone / length * (1 - share[:, None]) + wanted * share[:, None]
        result[:, joint] = result[:, above] + way / numpy.linalg.norm(way, axis=1, keepdims=True) * length
    return result


def approach(positions, at, joints, random):
    """Two people who walk up to each other and reach out, or None: (leader, follower)."""
    motion = _halting(positions, at, joints, random)
    if motion is None or numpy.linalg.norm((motion[-1] - motion[0])[0] * [1, 0, 1]) < LEAST_WALK_METRES:
        return None
    side = random.choice(["R", "R", "R", "L"])
    rest = int(numpy.count_nonzero((motion == motion[-1]).all(axis=(1, 2))))
    met = len(motion) - rest + int(random.integers(0, max(1, rest // 3)))
    raised = round(random.uniform(*RAISE_SECONDS) * FRAME_RATE_HZ)
    share = numpy.clip((numpy.arange(len(motion)) - met + raised) / raised, 0, 1)
    motion = _reaching(motion, joints, side, share * share * (3 - 2 * share),
                       max(0.0, random.uniform(-FIVE, FIVE)))
    return _met(motion, len(motion) - 1, joints, side + "Hand", random)


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
            for number, at in enumerate(range(FRAME_RATE_HZ, len(motion), APPROACH_EVERY_FRAMES), start=1):
                add(f"{key}_up_{number}", "meet_hands", approach(motion, at, archive.joints, random))
        if classes[key] in REACHES:
            for number, people in enumerate(meetings(motion, archive.joints, random), start=1):
                add(f"{key}_{number}", "meet_hands", people)
    return found
