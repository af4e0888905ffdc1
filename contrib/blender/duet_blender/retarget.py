"""Lets an armature of the user's follow the partner, by Blender's own constraints: the bones of the
trunk copy keyed empties, each limb's bones track the partner's joints, and hands and feet reach them
by inverse kinematics, which begins at the tracked pose."""

import json
import os
import tempfile

import bpy

from . import leader, partner, program
from .actions import curves_of
from .program import DuetError
from .puppet import basis

MARK = "Duet"  # the beginning of the names of its constraints, and a property of its empties
_SIDES = ("left", "right")
_LIMBS = (("shoulder", "elbow"), ("elbow", "hand"), ("hip", "knee"), ("knee", "foot"))
_ENDS = (("shoulder", "elbow", "hand"), ("hip", "knee", "foot"))
_SAME = {"hand": "wrist", "foot": "ankle"}  # other names of the joints of models
# Inverse kinematics moves the end of a bone. It must be this near to the next joint, in lengths of the
# bone.
_AT_END = 0.03
# A bone must point to the next joint along one of its axes, within this cosine (8 degrees).
_ALONG = 0.99
_AXES = {"X": (1, 0, 0), "Y": (0, 1, 0), "Z": (0, 0, 1)}


def _named(names, joint):
    """`joint`, or its other name, if `names` has it."""
    if joint in names:
        return joint
    for part, other in _SAME.items():
        if joint.replace(part, other) in names:
            return joint.replace(part, other)
    return None


def _segments(names):
    """Pairs of joints that a bone connects: those of the limbs, and the neck."""
    limbs = [(f"{side}_{a}", f"{side}_{b}") for side in _SIDES for a, b in _LIMBS]
    pairs = [(_named(names, a), _named(names, b)) for a, b in (*limbs, ("neck", "head"))]
    return [pair for pair in pairs if None not in pair]


def _limbs(names):
    """The joints of each limb: upper, middle and end."""
    chains = [[_named(names, f"{side}_{joint}") for joint in joints]
              for side in _SIDES for joints in _ENDS]
    return [joints for joints in chains if None not in joints]


def _bones_of(scene, armature):
    """A generator that returns the armature's bones by joint, as the program recognises them."""
    duet = scene.duet
    before = armature.data.pose_position
    armature.data.pose_position = "REST"
    bpy.context.view_layer.update()
    try:
        rest = leader.Recording(scene, armature, with_pins=False)
        rest.take_frame()
    finally:
        armature.data.pose_position = before
        bpy.context.view_layer.update()
    with tempfile.TemporaryDirectory() as folder:
        file = os.path.join(folder, "rest.bvh")
        rest.write(file)
        output = yield from program.run(duet, "inspect", file, "--metres-per-unit", "1", "--json",
                                        may_fail=True)
    bones = {}
    heads = {name: bone for name, _, bone, tail in rest.joints if not tail}
    for found in json.loads(output)["files"][0]["people"][0]["joints"]:
        if len(found["parts"]) == 1 and found["parts"][0]["joint"] in heads:
            bones[found["joint"]] = heads[found["parts"][0]["joint"]]
    for joint in duet.joints:
        if joint.bone in armature.pose.bones:
            bones[joint.name] = joint.bone
    return bones


class _Target:
    """The user's armature at rest: bones by joint, and the chain of the trunk."""

    def __init__(self, armature, bones):
        self.armature, self.bones = armature, bones
        self.rest = armature.data.bones
        needed = [f"{side}_{joint}" for side in _SIDES for joint in ("hip", "shoulder", "knee")]
        missing = [joint for joint in needed if joint not in bones]
        if missing:
            raise DuetError(f"{armature.name}: expected bones for {', '.join(missing)}, got none. "
                            "Choose the bones in the panel, under Reading the leader.")
        self.trunk = self._trunk()

    def _trunk(self):
        """The bones from the pelvis to the chest."""
        pelvis = self._common(self.bones["left_hip"], self.bones["right_hip"])
        chain = [self._common(self.bones["left_shoulder"], self.bones["right_shoulder"])]
        while chain[-1] != pelvis and chain[-1] and chain[-1].parent:
            chain.append(chain[-1].parent)
        if not pelvis or chain[-1] != pelvis:
            raise DuetError(f"{self.armature.name}: expected a spine that begins at the parent of both "
                            "legs, got another hierarchy. Use Body: Leader's rig.")
        return chain[::-1]

    def _common(self, a, b):
        above = self.rest[a].parent_recursive
        return next((bone for bone in self.rest[b].parent_recursive if bone in above), None)

    def head(self, joint):
        return self.armature.matrix_world @ self.rest[self.bones[joint]].head_local

    def rotation(self, bone):
        return (self.armature.matrix_world @ bone.matrix_local).to_3x3().normalized()

    def axis(self, joint, following):
        """The axis along which a joint's bone points to the next joint, such as "TRACK_Y"."""
        bone, after = self.rest[self.bones[joint]], self.bones.get(following)
        end = self.rest[after].head_local if after else bone.tail_local
        way = bone.matrix_local.to_3x3().inverted() @ (end - bone.head_local)
        way.normalize()
        for name, axis in _AXES.items():
            along = sum(a * b for a, b in zip(way, axis))
            if abs(along) > _ALONG:
                return f"TRACK_{'NEGATIVE_' if along < 0 else ''}{name}"
        raise DuetError(f"{bone.name}: expected a bone that points to {following}, got one that points "
                        "elsewhere. Use Body: Leader's rig.")

    def chain(self, upper, middle, end):
        """The number of bones from a limb's middle up to its upper joint; 0 if its end is not the tail
        of a bone."""
        if not all(joint in self.bones for joint in (upper, middle, end)):
            return 0
        bone, last = self.rest[self.bones[middle]], self.rest[self.bones[end]]
        above = [bone, *bone.parent_recursive]
        off = (bone.tail_local - last.head_local).length
        if self.rest[self.bones[upper]] not in above or off > _AT_END * bone.length:
            return 0
        return 1 + above.index(self.rest[self.bones[upper]])

    def leg(self):
        return sum((self.head(f"left_{a}") - self.head(f"left_{b}")).length
                   for a, b in (("hip", "knee"), ("knee", _named(self.bones, "left_foot")[5:])))


class _Trunk:
    """Where hips and shoulders are."""

    def __init__(self, place):
        hips = [place(f"{side}_hip") for side in _SIDES]
        shoulders = [place(f"{side}_shoulder") for side in _SIDES]
        self.middle, top = sum(hips[1:], hips[0]) / 2, sum(shoulders[1:], shoulders[0]) / 2
        self.pelvis = basis(*hips, self.middle, top)
        self.chest = basis(*shoulders, self.middle, top)


def _source(scene):
    source = partner.last(scene)
    if source is None:
        raise DuetError("There is no partner yet. Press React.")
    needed = [f"{side}_{joint}" for side in _SIDES for joint in ("hip", "shoulder")]
    if any(joint not in source.pose.bones for joint in needed):
        raise DuetError("The partner has no mannequin. Choose Body: Mannequin, and press React.")
    return source


def follow(scene, target):
    """A generator that lets `target` follow the last partner. Replaces its earlier constraints of
    this kind."""
    source, fit, empties = yield from _attach(scene, target)
    yield from _key(scene, source, fit, empties)


def follow_live(scene, target):
    """The same for a partner that moves without key frames. A generator that returns a LiveTrunk."""
    _, fit, empties = yield from _attach(scene, target)
    return LiveTrunk(fit, empties)


class LiveTrunk:
    """Moves the empties that the trunk of an armature copies, as the partner moves."""

    def __init__(self, fit, empties):
        self._fit, self._empties = fit, empties
        self._fitting = None  # after the first frame

    def place(self, joints):
        """Moves the empties: places of the partner's joints in the world, by name."""
        now = _Trunk(joints.__getitem__)
        if self._fitting is None:
            feet = [joints[_named(joints, f"{side}_foot")] for side in _SIDES]
            self._fitting = _Fitting(self._fit, joints, min(foot.z for foot in feet))
        for empty, (rotation, place) in zip(self._empties, self._fitting.places(now)):
            rotation.make_compatible(empty.rotation_quaternion)
            empty.rotation_quaternion = rotation
            if place is not None:
                empty.location = place


def _attach(scene, target):
    """A generator that adds constraints to `target`, and returns the partner, how `target` fits, and
    the empties that its trunk copies."""
    source = _source(scene)
    if target is source:
        raise DuetError("Choose an armature of your own, not the partner.")
    bones = yield from _bones_of(scene, target)
    fit = _Target(target, bones)
    # Everything that can fail comes before the first change.
    tracks = [(bones[a], b, fit.axis(a, b)) for a, b in _segments(source.pose.bones) if a in bones]
    chains = [(bones[middle], end, fit.chain(upper, middle, end))
              for upper, middle, end in _limbs(source.pose.bones) if middle in bones]
    release(scene, target)
    empties = [_empty(scene, target, bone) for bone in fit.trunk]
    for bone, empty in zip(fit.trunk, empties):
        kinds = ["COPY_LOCATION"] if bone == fit.trunk[0] else []
        for kind in [*kinds, "COPY_ROTATION"]:
            _constrain(target, bone.name, kind, empty)
    for bone, joint, axis in tracks:
        _constrain(target, bone, "DAMPED_TRACK", source, subtarget=joint, track_axis=axis)
    for bone, joint, count in chains:
        if count:
            _constrain(target, bone, "IK", source, subtarget=joint, chain_count=count,
                       use_stretch=False)
    return source, fit, empties


def _constrain(target, bone, kind, thing, **settings):
    constraint = target.pose.bones[bone].constraints.new(kind)
    constraint.name = f"{MARK} {constraint.name}"
    constraint.target = thing
    for name, value in settings.items():
        setattr(constraint, name, value)


def _empty(scene, target, bone):
    empty = bpy.data.objects.new(f"{MARK} {bone.name}", None)
    empty[MARK] = target.name
    empty.rotation_mode = "QUATERNION"
    empty.empty_display_size = 0.05 / scene.unit_settings.scale_length
    scene.collection.objects.link(empty)
    empty.hide_set(True)
    return empty


class _Fitting:
    """Puts the partner's trunk on an armature. Legs of another length change the height of the hips
    above the floor, which is at the partner's lowest ankle."""

    def __init__(self, fit, joints, floor):
        """`joints`: places of the partner's joints by name, in any frame."""
        self._fit, self._floor = fit, floor
        self._rest = _Trunk(fit.head)
        chain = [joints[joint] for joint in ("left_hip", "left_knee", _named(joints, "left_foot"))]
        self._longer = fit.leg() / ((chain[0] - chain[1]).length + (chain[1] - chain[2]).length)
        self._offset = fit.armature.matrix_world @ fit.trunk[0].head_local - self._rest.middle

    def places(self, now):
        """The rotation of each empty, and the place of the first one, for a trunk of the partner."""
        turns = (now.pelvis @ self._rest.pelvis.inverted(), now.chest @ self._rest.chest.inverted())
        at = now.middle.copy()
        at.z = self._floor + (at.z - self._floor) * self._longer
        ends = [turn.to_quaternion() for turn in turns]
        last = max(1, len(self._fit.trunk) - 1)
        return [(ends[0].slerp(ends[1], i / last) @ self._fit.rotation(bone).to_quaternion(),
                 at + turns[0] @ self._offset if i == 0 else None)
                for i, bone in enumerate(self._fit.trunk)]


def _key(scene, source, fit, empties):
    """Keys the empties: the partner's trunk, on the bones of the target."""
    before, subframe = scene.frame_current, scene.frame_subframe
    pose, feet = source.pose.bones, [_named(source.pose.bones, f"{side}_foot") for side in _SIDES]
    first, ankles, rows = None, [], []
    try:
        for frame in range(scene.frame_start, scene.frame_end + 1):
            scene.frame_set(frame)
            joints = {bone.name: source.matrix_world @ bone.head for bone in pose}
            first = first or joints
            ankles.append(min(joints[foot].z for foot in feet))
            rows.append((frame, _Trunk(joints.__getitem__)))
            yield
    finally:
        scene.frame_set(before, subframe=subframe)
    fitting = _Fitting(fit, first, min(ankles))
    for frame, now in rows:
        _key_row(frame, empties, fitting.places(now))
    for empty in empties:
        for curve in curves_of(empty.animation_data.action):
            for key in curve.keyframe_points:
                key.interpolation = "LINEAR"


def _key_row(frame, empties, places):
    for empty, (rotation, place) in zip(empties, places):
        if frame > empty.get("last_frame", frame):
            rotation.make_compatible(empty.rotation_quaternion)
        empty["last_frame"] = frame
        empty.rotation_quaternion = rotation
        empty.keyframe_insert("rotation_quaternion", frame=frame)
        if place is not None:
            empty.location = place
            empty.keyframe_insert("location", frame=frame)


def _constraints(target):
    return [(bone, constraint) for bone in target.pose.bones for constraint in bone.constraints
            if constraint.name.startswith(f"{MARK} ")]


def follows(target):
    """Whether an armature follows a partner."""
    return target is not None and bool(_constraints(target))


def release(scene, target):
    """Removes the constraints and empties by which an armature follows a partner."""
    for bone, constraint in _constraints(target):
        bone.constraints.remove(constraint)
    for thing in [thing for thing in scene.objects if thing.get(MARK) == target.name]:
        action = thing.animation_data and thing.animation_data.action
        bpy.data.objects.remove(thing)
        if action and not action.users:
            bpy.data.actions.remove(action)


def bake(context, target):
    """Turns what the constraints do into an action of the armature, and removes them."""
    scene, before = context.scene, context.scene.frame_current
    selected, active = list(context.selected_objects), context.view_layer.objects.active
    for thing in selected:
        thing.select_set(False)
    target.select_set(True)
    context.view_layer.objects.active = target
    bpy.ops.object.mode_set(mode="POSE")
    try:
        bpy.ops.nla.bake(frame_start=scene.frame_start, frame_end=scene.frame_end, only_selected=False,
                         visual_keying=True, use_current_action=False, bake_types={"POSE"})
    finally:
        bpy.ops.object.mode_set(mode="OBJECT")
        for thing in selected:
            thing.select_set(True)
        context.view_layer.objects.active = active
    release(scene, target)
    scene.frame_set(before)
