"""Imports the partner, which Duet writes as glTF, into the scene."""

import json
import pathlib

import bpy

from .actions import curves_of
from .program import DuetError

NAME = "Duet follower"
TAKE = "Duet take"
_MARK = "duet_answer"  # on every object of the last answer
COLOUR = (0.0782, 0.4508, 0.5210, 1)  # linear: the follower's of pages and files


def _let_importer_run():
    """Defines numpy.bool, which Debian 12's glTF importer uses and its numpy no longer has."""
    import numpy

    if "bool" not in numpy.__dict__:
        numpy.bool = bool


def remove_last(scene):
    """Removes the last answer, and its data that nothing else uses."""
    for thing in [thing for thing in scene.objects if _MARK in thing]:
        data, action = thing.data, thing.animation_data and thing.animation_data.action
        kind = thing.type
        bpy.data.objects.remove(thing)
        if action and not action.users:
            bpy.data.actions.remove(action)
        if data and not data.users:
            (bpy.data.armatures if kind == "ARMATURE" else bpy.data.meshes).remove(data)


def last(scene):
    """The armature of the last answer, or None."""
    return next((thing for thing in scene.objects if _MARK in thing and thing.type == "ARMATURE"), None)


def joint_place(scene, joint):
    """Where a joint of the last answer is in the current frame; None without one."""
    armature = last(scene)
    bone = armature and armature.pose.bones.get(joint)
    return armature.matrix_world @ bone.head if bone else None


def keep(scene, title):
    """Turns the last answer into a take, which the next answer does not replace. Returns its
    name."""
    armature = last(scene)
    number = 1 + sum(1 for thing in scene.objects
                     if thing.type == "ARMATURE" and thing.name.startswith(TAKE))
    name = f"{TAKE} {number} ({title})"
    for thing in [thing for thing in scene.objects if _MARK in thing]:
        del thing[_MARK]
        thing.name = name if thing is armature else f"{name} body"
    if armature.animation_data and armature.animation_data.action:
        armature.animation_data.action.name = name
    return name


def export_rig(scene, armature, metres, path):
    """Writes the armature in its rest pose with its meshes, as binary glTF in metres. `metres`: the
    length of its unit."""
    if "gltf" not in dir(bpy.ops.export_scene):
        raise DuetError("Enable the add-on glTF 2.0, which writes the leader's rig.")
    _let_importer_run()
    selected, active = list(bpy.context.selected_objects), bpy.context.view_layer.objects.active
    wanted = [armature] + [thing for thing in scene.objects if thing.type == "MESH" and (
        thing.parent is armature or any(modifier.type == "ARMATURE" and modifier.object is armature
                                        for modifier in thing.modifiers))]
    try:
        for thing in selected:
            thing.select_set(False)
        for thing in wanted:
            thing.select_set(True)
        bpy.context.view_layer.objects.active = armature
        bpy.ops.export_scene.gltf(filepath=str(path), export_format="GLB", use_selection=True,
                                  export_animations=False, export_def_bones=False)
    finally:
        for thing in wanted:
            thing.select_set(thing in selected)
        bpy.context.view_layer.objects.active = active
    _in_metres(path, metres)


def _in_metres(path, metres):
    """Puts a node that scales to metres above all others: the exporter writes Blender's units."""
    content = pathlib.Path(path).read_bytes()
    length = int.from_bytes(content[12:16], "little")  # of the first chunk, after the file's header
    document = json.loads(content[20:20 + length])
    for scene in document["scenes"]:
        document["nodes"].append({"name": "metres", "scale": [metres] * 3,
                                  "children": scene["nodes"]})
        scene["nodes"] = [len(document["nodes"]) - 1]
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    rest = content[20 + length:]
    header = content[:8] + (20 + len(text) + len(rest)).to_bytes(4, "little")
    pathlib.Path(path).write_bytes(header + len(text).to_bytes(4, "little") + b"JSON" + text + rest)


def add(scene, path, scale=1):
    """Imports one person, whose file is in metres, and marks them as the last answer; their
    armature.

    `scale`: units of the leader's armature in a unit of the scene. The scene keeps rate, range and
    current frame."""
    if "gltf" not in dir(bpy.ops.import_scene):
        raise DuetError("Switch on the add-on glTF 2.0, which reads the partner")
    _let_importer_run()
    things, actions = set(bpy.data.objects), set(bpy.data.actions)
    render = scene.render
    kept = (render.fps, render.fps_base, scene.frame_start, scene.frame_end, scene.frame_current)
    # Bones point to the next joint; the default of Blender 4 lets them point upwards.
    bpy.ops.import_scene.gltf(filepath=str(path), bone_heuristic="TEMPERANCE")
    render.fps, render.fps_base, scene.frame_start, scene.frame_end = kept[:4]
    new = [thing for thing in bpy.data.objects if thing not in things]
    armatures = [thing for thing in new if thing.type == "ARMATURE"]
    if not armatures:
        raise DuetError("The partner's file has no armature.")
    armature = armatures[0]
    armature.name = NAME
    for thing in new:
        thing[_MARK] = True
        if thing.parent is None and scale != 1:
            thing.location *= scale
            thing.scale *= scale
        if thing.type == "MESH" and thing.parent is armature:
            thing.name = f"{NAME} body"
            _colour(thing.data.materials)
    _place_in_time(scene.frame_start,
                   [action for action in bpy.data.actions if action not in actions])
    scene.frame_set(kept[4])
    return armature


def _colour(materials):
    """Gives the person the follower's material, because a single person is written in the leader's colour. All followers
    share it, so a colour that the user chooses stays."""
    for index, material in enumerate(materials):
        if not material.name.startswith("person"):
            continue
        shared = bpy.data.materials.get(NAME)
        if shared:
            materials[index] = shared
            bpy.data.materials.remove(material)
            continue
        material.name = NAME
        material.diffuse_color = COLOUR
        for node in material.node_tree.nodes if material.use_nodes else ():
            if node.type == "BSDF_PRINCIPLED":
                node.inputs["Base Color"].default_value = COLOUR


def _place_in_time(first_frame, actions):
    """Moves actions from frame 0, where the importer puts them, to another first frame."""
    for action in actions:
        action.name = NAME
        for curve in curves_of(action):
            for key in curve.keyframe_points:
                key.co.x += first_frame
                key.handle_left.x += first_frame
                key.handle_right.x += first_frame
