"""What a plan (plans.py) promises, and whether the answers (player.py) keep it. Each function returns what is wrong,
or None."""

import math

from live_fuzz import mistakes, plans

# Places were short, or the machine too busy for the first answer: the caller comes again.
COME_AGAIN = ("RESOURCE_EXHAUSTED",)
# A follower that is farther away (in the caller's unit) follows nobody.
FARTHEST = 1e7
# A history that shows no person may be refused.
NOBODY = ("point", "noise")


def of_answer(made, answer):
    """Of one session."""
    if answer.cancelled or answer.code in COME_AGAIN:
        return None
    wanted = mistakes.expected(made)
    if wanted is not None:
        return _of_refusal(answer, *wanted)
    if made["history"] and made["history"]["kind"] in NOBODY and answer.code != "OK":
        return _of_refusal(answer, (mistakes.INVALID,), ("start.history.",))
    if answer.code != "OK":
        return f"expected OK, got {answer.code}: {answer.text}"
    return _of_frames(made, answer) or _of_notices(answer)


def of_repeat(one, other):
    """Of two sessions with the same messages."""
    return _of_same(one, other, "the same session has other frames")


def of_resumed(whole, rest):
    """Of a session and of one that goes on where it was interrupted."""
    wrong = _of_same(whole, rest, "the resumed session has other frames")
    if wrong is None and rest.rig and rest.rig != whole.rig:
        wrong = "the resumed session has another rig"
    return wrong


def can_compare(*answers):
    """Whether the promise of equal frames holds: no evaluation was skipped, and all sessions are complete."""
    return all(answer.summary is not None and answer.summary["skipped_frames"] == 0 for answer in answers)


def _of_refusal(answer, codes, prefixes):
    if answer.code not in codes:
        return f"expected {' or '.join(codes)}, got {answer.code}: {answer.text}"
    if prefixes and not answer.fields:
        return f"the error names no field: {answer.text}"
    strange = [field for field in answer.fields if prefixes and not field.startswith(prefixes)]
    if strange:
        return f"expected an error of {', '.join(prefixes)}, got {', '.join(strange)}: {answer.text}"
    return None


def _of_frames(made, answer):
    history = made["history"]
    first = history["first_frame"] + history["frames"] if history else 0
    # Of a resumed session, the first frame is where it goes on.
    begin = max(first, answer.first_frame)
    end = plans.frame_count(made)
    if sorted(answer.frames) != list(range(begin, end)):
        return (f"expected the frames {begin} to {end - 1}, got {len(answer.frames)} from "
                f"{min(answer.frames, default=None)} on")
    for frame, values in answer.frames.items():
        if not all(math.isfinite(value) and abs(value) < FARTHEST for value in values):
            return f"frame {frame} has a value that is not finite or far away"
    if answer.summary is None:
        return "the stream has no summary"
    if answer.summary["frame_count"] != len(answer.frames):
        return f"the summary counts {answer.summary['frame_count']} frames, there are {len(answer.frames)}"
    if made["start"].get("reply_rotations") and sorted(answer.rotations) != sorted(answer.frames):
        return "rotations are missing"
    return None


def _of_notices(answer):
    for kind in ("gap", "late", "skipped"):
        told = sum(count for of, _, count in answer.notices if of == kind)
        if told != answer.summary[f"{kind}_frames"]:
            return f"notices report {told} {kind} frames, the summary {answer.summary[f'{kind}_frames']}"
    return None


def _of_same(one, other, what):
    for name in ("frames", "rotations"):
        mine, its = getattr(one, name), getattr(other, name)
        for frame in sorted(its):
            if frame in mine and mine[frame] != its[frame]:
                apart = max(abs(a - b) for a, b in zip(mine[frame], its[frame]))
                return f"{what}: {name} from frame {frame} on, by up to {apart:.3g} there"
    return None
