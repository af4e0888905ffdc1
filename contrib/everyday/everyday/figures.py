"""Figures of a follower beside its leader and the captured follower. Motions: [frames, joints, 3]."""

import numpy

COLUMNS = ("error_m", "hands_m", "held", "distance_m", "facing_deg", "steps_r", "steps_lag_s", "speed")
STILL_COLUMNS = ("speed", "hand_up", "feet_apart_m")
MEETING_METRES = 0.15    # hands that are nearer meet
LONGEST_LAG = 0.4        # seconds


def _hands(leader, follower, joints):
    """The distance of the two nearest hands of the two people: [frames]."""
    ends = [joints.index("left_hand"), joints.index("right_hand")]
    apart = leader[:, ends, None] - follower[:, None, ends]
    return numpy.linalg.norm(apart, axis=-1).min(axis=(1, 2))


def _ahead(person, joints):
    """The direction that a person faces along the floor: [frames, 3]."""
    across = person[:, joints.index("left_hip")] - person[:, joints.index("right_hip")]
    ahead = numpy.cross(across * [1, 0, 1], [0, 1, 0])
    return ahead / numpy.linalg.norm(ahead, axis=1, keepdims=True)


def _distance(leader, follower):
    return numpy.linalg.norm((leader[:, 0] - follower[:, 0]) * [1, 0, 1], axis=1)


def _stride(person, joints):
    """How far the left foot is before the right one: [frames], metres."""
    feet = person[:, joints.index("left_ankle")] - person[:, joints.index("right_ankle")]
    return numpy.sum(feet * _ahead(person, joints), axis=1)


def _steps(leader, follower, joints, rate):
    """(correlation of the strides, lag in seconds at which it is greatest in size)."""
    strides = [_stride(person, joints) for person in (leader, follower)]
    best, most = (0.0, 0.0), round(LONGEST_LAG * rate)
    for lag in range(-most, most + 1):
        first = strides[0][max(0, -lag):len(leader) - max(0, lag)]
        second = strides[1][max(0, lag):len(follower) - max(0, -lag)]
        if min(first.std(), second.std()) < 1e-6:
            continue
        r = numpy.corrcoef(first, second)[0, 1]
        if abs(r) > abs(best[0]):
            best = r, lag / rate
    return abs(best[0]), abs(best[1])


def speed(person, rate):
    """Mean speed of the joints, m/s."""
    return numpy.linalg.norm(numpy.diff(person, axis=0), axis=-1).mean() * rate


def pair(leader, follower, captured, joints, rate):
    """COLUMNS: mean joint error; hands where captured hands meet: least distance, share of the
    frames in which these meet too; difference of the roots' distance and of the direction that
    the follower faces; correlation and lag of the steps of leader and follower; speed over captured."""
    is_meeting = _hands(leader, captured, joints) < MEETING_METRES
    hands = _hands(leader, follower, joints)[is_meeting]
    cosine = numpy.sum(_ahead(follower, joints) * _ahead(captured, joints), axis=1)
    r, lag = _steps(leader, follower, joints, rate)
    return {
        "error_m": numpy.linalg.norm(follower - captured, axis=-1).mean(),
        "hands_m": hands.min() if is_meeting.any() else numpy.nan,
        "held": (hands < MEETING_METRES).mean() if is_meeting.any() else numpy.nan,
        "distance_m": abs(_distance(leader, follower) - _distance(leader, captured)).mean(),
        "facing_deg": numpy.degrees(numpy.arccos(numpy.clip(cosine, -1, 1))).mean(),
        "steps_r": r, "steps_lag_s": lag,
        "speed": speed(follower, rate) / speed(captured, rate),
    }


def mean(found):
    """The mean of each column, without the trials that lack it."""
    values = {column: [one[column] for one in found if not numpy.isnan(one[column])]
              for column in found[0]}
    return {column: numpy.mean(some) if some else numpy.nan for column, some in values.items()}


def stillness(follower, joints, rate):
    """STILL_COLUMNS: speed, share of the frames with a hand above its shoulder, feet apart (90 %)."""
    up = numpy.any([follower[:, joints.index(f"{side}_hand"), 1]
                    > follower[:, joints.index(f"{side}_shoulder"), 1] for side in ("left", "right")],
                   axis=0)
    feet = (follower[:, joints.index("left_ankle")] - follower[:, joints.index("right_ankle")]) * [1, 0, 1]
    return {"speed": speed(follower, rate), "hand_up": up.mean(),
            "feet_apart_m": numpy.percentile(numpy.linalg.norm(feet, axis=1), 90)}
