"""A scene with an animated armature, answered by the add-on; run by Blender itself.

    blender --background --factory-startup --python react.py -- ADD_ON_FOLDER LEADER.glb SERVER DUET OUT

Writes what there is afterwards as JSON into the folder OUT, and the scene as out.blend.
"""

import json
import pathlib
import sys

import bpy

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import scenes  # noqa: E402

addon_folder, leader_file, server, duet, out = sys.argv[sys.argv.index("--") + 1:]
OUT = pathlib.Path(out)
FIRST_FRAME, LAST_FRAME = 11, 50

scene, leader = scenes.open_leader(leader_file, addon_folder, (FIRST_FRAME, LAST_FRAME), 20)
import duet_blender  # noqa: E402
import duet_blender.leader  # noqa: E402

duet_blender.register()
settings = scene.duet
known = [label.name for label in settings.labels]
settings.server, settings.program = server, duet
assert bpy.ops.duet.ask_for_classes() == {"FINISHED"}
asked = [label.name for label in settings.labels]

failures = []


def react():
    try:
        return sorted(bpy.ops.duet.react())
    except RuntimeError as error:  # a report of an error, as Blender hands it to scripts
        failures.append(str(error))
        return ["CANCELLED"]


def without_a_leader():
    try:
        bpy.ops.duet.react()
    except RuntimeError:
        return True
    return False


refused = without_a_leader()
settings.leader = leader
still = react()  # every label 0
kick = settings.labels[known.index("kick")]
kick.weight = 1
kick.keyframe_insert("weight", frame=FIRST_FRAME)
kick.weight = 0
kick.keyframe_insert("weight", frame=LAST_FRAME)
empty = bpy.data.objects.new("Place", None)
scene.collection.objects.link(empty)
empty.location = (2.4, 0, 0)
settings.place = empty
settings.program = "no-such-program"
missing = react()
settings.program = duet
finished = react()
again = react()  # in place of the last one
after_two = sorted(thing.name for thing in bpy.data.objects if thing.type == "ARMATURE")
seed = settings.seed  # the server's choice
assert bpy.ops.duet.keep() == {"FINISHED"}
settings.own_seed, settings.seed = True, 4
react()
after_take = sorted(thing.name for thing in bpy.data.objects if thing.type == "ARMATURE")

# The leader's own rig, its bones renamed so that only the map tells which is which.
names = {"left_hand": "Paw.001", "right_hand": "Paw.002"}
for joint, bone in names.items():
    leader.data.bones[joint].name = bone
unmapped = react()
for joint in settings.joints:
    joint.bone = names.get(joint.name, "")
settings.body = "LEADER"
own_rig = react()
own = bpy.data.objects.get("Duet follower")
own_bones = sorted(bone.name for bone in own.data.bones) if own else []
leaders_bones = sorted(bone.name for bone in leader.data.bones)
scene.frame_set(FIRST_FRAME)
own_torso = list(own.matrix_world @ own.pose.bones["torso"].head) if own else []
scene.frame_set(20)
settings.body = "MANNEQUIN"
settings.own_seed = False
react()

recording = duet_blender.leader.Recording(scene, leader)
for _ in recording.take():
    pass

follower = bpy.data.objects.get("Duet follower")
body = bpy.data.objects.get("Duet follower body")
state = {
    "known": known, "asked": asked, "refused_without_leader": refused, "still": still,
    "missing": missing, "finished": finished, "failures": failures, "again": again,
    "after_two": after_two, "seed": seed, "after_take": after_take, "unmapped": unmapped, "own_rig": own_rig,
    "own_bones": own_bones, "leaders_bones": leaders_bones, "own_torso": own_torso,
    "joints": [joint.name for joint in settings.joints],
    "tails": [name for name, _, _, tail in recording.joints if tail],
    "flags": recording.label_flags(), "place": recording.place_flags(),
    "frame": scene.frame_current, "fps": scene.render.fps,
    "range": [scene.frame_start, scene.frame_end],
}
if follower:
    torso = []
    for frame in range(FIRST_FRAME, LAST_FRAME + 1):
        scene.frame_set(frame)
        torso.append(list(follower.matrix_world @ follower.pose.bones["torso"].head))
    state["torso"] = torso
    state["bones"] = len(follower.pose.bones)
    state["materials"] = sorted(slot.name for slot in body.data.materials)
    state["vertices"] = len(body.data.vertices) if body else 0
    state["keys"] = list(follower.animation_data.action.frame_range)
(OUT / "state.json").write_text(json.dumps(state), encoding="utf-8")
bpy.ops.wm.save_as_mainfile(filepath=str(OUT / "out.blend"))
duet_blender.unregister()
