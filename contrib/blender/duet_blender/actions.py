"""Curves of actions, as all versions of Blender store them."""


def curves_of(action):
    """All curves of an action. Since Blender 4.4 they are in layers."""
    if hasattr(action, "fcurves"):
        return list(action.fcurves)
    return [curve for layer in action.layers for strip in layer.strips
            for bag in strip.channelbags for curve in bag.fcurves]


def keyed_frames(thing, matches):
    """The frames, sorted, in which an object has key frames on a curve whose data path `matches`."""
    action = thing.animation_data and thing.animation_data.action
    if not action:
        return []
    return sorted({round(key.co.x) for curve in curves_of(action) if matches(curve.data_path)
                   for key in curve.keyframe_points})
