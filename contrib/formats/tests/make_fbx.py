"""Exports glTF of one person as FBX, in several ways: blender --background --python make_fbx.py -- KICK.glb PUNCH.glb OUT

OUT/cases.json lists the files of the kick. Beside them are takes.fbx (both motions of one rig), people.fbx (both,
with a prefix each) and still.fbx (a character without motion).
"""

import itertools
import json
import pathlib
import sys

import bpy
import numpy

if "bool" not in numpy.__dict__:  # Debian 12's glTF add-on uses it
    numpy.bool = bool
FRAMES = 24  # at each rate
KICK, PUNCH, OUT = map(pathlib.Path, sys.argv[sys.argv.index("--") + 1:])


def sided(left, right, **words):
    """Names of both sides' joints: the word for a joint and the ending of its side."""
    return {f"{side}_{joint}": word.format(ending) for side, ending in (("left", left), ("right", right))
            for joint, word in words.items()}


RIGS = {
    "duet": {},
    "mixamo": {"torso": "mixamorig:Spine1", "neck": "mixamorig:Neck", "head": "mixamorig:Head",
               **sided("Left", "Right", shoulder="mixamorig:{}Arm", elbow="mixamorig:{}ForeArm",
                       hand="mixamorig:{}Hand", hip="mixamorig:{}UpLeg", knee="mixamorig:{}Leg",
                       foot="mixamorig:{}Foot")},
    "unreal": {"torso": "spine_02", "neck": "neck_01", "head": "head",
               **sided("l", "r", shoulder="upperarm_{}", elbow="lowerarm_{}", hand="hand_{}", hip="thigh_{}",
                       knee="calf_{}", foot="foot_{}")},
    "rigify": {"torso": "spine.002", "neck": "neck", "head": "head",
               **sided("L", "R", shoulder="upper_arm.{}", elbow="forearm.{}", hand="hand.{}", hip="thigh.{}",
                       knee="shin.{}", foot="foot.{}")},
}
UNITS = itertools.cycle((1, 100, 1 / 0.0254))  # of the scene, in a metre
AXES = itertools.cycle(({}, {}, {"axis_forward": "Y", "axis_up": "Z"}))
# How Blender spreads the unit over the file's statement and the root's scale.
SCALES = itertools.cycle(("FBX_SCALE_NONE", "FBX_SCALE_UNITS", "FBX_SCALE_CUSTOM", "FBX_SCALE_ALL"))


def clear(rate=30, per_metre=1):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.context.scene.render.fps = rate
    bpy.context.scene.unit_settings.scale_length = 1 / per_metre


def person(file, names, per_metre=1, with_mesh=False):
    """Imports a person whose bones get other names, of which the first frames are exported."""
    known = set(bpy.data.objects)
    bpy.ops.import_scene.gltf(filepath=str(file), bone_heuristic="TEMPERANCE")
    rig = next(thing for thing in bpy.data.objects if thing not in known and thing.type == "ARMATURE")
    rig.name = rig.animation_data.action.name = file.stem
    for bone in rig.data.bones:
        bone.name = names.get(bone.name, bone.name)
    rig.scale = [per_metre] * 3
    if not with_mesh:
        for mesh in [thing for thing in bpy.data.objects if thing not in known and thing.type == "MESH"]:
            bpy.data.objects.remove(mesh)
    bpy.context.scene.frame_start, bpy.context.scene.frame_end = 0, FRAMES - 1
    return rig


def export(name, **options):
    settings = {"add_leaf_bones": False, "bake_anim": True, "bake_anim_use_all_actions": False,
                "bake_anim_use_nla_strips": False, "bake_anim_simplify_factor": 0}
    bpy.ops.export_scene.fbx(filepath=str(OUT / f"{name}.fbx"), **{**settings, **options})


cases = []
for rig, rate in itertools.product(RIGS, (30, 60)):
    per_metre, axes, scale = next(UNITS), next(AXES), next(SCALES)
    clear(rate, per_metre)
    person(KICK, RIGS[rig], per_metre)
    name = f"{rig}_{rate}"
    export(name, apply_scale_options=scale, **axes)
    cases.append({"name": name, "rig": rig, "rate": rate, "units": per_metre, "scale": scale, **axes})
(OUT / "cases.json").write_text(json.dumps({"cases": cases, "names": RIGS}), encoding="utf-8")

clear()
kick = person(KICK, {})
punch = person(PUNCH, {})
action = punch.animation_data.action
action.use_fake_user = True
bpy.data.objects.remove(punch)
export("takes", bake_anim_use_all_actions=True)

clear()
for file, prefix in ((KICK, "a:"), (PUNCH, "b:")):
    person(file, {joint: prefix + joint for joint in (*RIGS["mixamo"], "head_end")})
export("people")

clear()
rig = person(KICK, RIGS["mixamo"], with_mesh=True)
rig.animation_data_clear()
export("still", bake_anim=False)
