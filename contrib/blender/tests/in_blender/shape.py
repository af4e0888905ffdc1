"""The add-on's tools for shaping an answer; run by Blender itself.

    blender --background --factory-startup --python shape.py -- ADD_ON_FOLDER LEADER.glb DANCER.glb SERVER DUET OUT

Writes what there is afterwards as JSON into the folder OUT.
"""

import json
import math
import pathlib
import sys

import bpy

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import scenes  # noqa: E402

addon_folder, leader_file, dancer_file, server, duet, out = sys.argv[sys.argv.index("--") + 1:]
OUT = pathlib.Path(out)
METRE = scenes.UNITS_PER_METRE
FIRST, LAST = 11, 60
state = {}

scene, leader = scenes.open_leader(leader_file, addon_folder, (FIRST, LAST), 30)
import duet_blender  # noqa: E402
import duet_blender.leader  # noqa: E402
import duet_blender.panel  # noqa: E402
import duet_blender.partner  # noqa: E402
import duet_blender.pins  # noqa: E402

duet_blender.register()
settings = scene.duet
settings.server, settings.program, settings.leader = server, duet, leader
assert bpy.ops.duet.ask_for_classes() == {"FINISHED"}
settings.labels["hug"].weight = 1


def attempt(operator, **options):
    """What an operator reports as its error; "" if it works."""
    try:
        operator(**options)
    except RuntimeError as error:
        return str(error)
    return ""


def place(armature, bone, frame):
    """The head of a bone in a frame, in metres."""
    scene.frame_set(frame)
    return [value / METRE for value in armature.matrix_world @ armature.pose.bones[bone].head]


def follower():
    return duet_blender.partner.last(scene)


def answered(answer, joint, frame):
    """Where an answer's file has a joint, in Blender's axes."""
    document = json.loads(pathlib.Path(answer.file).read_text(encoding="utf-8"))
    x, y, z = document["follower"][frame - FIRST][document["joint_names"].index(joint)]
    return [x, -z, y]


# ---- The gallery.
assert bpy.ops.duet.show_eight() == {"FINISHED"}
state["seeds"] = [int(answer.seed) for answer in settings.answers]
state["faults"] = [answer.faults for answer in settings.answers]
state["grades"] = [answer.grade for answer in settings.answers]
state["shown"] = []
for index in (0, 3):
    assert bpy.ops.duet.choose(index=index) == {"FINISHED"}
    state["shown"].append({
        "chosen": settings.chosen, "state": settings.state, "kept": [settings.own_seed, settings.seed],
        "followers": sum(thing.type == "ARMATURE" for thing in scene.objects),
        "hand": place(follower(), "left_hand", 40),
        "expected": answered(settings.answers[index], "left_hand", 40)})
state["panel"] = scenes.drawn(duet_blender.panel.VIEW3D_PT_duet)
state["no_such_answer"] = attempt(bpy.ops.duet.choose, index=8)
state["seed_of_take"] = settings.answers[3].seed
bpy.ops.duet.keep()
state["take"] = settings.state
pathlib.Path(settings.answers[1].file).unlink()
state["gone"] = attempt(bpy.ops.duet.choose, index=1)

# ---- Label curves.
settings.labels["hug"].weight = 1
scene.frame_set(FIRST)
bpy.ops.duet.key_labels()
scene.frame_set(LAST)
settings.labels["hug"].weight, settings.labels["push"].weight = 0, 1
bpy.ops.duet.key_labels()
recording = duet_blender.leader.Recording(scene, leader)
for _ in recording.take():
    pass
state["labels"] = recording.label_flags()
scene.animation_data_clear()
settings.labels["hug"].weight, settings.labels["push"].weight = 1, 0

# ---- Pins: this answer can reach them.
settings.own_seed, settings.seed = True, 0
assert bpy.ops.duet.react() == {"FINISHED"}
scene.frame_set(30)
assert bpy.ops.duet.add_pin(joint="right_hand") == {"FINISHED"}
hand = settings.pins[0]
state["new_pin"] = {"joint": hand.joint, "frame": hand.frame,
                    "place": [value / METRE for value in hand.thing.location],
                    "hand": place(follower(), "right_hand", 30)}
assert bpy.ops.duet.add_pin(joint="left_hand") == {"FINISHED"}  # of the same, selected empty
state["shared"] = settings.pins[1].thing == hand.thing
assert bpy.ops.duet.remove_pin(index=1) == {"FINISHED"}
hand.thing.location.z += 0.2 * METRE
assert bpy.ops.duet.react() == {"FINISHED"}
state["one_pin"] = {"told": settings.answers[0].pins, "hand": place(follower(), "right_hand", 30),
                    "wanted": [value / METRE for value in hand.thing.location]}
for frame, lift in ((25, 0.15), (45, -0.1)):
    x, y, z = place(follower(), "right_hand", frame)
    hand.thing.location = [x * METRE, y * METRE, (z + lift) * METRE]
    hand.thing.keyframe_insert("location", frame=frame)
rig = scenes.add_character(scene, "Puppet")
rig.location.x = 3 * METRE
bpy.ops.object.select_all(action="DESELECT")
bpy.context.view_layer.objects.active = rig
rig.select_set(True)
bpy.ops.object.mode_set(mode="POSE")
rig.data.bones.active = rig.data.bones["Head"]
assert bpy.ops.duet.add_pin(joint="head") == {"FINISHED"}
bpy.ops.object.mode_set(mode="OBJECT")
head = settings.pins[1]
rig.pose.bones["Head"].rotation_mode = "XYZ"
rig.pose.bones["Head"].keyframe_insert("rotation_euler", frame=50)
head.softness = 0
head.keyframe_insert("softness", frame=FIRST)
head.softness = 1
head.keyframe_insert("softness", frame=50)
recording = duet_blender.leader.Recording(scene, leader)
for _ in recording.take():
    pass
state["constraints_sent"] = recording.pins.constraints
state["bone_pin"] = {"bone": head.bone, "thing": head.thing.name, "place": place(rig, "Head", 50)}
state["keyed"] = {}
for frame in (25, 45):
    scene.frame_set(frame)
    state["keyed"][frame] = [value / METRE for value in hand.thing.matrix_world.translation]
state["pin_panel"] = scenes.drawn(duet_blender.panel.VIEW3D_PT_duet_pins)
state["other_panels"] = [scenes.drawn(panel) for panel in duet_blender.panel._PANELS[2:]]
assert bpy.ops.duet.react() == {"FINISHED"}
state["told"] = settings.answers[0].pins
state["hands"] = {frame: place(follower(), "right_hand", frame) for frame in (25, 45)}
hand.joint = "wing"
state["wing"] = attempt(bpy.ops.duet.react)
hand.joint = "right_hand"
hand.thing.animation_data.action.fcurves[0].keyframe_points[0].co.x = 200
for curve in hand.thing.animation_data.action.fcurves:
    for key in curve.keyframe_points:
        key.co.x = 200
state["outside"] = attempt(bpy.ops.duet.react)
hand.thing = None
state["nothing"] = attempt(bpy.ops.duet.react)
settings.pins.clear()

# ---- A copy of an armature of the user's.
JOINTS = {"head": "Head", "neck": "Neck"}
for side in ("left", "right"):
    for joint, bone in (("shoulder", "Arm"), ("elbow", "ForeArm"), ("hand", "Hand"), ("hip", "UpLeg"),
                        ("knee", "Leg"), ("foot", "Foot")):
        JOINTS[f"{side}_{joint}"] = side.capitalize() + bone


FRAMES = range(FIRST, LAST + 1, 7)


def distances(prefix):
    """Mean distance of each joint of the partner's armature from that of the mannequin, in metres."""
    return {joint: sum(math.dist(place(follower(), prefix + bone, frame), wanted)
                       for frame, wanted in zip(FRAMES, mannequin[joint])) / len(FRAMES)
            for joint, bone in JOINTS.items()}


bpy.data.objects.remove(rig)
settings.labels["hug"].weight = 1
assert bpy.ops.duet.react() == {"FINISHED"}
settings.body = "OWN"
state["no_armature"] = attempt(bpy.ops.duet.choose, index=0)
settings.body = "MANNEQUIN"
mannequin = {joint: [place(follower(), joint, frame) for frame in FRAMES] for joint in JOINTS}
state["characters"] = {}
for name, size, prefix in (("Usual", 1, ""), ("Large", 1.15, "mixamorig:"), ("Small", 0.85, "")):
    settings.target = scenes.add_character(scene, name, size, prefix)
    settings.body = "OWN"
    assert bpy.ops.duet.choose(index=0) == {"FINISHED"}
    state["characters"][name] = distances(prefix)
    state["own_bones"] = sorted(bone.name for bone in settings.target.data.bones)
    state["copied_bones"] = sorted(bone.name for bone in follower().data.bones)
    bpy.data.objects.remove(settings.target)
settings.body = "MANNEQUIN"

# ---- Another model.
before = set(scene.objects)
bpy.ops.import_scene.gltf(filepath=dancer_file)
scene.render.fps = 24
dancer = next(thing for thing in scene.objects if thing not in before and thing.type == "ARMATURE")
settings.leader = dancer
settings.model = next(model.name for model in settings.models if model.name.startswith("salsa@"))
state["salsa_classes"] = [label.name for label in settings.labels]
state["salsa_joints"] = [joint.name for joint in settings.joints]
settings.labels["basic"].weight = 1
state["salsa"] = attempt(bpy.ops.duet.react)
state["salsa_bones"] = [bone.name for bone in follower().pose.bones]
places = {joint: place(follower(), joint, 40) for joint in ("left_ankle", "left_toe", "right_wrist")}
settings.body = "LEADER"
state["salsa_rig"] = attempt(bpy.ops.duet.react)
state["salsa_rig_bones"] = [bone.name for bone in follower().pose.bones]
state["dancer_bones"] = [bone.name for bone in dancer.pose.bones]
state["salsa_rig_places"] = [[places[joint], place(follower(), joint, 40)] for joint in places]

(OUT / "state.json").write_text(json.dumps(state), encoding="utf-8")
bpy.ops.wm.save_as_mainfile(filepath=str(OUT / "out.blend"))
duet_blender.unregister()
