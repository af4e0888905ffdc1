"""Plans of live sessions: what a caller starts with, what it sends, and where it resumes. A plan is a function of a
seed and a number, and a value of JSON, so that it can be repeated, kept and reduced by hand.

    model, rate, unit, axis, joint_order   of the leader
    leader, leader_seed      how it moves (leaders.py)
    start                    fields of LiveStart
    labels, as_vector        keyframes (labels.py), and whether they are sent as a label vector
    follower_start           null, "root" or "pose"
    lead_in                  number of leader frames in the first message
    history                  null, or what the caller makes up: {first_frame, frames, kind}
    steps                    ["frames", first, count], ["label", frame or null, ease, weights], ["wait"] for the
                             frames that are due, ["mistake", name] (mistakes.py)
    start_mistake            null, or the name of one (mistakes.py)
    end                      "finish" or "cancel"
    repeats                  number of sessions that must have the same frames
    resumes                  where the session is interrupted, and how it goes on: {after, lost, extra, message}
"""

import random

from live_fuzz import labels, mistakes

COMMON_RATES = (10, 12.5, 15, 20, 23.976, 24, 25, 29.97, 30, 48, 50, 59.94, 60, 72, 73.073, 90, 100, 119.88, 120,
                144, 200, 240)
UNITS = ("metres", "metres", "millimetres", "sbu_normalised")
MOTIONS = ("person", "person", "still", "shaking", "jumps")
CLASSES = {"sbu": ("kick", "push", "shake_hands", "hug", "exchange_object", "punch"),
           "salsa": ("basic",)}
MOST_FRAMES = 400
SERVER_SECONDS = 2.0  # of leader frames that may be missing
DELAY_SECONDS = 0.5


def plan(seed, number):
    """The plan of a number."""
    chance = random.Random(f"{seed}/{number}")
    kind = chance.choices((_whole, _forged, _rough, _wrong, _wrong_start), (8, 6, 4, 2, 1))[0]
    made = _base(chance)
    kind(chance, made)
    return made


def frame_count(made):
    """The number of leader frames that a plan without mistakes sends, its history included."""
    return max([_first_frame(made), *(step[1] + step[2] for step in made["steps"] if step[0] == "frames")])


def delay(made):
    return made["start"].get("delay_frames", 0)


def _base(chance):
    unit = chance.choice(UNITS)
    rate = chance.choice((chance.choice(COMMON_RATES), round(chance.uniform(10, 240), 3)))
    model = chance.choice(("sbu", "sbu", "salsa"))
    keyframes = _keyframes(chance, CLASSES[model])
    return {
        "model": model, "rate": rate, "unit": unit,
        "axis": "y_down" if unit == "sbu_normalised" else chance.choice(("y_up", "z_up", "y_down")),
        "joint_order": chance.choice((None, chance.randrange(1000))),
        "leader": chance.choice(MOTIONS), "leader_seed": chance.randrange(1000),
        "start": _start(chance, rate, unit), "labels": keyframes,
        "as_vector": len(keyframes) == 1 and keyframes[0][0] == 0,
        "follower_start": chance.choice((None, None, "root", "pose")),
        "lead_in": 0, "history": None, "steps": [], "start_mistake": None, "end": "finish", "repeats": 1,
        "resumes": []}


def _start(chance, rate, unit):
    """Optional fields of LiveStart, each in some plans."""
    fields = {
        "seed": chance.randrange(2**32), "variety": round(chance.uniform(0, 2), 3),
        "candidates": chance.randint(1, 4),
        "clean_up": chance.choice((1, 2)),  # on, off
        "delay_frames": chance.randint(0, min(10, int(DELAY_SECONDS * rate))),
        "plan_frames": chance.randint(0, 30),
        "partner_direction": [chance.uniform(-1, 1), 0.0, 1.0],
        "up": [chance.uniform(-0.1, 0.1), 1.0, chance.uniform(-0.1, 0.1)],
        "reply_rotations": True}
    if unit == "sbu_normalised":
        del fields["reply_rotations"], fields["partner_direction"], fields["up"]
    return {name: value for name, value in fields.items() if chance.random() < 0.3}


def _weights(chance, classes):
    some = chance.sample(classes, min(len(classes), chance.randint(1, 2)))
    return {one: round(chance.choice((1, 1, chance.uniform(-1, 2))), 3) for one in some}


def _keyframes(chance, classes):
    if chance.random() < 0.5:
        return [[0, _weights(chance, classes)]]
    frames = sorted(chance.sample(range(200), chance.randint(1, 4)))
    return [[frame, _weights(chance, classes)] for frame in frames]


def _frames(chance, rate):
    seconds = chance.choice((chance.uniform(0.02, 0.5), chance.uniform(0.5, 3)))
    return max(2, min(MOST_FRAMES, round(seconds * rate)))


def _first_frame(made):
    if made["history"]:
        return made["history"]["first_frame"] + made["lead_in"]
    return made["lead_in"]


def _send(chance, made, frames, message, change_chance=0.0):
    """Adds steps that send leader frames in messages, and wait for the answer to each."""
    sent, keyframes = _first_frame(made), made["labels"]
    end = sent + frames
    while sent < end:
        if chance.random() < change_chance:
            keyframes = _change(chance, made, sent, keyframes)
        count = min(message, end - sent)
        made["steps"] += [["frames", sent, count], ["wait"]]
        sent += count


def _change(chance, made, sent, keyframes):
    """Adds a change of labels; returns the keyframes after it."""
    first = max(0, sent - delay(made))
    frame = chance.choice((None, first + chance.randint(0, 20)))
    ease = chance.choice((0, 0, chance.randint(1, 20)))
    at = first if frame is None else frame
    if not labels.are_held(keyframes, at if ease else at - 1):
        return keyframes
    weights = _weights(chance, CLASSES[made["model"]])
    made["steps"].append(["label", frame, ease, weights])
    return labels.change(keyframes, at, ease, weights)


def _whole(chance, made):
    """A session that is played again, and resumed with its whole history."""
    made["lead_in"] = chance.choice((0, 0, chance.randint(1, 5)))
    # A message with two evaluations, of 15 a second, would skip one.
    most = max(1, int(made["rate"] / 15))
    # The promise of resuming needs a plan that goes on from a frame of the follower.
    frames = max(_frames(chance, made["rate"]), delay(made) + 2)
    _send(chance, made, frames, chance.randint(1, min(8, most)), 0.02)
    made["repeats"] = chance.choice((1, 1, 2))
    waits = [i for i, step in enumerate(made["steps"]) if step == ["wait"]]
    for _ in range(chance.randint(1, 3)):
        made["resumes"].append({
            "after": chance.choice((*waits, len(made["steps"]))), "lost": chance.choice((0, chance.randint(1, 20))),
            "extra": chance.choice((0, 0, chance.randint(1, 100))), "message": chance.randint(1, most)})


def _forged(chance, made):
    """Two sessions that go on from frames that no server sent."""
    made["follower_start"] = None
    frames = chance.choice((1, 1, 2, 3, chance.randint(1, 20), chance.randint(1, MOST_FRAMES)))
    frames = min(frames, int(10 * made["rate"]))
    unanswered = chance.choice((0, 0, 1, chance.randint(0, 12)))
    made["lead_in"] = min(frames + unanswered, int(10 * made["rate"]))
    made["history"] = {"first_frame": chance.choice((0, 1, 2, 3, 7, chance.randrange(500), chance.randrange(2**24))),
                       "frames": frames, "kind": chance.choice(("person", "person", "noise", "jumps", "point"))}
    _send(chance, made, chance.choice((1, 2, chance.randint(1, 60))), chance.choice((1, 1, 3, 20)), 0.05)
    made["repeats"] = 2


def _rough(chance, made):
    """Frames without a pace, again and with gaps; changes of labels; an end at any point."""
    made["lead_in"] = chance.choice((0, 0, 1, 3))
    sent, keyframes = made["lead_in"], made["labels"]
    for _ in range(chance.randint(1, 25)):
        if chance.random() < 0.2:
            keyframes = _change(chance, made, sent, keyframes)
        first = max(0, sent + chance.choice((0, 0, 0, -3, -40, 1, 5, int(SERVER_SECONDS * made["rate"]))))
        count = chance.choice((1, 1, 5, 30))
        made["steps"].append(["frames", first, count])
        sent = max(sent, first + count)
        if chance.random() < 0.2:
            made["steps"].append(["wait"])
    made["end"] = chance.choice(("finish", "finish", "cancel"))


def _wrong(chance, made):
    """A good session up to one message that the server must refuse."""
    _send(chance, made, delay(made) + chance.choice((1, 5, 40)), chance.choice((1, 4)))
    made["steps"].append(["mistake", chance.choice(mistakes.LATER)])


def _wrong_start(chance, made):
    made["follower_start"] = None
    made["start_mistake"] = chance.choice(mistakes.START)
