"""Writes the FBX files of this folder's tests, with Blender's exporter.

    blender --background --factory-startup --python tests/formats/fbx/make_files.py -- [folder]

The motions are the sample leaders, animated by hand. Each file plays their frames, one for one, at the
file's own rate: the tests compare every position with the BVH. Blender 3.4 cannot import BVH, so this
script reads it.
"""

import math
import pathlib
import sys

import bpy
from mathutils import Matrix, Vector

SOURCE = pathlib.Path(__file__).resolve().parents[4]
FIRST, FRAMES = 20, 12  # of the samples: the kick itself
CENTIMETRE = 0.01
# From y up to Blender's z up.
TO_BLENDER = Matrix(((1, 0, 0), (0, 0, -1), (0, 1, 0))).to_4x4()

MIXAMO = {"torso": "Spine1", "neck": "Neck", "head": "Head", "head_end": "HeadTop_End"}
for side in ("left", "right"):
    for joint, name in (("shoulder", "Arm"), ("elbow", "ForeArm"), ("hand", "Hand"),
                        ("hip", "UpLeg"), ("knee", "Leg"), ("foot", "Foot")):
        MIXAMO[f"{side}_{joint}"] = side.capitalize() + name
MIXAMO = {joint: "mixamorig:" + name for joint, name in MIXAMO.items()}


class Joint:
    def __init__(self, name, parent):
        self.name, self.parent = name, parent
        self.offset, self.channels = Vector(), []


def read_bvh(name):
    """The joints of a sample and its rows of channel values."""
    words = (SOURCE / "samples" / f"{name}.bvh").read_text(encoding="utf-8").split()
    joints, open_joints, at = [], [], 0
    while words[at] != "MOTION":
        word = words[at]
        if word in ("ROOT", "JOINT", "End"):
            parent = open_joints[-1] if open_joints else None
            own = f"{parent.name}_end" if word == "End" else words[at + 1]
            joints.append(Joint(own, parent))
            at += 1
        elif word == "{":
            open_joints.append(joints[-1])
        elif word == "}":
            open_joints.pop()
        elif word == "OFFSET":
            joints[-1].offset = Vector(map(float, words[at + 1:at + 4])) * CENTIMETRE
            at += 3
        elif word == "CHANNELS":
            count = int(words[at + 1])
            joints[-1].channels = words[at + 2:at + 2 + count]
            at += 1 + count
        at += 1
    values = list(map(float, words[at + 6:]))
    width = sum(len(joint.channels) for joint in joints)
    return joints, [values[i:i + width] for i in range(0, len(values), width)]


def placed(joints, row):
    """The transform of every joint in one frame, in Blender's axes."""
    world, values = {}, iter(row)
    for joint in joints:
        local, position = Matrix(), joint.offset.copy()
        for channel in joint.channels:
            value = next(values)
            axis = "XYZ".index(channel[0])
            if channel.endswith("position"):
                position[axis] = value * CENTIMETRE
            else:
                local = local @ Matrix.Rotation(math.radians(value), 4, channel[0])
        local = Matrix.Translation(position) @ local
        world[joint.name] = world[joint.parent.name] @ local if joint.parent else local
    return {name: TO_BLENDER @ matrix @ TO_BLENDER.inverted() for name, matrix in world.items()}


def make_armature(every, joints, above, names, title):
    """An armature at rest. A bone's direction is arbitrary: only its head is a joint."""
    data = bpy.data.armatures.new(title)
    rig = bpy.data.objects.new(title, data)
    bpy.context.collection.objects.link(rig)
    bpy.context.view_layer.objects.active = rig
    rest = placed(every, [0.0] * sum(len(joint.channels) for joint in every))
    bpy.ops.object.mode_set(mode="EDIT")
    for number, joint in enumerate(joints):
        bone = data.edit_bones.new(names.get(joint.name, joint.name))
        bone.head = rest[joint.name].translation
        bone.tail = bone.head + Vector((0.02, 0.03 * (number % 3 - 1), 0.08))
        bone.roll = 0.3 * number
        parent = above[joint.name]
        if parent:
            bone.parent = data.edit_bones[names.get(parent.name, parent.name)]
    bpy.ops.object.mode_set(mode="OBJECT")
    return rig


def animate(rig, every, joints, above, rows, names, take):
    action = bpy.data.actions.new(take)
    action.use_fake_user = True
    rig.animation_data_create().action = action
    for frame, row in enumerate(rows):
        world = placed(every, row)
        posed = {}
        for joint in joints:
            bone = rig.pose.bones[names.get(joint.name, joint.name)]
            rest = bone.bone.matrix_local
            posed[joint.name] = world[joint.name] @ rest.to_3x3().to_4x4()
            parent = above[joint.name]
            moved = (posed[parent.name] @ bone.parent.bone.matrix_local.inverted()
                     if parent else Matrix())
            basis = (moved @ rest).inverted() @ posed[joint.name]
            location, rotation, _ = basis.decompose()
            bone.rotation_mode = "QUATERNION"
            bone.location, bone.rotation_quaternion = location, rotation
            bone.keyframe_insert("location", frame=frame)
            bone.keyframe_insert("rotation_quaternion", frame=frame)


def add_body(rig, names):
    """A box for each thigh and forearm, skinned; most bones have no vertices."""
    vertices, faces, groups = [], [], []
    for joint in ("left_hip", "right_hip", "left_elbow", "right_elbow"):
        bone = names.get(joint, joint)
        at, first = rig.data.bones[bone].head_local, len(vertices)
        for corner in range(8):
            vertices.append(at + Vector([0.05 * (2 * (corner >> axis & 1) - 1) for axis in range(3)]))
        faces += [[first + i for i in face] for face in
                  ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))]
        groups.append((bone, range(first, first + 8)))
    mesh = bpy.data.meshes.new("Body")
    mesh.from_pydata(vertices, [], faces)
    body = bpy.data.objects.new("Body", mesh)
    bpy.context.collection.objects.link(body)
    for bone, indices in groups:
        body.vertex_groups.new(name=bone).add(list(indices), 1.0, "REPLACE")
    body.parent = rig
    body.modifiers.new("Armature", "ARMATURE").object = rig


def clear(rate, units_per_metre=1):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.fps, scene.frame_start, scene.frame_end = rate, 0, FRAMES - 1
    scene.unit_settings.scale_length = 1 / units_per_metre


def export(folder, name, **options):
    settings = {"add_leaf_bones": False, "bake_anim": True, "bake_anim_use_all_actions": False,
                "bake_anim_use_nla_strips": False, "bake_anim_simplify_factor": 0,
                "bake_anim_force_startend_keying": True}
    bpy.ops.export_scene.fbx(filepath=str(folder / f"{name}.fbx"), **{**settings, **options})


def person(sample, names, title="Rig", frames=FRAMES):
    """An animated rig. The joints that Duet adds at the place of another one are left out: each bone moves
    and turns relative to the nearest bone above it."""
    every, rows = read_bvh(sample)
    joints = [joint for joint in every
              if (joint.name in names or not joint.name.endswith("_end"))
              and (joint.parent is None or joint.offset.length > 0)]
    above = {joint.name: joint.parent for joint in joints}
    for joint in joints:
        while above[joint.name] is not None and above[joint.name] not in joints:
            above[joint.name] = above[joint.name].parent
    rig = make_armature(every, joints, above, names, title)
    rows = rows[FIRST:FIRST + frames]
    bpy.context.scene.frame_end = frames - 1
    animate(rig, every, joints, above, rows, names, sample)
    return rig, lambda other: animate(rig, read_bvh(other)[0], joints, above,
                                      read_bvh(other)[1][FIRST:FIRST + frames], names, other)


def main(folder):
    folder.mkdir(parents=True, exist_ok=True)
    # Blender's own settings: centimetres, y up.
    clear(30)
    person("kick", {})
    export(folder, "centimetres_y_up_30")
    clear(24)
    person("kick", {})
    export(folder, "metres_z_up_24", axis_forward="Y", axis_up="Z",
           apply_scale_options="FBX_SCALE_UNITS")
    clear(60)
    person("kick", {})
    export(folder, "metres_y_up_60", apply_scale_options="FBX_SCALE_ALL")
    # Mixamo's names, with a skin.
    clear(30)
    rig, _ = person("kick", MIXAMO)
    add_body(rig, MIXAMO)
    export(folder, "mixamo_skin_30", use_armature_deform_only=False)
    # Two takes of one rig.
    clear(30)
    _, add_take = person("kick", {}, frames=6)
    add_take("punch")
    export(folder, "two_takes_30", bake_anim_use_all_actions=True)
    # Two people whose bones differ in their prefix, then two whose bones do not differ.
    for name, prefixes in (("two_people_30", ("a:", "b:")), ("same_names_30", ("", ""))):
        clear(30)
        for sample, prefix in zip(("kick", "punch"), prefixes):
            names = {joint.name: prefix + joint.name for joint in read_bvh(sample)[0]
                     if not joint.name.endswith("_end")}
            person(sample, names, f"Rig {sample}", frames=3)
        export(folder, name)
    # A rig without a motion.
    clear(30)
    rig, _ = person("kick", MIXAMO)
    rig.animation_data_clear()
    for bone in rig.pose.bones:
        bone.matrix_basis = Matrix()
    add_body(rig, MIXAMO)
    export(folder, "still_skin", bake_anim=False)


if __name__ == "__main__":
    extra = sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else []
    main(pathlib.Path(extra[0]) if extra else pathlib.Path(__file__).parent / "files")
