"""The partner: what Duet wrote as glTF, in the scene."""

import bpy

from .program import DuetError

NAME = "Duet follower"
COLOUR = (0.0782, 0.4508, 0.5210, 1)  # linear: the follower's of pages and files


def _let_importer_run():
    """Debian 12's glTF importer asks numpy for a name that its numpy has no more."""
    import numpy

    if "bool" not in numpy.__dict__:
        numpy.bool = bool


def add(scene, path):
    """Imports one person, in the unit of the scene; their armature. The scene keeps rate, range and
    current frame."""
    if not hasattr(bpy.ops.import_scene, "gltf"):
        raise DuetError("Switch on the add-on glTF 2.0, which reads the partner")
    _let_importer_run()
    things, actions = set(bpy.data.objects), set(bpy.data.actions)
    render = scene.render
    kept = (render.fps, render.fps_base, scene.frame_start, scene.frame_end, scene.frame_current)
    bpy.ops.import_scene.gltf(filepath=str(path))
    render.fps, render.fps_base, scene.frame_start, scene.frame_end = kept[:4]
    new = [thing for thing in bpy.data.objects if thing not in things]
    armatures = [thing for thing in new if thing.type == "ARMATURE"]
    if not armatures:
        raise DuetError("The partner came without an armature")
    armature = armatures[0]
    armature.name = NAME
    for thing in new:
        if thing.type == "MESH" and thing.parent is armature:
            thing.name = f"{NAME} body"
            _colour(thing.data.materials)
    _place_in_time(scene, [action for action in bpy.data.actions if action not in actions])
    scene.frame_set(kept[4])
    return armature


def _colour(materials):
    """Somebody who came alone has the leader's colour."""
    for material in materials:
        if not material.name.startswith("person"):
            continue
        material.name = NAME
        material.diffuse_color = COLOUR
        for node in material.node_tree.nodes if material.use_nodes else ():
            if node.type == "BSDF_PRINCIPLED":
                node.inputs["Base Color"].default_value = COLOUR


def _curves(action):
    """All curves of an action; since Blender 4.4 they lie in layers."""
    if hasattr(action, "fcurves"):
        return list(action.fcurves)
    return [curve for layer in action.layers for strip in layer.strips
            for bag in strip.channelbags for curve in bag.fcurves]


def _place_in_time(scene, actions):
    """The importer begins at frame 0, the leader's motion at the scene's first frame."""
    for action in actions:
        action.name = NAME
        for curve in _curves(action):
            for key in curve.keyframe_points:
                key.co.x += scene.frame_start
                key.handle_left.x += scene.frame_start
                key.handle_right.x += scene.frame_start
