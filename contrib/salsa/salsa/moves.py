"""What a salsa couple does, frame by frame: the classes of the data set.

The rules read only how the two bodies turn and where they are. Angles are degrees, distances metres.
"""

import numpy

from salsa.takes import smooth

CLASSES = ("basic", "closed_hold", "follower_turn", "leader_turn", "cross_body", "approach", "apart")

SMOOTHING_SECONDS = 0.1
# A turn of a person against the line between the two people.
LEAST_TURN, TURN_RATE = 230, 45
# The couple turns as a whole: the two people change sides.
LEAST_CROSSING, CROSSING_RATE = 120, 30
# A rotation that pauses for less than this is one.
PAUSE_SECONDS = 0.3
# Closed hold: face to face, and the lead's right wrist this near the follower's chest.
FACING_DEGREES, ON_BACK_METRES = 60, 0.38
APART_METRES = 1.2
HELD_METRES = 0.3     # wrists of two people whose hands hold each other
APPROACH_SPEED = 0.2  # metres per second
# A dip or a step to the floor: either person's hips below this share of their usual height. There are
# too few to learn from; their frames have no class.
LOW_HIPS = 0.85
# A move that lasts less is none, and a pause between two moves that lasts less belongs to both.
SHORTEST_SECONDS = 0.5


def _along_floor(vectors):
    return numpy.degrees(numpy.unwrap(numpy.arctan2(vectors[:, 2], vectors[:, 0])))


def _yaw(take, positions):
    """The direction from a person's right to left, from hips and shoulders."""
    across = sum(positions[:, take.joint("L" + part)] - positions[:, take.joint("R" + part)]
                 for part in ("Hip", "Shoulder"))
    return _along_floor(across)


def stretches(mask):
    """[(begin, end)] of the runs of true values, end exclusive."""
    edges = numpy.diff(numpy.concatenate([[0], numpy.asarray(mask, dtype=int), [0]]))
    return list(zip(numpy.flatnonzero(edges == 1), numpy.flatnonzero(edges == -1)))


def _joined(spans, gap):
    joined = []
    for begin, end in spans:
        if joined and begin - joined[-1][1] < gap:
            joined[-1] = (joined[-1][0], end)
        else:
            joined.append((begin, end))
    return joined


def rotations(angle, frame_rate_hz, least, rate):
    """[(begin, end, degrees)]: rotations one way, of at least `least`, faster than `rate` a second."""
    angle = smooth(angle, SMOOTHING_SECONDS * frame_rate_hz)
    speed = numpy.gradient(angle) * frame_rate_hz
    found = []
    for way in (1, -1):
        for begin, end in _joined(stretches(way * speed > rate), PAUSE_SECONDS * frame_rate_hz):
            turned = angle[end - 1] - angle[begin]
            if abs(turned) >= least:
                found.append((int(begin), int(end), float(turned)))
    return sorted(found)


def _cover(frames, spans):
    mask = numpy.zeros(frames, dtype=bool)
    for begin, end, _ in spans:
        mask[begin:end] = True
    return mask


def _without_short(mask, shortest):
    kept = numpy.zeros_like(mask)
    for begin, end in stretches(mask):
        if end - begin >= shortest:
            kept[begin:end] = True
    return kept


def turns(take):
    """Turns of each person against the line between them: (of the lead, of the follower)."""
    axis = _along_floor(take.follow[:, 0] - take.lead[:, 0])
    return tuple(rotations(_yaw(take, positions) - axis, take.frame_rate_hz, LEAST_TURN, TURN_RATE)
                 for positions in (take.lead, take.follow))


def nearest_wrists(take):
    """The distance between the two wrists, of either person, that are nearest: [frames]."""
    wrists = [take.joint("LWrist"), take.joint("RWrist")]
    between = take.lead[:, wrists, None] - take.follow[:, None, wrists]
    return numpy.linalg.norm(between, axis=-1).min(axis=(1, 2))


def _is_low(take):
    """Frames in which either person is near the floor: [frames]."""
    heights = [positions[:, 0, 1] for positions in (take.lead, take.follow)]
    return numpy.any([height < LOW_HIPS * numpy.median(height) for height in heights], axis=0)


def classify(take):
    """The classes of every frame: {class: mask of [frames]}; several may hold, and none in a dip."""
    rate, frames = take.frame_rate_hz, take.frames
    line = take.follow[:, 0] - take.lead[:, 0]
    distance = smooth(numpy.hypot(line[:, 0], line[:, 2]), SMOOTHING_SECONDS * rate)
    speed = numpy.gradient(distance) * rate
    yaws = [_yaw(take, positions) for positions in (take.lead, take.follow)]
    # 180 degrees if they face each other.
    facing = numpy.abs((yaws[0] - yaws[1]) % 360 - 180)
    of_lead, of_follower = turns(take)

    masks = {
        "follower_turn": _cover(frames, of_follower),
        "leader_turn": _cover(frames, of_lead),
        "cross_body": _cover(frames, rotations(_along_floor(line), rate, LEAST_CROSSING,
                                               CROSSING_RATE)),
    }
    is_turning = masks["follower_turn"] | masks["leader_turn"]
    on_back = numpy.linalg.norm(take.lead[:, take.joint("RWrist")]
                                - take.follow[:, take.joint("Chest")], axis=1) < ON_BACK_METRES
    masks["closed_hold"] = on_back & (facing < FACING_DEGREES) & ~is_turning
    is_before_or_after = _without_hold(take)
    masks["approach"] = (speed < -APPROACH_SPEED) & is_before_or_after
    masks["apart"] = (is_before_or_after | (distance > APART_METRES)) & ~masks["approach"] & ~is_turning
    shortest = SHORTEST_SECONDS * rate
    masks = {name: _without_short(mask, shortest) for name, mask in masks.items()}
    masks["basic"] = _without_short(~numpy.any(list(masks.values()), axis=0), shortest)
    _fill_pauses(masks)
    is_low = _without_short(_is_low(take), shortest)
    return {name: masks[name] & ~is_low for name in CLASSES}


def _fill_pauses(masks):
    """Extends the classes at both ends of every stretch without a class to its middle."""
    for begin, end in stretches(~numpy.any(list(masks.values()), axis=0)):
        middle = (begin + end) // 2 if begin > 0 else begin
        middle = end if end == len(masks["basic"]) else middle
        for mask in masks.values():
            if begin > 0:
                mask[begin:middle] |= mask[begin - 1]
            if end < len(mask):
                mask[middle:end] |= mask[end]


def _without_hold(take):
    """Frames before hands first meet and after they part for good."""
    held = numpy.flatnonzero(nearest_wrists(take) < HELD_METRES)
    mask = numpy.ones(take.frames, dtype=bool)
    if len(held):
        mask[held[0]:held[-1] + 1] = False
    return mask


def spans(take):
    """[(class, begin, end)] of a take, in the order of their beginnings; end exclusive."""
    found = [(name, int(begin), int(end)) for name, mask in classify(take).items()
             for begin, end in stretches(mask)]
    return sorted(found, key=lambda span: (span[1], span[2], CLASSES.index(span[0])))
