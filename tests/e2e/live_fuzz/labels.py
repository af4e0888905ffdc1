"""Label keyframes, [[frame, {class: weight}], ...], and what a change (LabelChange) makes of them."""


def are_held(keyframes, frame):
    """Whether the weights at a frame are those of a keyframe. A change elsewhere makes keyframes of rounded weights, for
    which live.proto does not promise equal frames."""
    return frame >= keyframes[-1][0] or frame <= keyframes[0][0]


def change(keyframes, frame, ease, weights):
    """The keyframes after a change. Requires weights that are held at the last frame with the old ones."""
    last = frame if ease else frame - 1
    assert are_held(keyframes, last)
    old = keyframes[-1][1] if last >= keyframes[-1][0] else keyframes[0][1]
    kept = [keyframe for keyframe in keyframes if keyframe[0] < last]
    return [*kept, *([[last, old]] if last >= 0 else []), [frame + ease, weights]]


def still_apply(keyframes, frame):
    """Those without the ones that have no effect from a frame on."""
    before = [keyframe for keyframe in keyframes if keyframe[0] <= frame]
    return [*before[-1:], *keyframes[len(before):]]


def after(keyframes, steps, sent, delay):
    """The keyframes after the steps of a plan (plans.py). `sent`: the index of the next leader frame before them."""
    for step in steps:
        if step[0] == "frames":
            sent = max(sent, step[1] + step[2])
        elif step[0] == "label":
            frame = max(0, sent - delay) if step[1] is None else step[1]
            keyframes = change(keyframes, frame, step[2], step[3])
    return keyframes
