"""Pins: an empty or a bone that says where a joint of the partner is. Every key frame of its
place is a constraint of the request."""

import bpy

from . import partner
from .actions import keyed_frames
from .program import DuetError

RADIUS_METRES = 0.06  # of an empty that "Add pin" makes
_PLACES = ("location", "delta_location")


def _is_pin(_, thing):
    return thing.type in ("EMPTY", "ARMATURE")


class DuetPin(bpy.types.PropertyGroup):
    thing: bpy.props.PointerProperty(
        name="Object", type=bpy.types.Object, poll=_is_pin,
        description="An empty, or an armature of which a bone's head is the place. Each key frame of "
                    "its place pins the joint in that frame")
    bone: bpy.props.StringProperty(name="Bone", description="The bone whose head is the place")
    joint: bpy.props.StringProperty(name="Joint", default="right_hand",
                                    description="The partner's joint")
    frame: bpy.props.IntProperty(
        name="Frame", description="The frame of the pin while its object has no key frames")
    softness: bpy.props.FloatProperty(
        name="Softness", min=0, max=1, default=0, options={"ANIMATABLE"},
        description="Share of the distance that may remain: 0 reaches the place, 1 moves nothing. "
                    "Can be animated")


def keyed_frames_of(pin):
    """The frames of the key frames of a pin's object or bone, sorted."""
    if pin.thing.type != "ARMATURE":
        return keyed_frames(pin.thing, lambda data_path: data_path in _PLACES)
    path = f'pose.bones["{bpy.utils.escape_identifier(pin.bone)}"]'
    return keyed_frames(pin.thing, lambda data_path: data_path.startswith(path))


class Sampler:
    """Collects the pins while the scene's frames are visited."""

    def __init__(self, scene, metres):
        self.scene, self.metres = scene, metres
        self.constraints = []  # of the request, in text format
        self._frames = [self._frames_in_range(pin) for pin in scene.duet.pins]

    def _frames_in_range(self, pin):
        if pin.thing is None:
            raise DuetError(f"The pin of {pin.joint} has no object. Choose one, or remove the pin.")
        if pin.thing.type == "ARMATURE" and pin.bone not in pin.thing.pose.bones:
            raise DuetError(f"The pin of {pin.joint} needs a bone of {pin.thing.name}. Choose one.")
        first, last = self.scene.frame_start, self.scene.frame_end
        frames = {frame for frame in keyed_frames_of(pin) or [pin.frame] if first <= frame <= last}
        if not frames:
            raise DuetError(f"The pin of {pin.joint} ({pin.thing.name}) has no key frame from frame "
                            f"{first} to {last}.")
        return frames

    def take(self, frame):
        """Adds the pins of the scene's current frame."""
        for pin, frames in zip(self.scene.duet.pins, self._frames):
            if frame not in frames:
                continue
            x, y, z = (self.metres * value for value in place_of(pin))
            joint = pin.joint.replace("\\", "\\\\").replace('"', '\\"')
            self.constraints.append(
                f'constraints {{ joint_name: "{joint}" frame: {frame - self.scene.frame_start} '
                f"position {{ x: {x:.5f} y: {z:.5f} z: {-y:.5f} }} softness: {pin.softness:.4g} }}")


def place_of(pin):
    """The place of a pin in the current frame, in the scene's world and unit."""
    if pin.thing.type == "ARMATURE":
        return pin.thing.matrix_world @ pin.thing.pose.bones[pin.bone].head
    return pin.thing.matrix_world.translation


def describe(constraints, first_frame):
    """What remains of each pin, as one line; "" without pins. `constraints`: of the program's
    summary."""
    far = [f"{pin['joint_name']} at {first_frame + pin['frame']}: "
           f"{100 * pin['remaining_metres']:.0f} cm away"
           for pin in constraints if pin["remaining_metres"] >= 0.01]
    if not constraints:
        return ""
    return ", ".join(far) or "All pins reached"


class DUET_OT_add_pin(bpy.types.Operator):
    """Pins a joint of the partner: to the selected empty, to the active bone in pose mode, or to a
    new empty where the joint is"""

    bl_idname = "duet.add_pin"
    bl_label = "Add pin"
    bl_options = {"REGISTER", "UNDO"}

    joint: bpy.props.StringProperty(name="Joint", default="right_hand")

    def execute(self, context):
        scene = context.scene
        thing, bone = context.active_object, ""
        if context.mode == "POSE" and context.active_pose_bone:
            bone = context.active_pose_bone.name
        elif thing is None or thing.type != "EMPTY" or not thing.select_get():
            thing = self._new_empty(context)
        pin = scene.duet.pins.add()
        pin.thing, pin.bone, pin.joint = thing, bone, self.joint
        pin.frame = scene.frame_current
        return {"FINISHED"}

    def _new_empty(self, context):
        scene = context.scene
        empty = bpy.data.objects.new(f"Pin {self.joint}", None)
        empty.empty_display_type = "SPHERE"
        empty.empty_display_size = RADIUS_METRES / scene.unit_settings.scale_length
        empty.location = partner.joint_place(scene, self.joint) or scene.cursor.location
        scene.collection.objects.link(empty)
        for other in context.selected_objects:
            other.select_set(False)
        empty.select_set(True)
        context.view_layer.objects.active = empty
        return empty


class DUET_OT_remove_pin(bpy.types.Operator):
    """Removes the pin. Its object stays"""

    bl_idname = "duet.remove_pin"
    bl_label = "Remove pin"
    bl_options = {"REGISTER", "UNDO"}

    index: bpy.props.IntProperty()

    def execute(self, context):
        context.scene.duet.pins.remove(self.index)
        return {"FINISHED"}


register, unregister = bpy.utils.register_classes_factory((DuetPin, DUET_OT_add_pin, DUET_OT_remove_pin))
