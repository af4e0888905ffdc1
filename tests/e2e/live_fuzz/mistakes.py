"""Messages that the server must refuse, by name, and what the refusal names."""

INVALID = "INVALID_ARGUMENT"
UNFIT = "FAILED_PRECONDITION"
NAN = float("nan")
LARGEST = 2**32 - 1


def _frames(ahead=0, count=1, drop=0, value=None):
    """Leader frames `ahead` of the next one, with `drop` values fewer, or one `value` of no person."""
    return {"kind": "frames", "ahead": ahead, "count": count, "drop": drop, "value": value}


def _change(**fields):
    return {"kind": "change", **fields}


# Name -> what is sent.
LATER_MESSAGES = {
    "no frames": _frames(count=0),
    "values missing": _frames(count=2, drop=1),
    "no values": _frames(count=3, drop=10**9),
    "not finite": _frames(value=NAN),
    "infinite": _frames(value=float("inf")),
    "far away": _frames(value=3e38),
    "too many frames": _frames(count=2500),
    "too late": _frames(ahead=10_000),
    "last index": _frames(ahead=LARGEST),
    "class unknown": _change(weights={"tango": 1}),
    "no weights": _change(weights={}),
    "weight not finite": _change(weights={"kick": NAN}),
    "weight too large": _change(weights={"kick": 1e30}),
    "ease too long": _change(weights={"kick": 1}, ease=10**6),
    "ease of ever": _change(weights={"kick": 1}, ease=LARGEST),
    "final frame": _change(weights={"kick": 1}, frame=0),
    "frame of never": _change(weights={"kick": 1}, frame=LARGEST),
    "second start": {"kind": "start"},
    "nothing": {"kind": "nothing"}}
LATER = tuple(LATER_MESSAGES)

# Name -> what is set in the start: paths, with an index of a list as a number, "append" for a new element, and values.
START_CHANGES = {
    "rate 0": {"leader.frame_rate_hz": 0}, "rate below 0": {"leader.frame_rate_hz": -30},
    "rate not finite": {"leader.frame_rate_hz": NAN}, "rate too high": {"leader.frame_rate_hz": 1e9},
    "no unit": {"leader.unit": 0}, "unit unknown": {"leader.unit": 9}, "no axis": {"leader.up_axis": 0},
    "frames missing": {"leader.frame_count": 5}, "frames of ever": {"leader.frame_count": LARGEST},
    "joint unknown": {"leader.joint_names.0": "tail"}, "joint twice": {"leader.joint_names.0": "head",
                                                                      "leader.joint_names.1": "head"},
    "delay": {"delay_frames": 11}, "plan": {"plan_frames": 31}, "candidates": {"candidates": 1000},
    "variety": {"variety": NAN}, "clean-up": {"clean_up": 99},
    "up": {"up.x": NAN}, "direction": {"partner_direction.x": NAN},
    "labels twice": {"label_vector.weights.append": ("kick", 1), "label_keyframes.append": 3},
    "history without leader": {"history.follower_frame_count": 1},
    "start and history": {"history.follower_frame_count": 1, "follower_start.root_position.x": 0.0},
    "model without live": {"model.name": "k3hi"}, "version without live": {"model.name": "sbu", "model.version": 1},
    "model unknown": {"model.name": "nobody"}}
START = tuple(START_CHANGES)


def expected(made):
    """(codes, prefixes of the fields): how the server must answer a plan with a mistake; None for a plan
    without. No prefixes: the error names no field."""
    if made["start_mistake"]:
        return _expected_of_start(made["start_mistake"])
    name = next((step[1] for step in made["steps"] if step[0] == "mistake"), None)
    if name is None:
        return None
    prefix = {"frames": "frames.", "change": "label_change.", "start": "payload", "nothing": "payload"}
    return (INVALID,), (prefix[LATER_MESSAGES[name]["kind"]],)


def _expected_of_start(name):
    if name == "model unknown":
        return ("NOT_FOUND",), ()
    if "without live" in name:
        return (UNFIT,), ("start.model",)
    paths = [path.split(".")[0] for path in START_CHANGES[name]]
    if "history" in paths:  # its frames must be among the leader's
        paths.append("leader")
    return (INVALID, UNFIT), tuple(f"start.{path}" for path in paths)
