"""Scenes of the tests that Blender runs."""

import sys
import types

import bpy
import numpy

UNITS_PER_METRE = 2
BONES = (  # of a character in a T-pose: name, parent, head and tail in metres
    ("Hips", None, (0, 0, 0.96), (0, 0, 1.04)), ("Spine", "Hips", (0, 0, 1.04), (0, 0, 1.16)),
    ("Spine1", "Spine", (0, 0, 1.16), (0, 0, 1.3)), ("Spine2", "Spine1", (0, 0, 1.3), (0, 0, 1.46)),
    ("Neck", "Spine2", (0, 0, 1.46), (0, -0.01, 1.56)), ("Head", "Neck", (0, -0.01, 1.56), (0, -0.02, 1.76)))
LIMBS = (  # of the left side
    ("Shoulder", "Spine2", (0.05, 0, 1.42), (0.16, 0, 1.42)), ("Arm", "Shoulder", (0.16, 0, 1.42), (0.44, 0, 1.42)),
    ("ForeArm", "Arm", (0.44, 0, 1.42), (0.7, 0, 1.42)), ("Hand", "ForeArm", (0.7, 0, 1.42), (0.8, 0, 1.42)),
    ("UpLeg", "Hips", (0.1, 0, 0.92), (0.1, 0, 0.5)), ("Leg", "UpLeg", (0.1, 0, 0.5), (0.1, 0, 0.09)),
    ("Foot", "Leg", (0.1, 0, 0.09), (0.1, -0.14, 0.02)))


def open_leader(file, addon_folder, frames, current):
    """A scene of 24 frames a second, whose unit is half a metre, with the leader of a glTF file. Its
    armature is called "Rig"."""
    sys.path.insert(0, addon_folder)
    if "bool" not in numpy.__dict__:  # Debian 12's importer, see duet_blender.partner
        numpy.bool = bool
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.fps, scene.render.fps_base = 24, 1
    scene.unit_settings.scale_length = 1 / UNITS_PER_METRE
    bpy.ops.import_scene.gltf(filepath=file)
    scene.render.fps = 24
    scene.frame_start, scene.frame_end = frames
    scene.frame_set(current)
    leader = next(thing for thing in scene.objects if thing.type == "ARMATURE")
    leader.name = "Rig"
    return scene, leader


def add_character(scene, name, size=1.0, prefix=""):
    """An armature named as Mixamo does, `size` times as large as most people."""
    armature = bpy.data.objects.new(name, bpy.data.armatures.new(name))
    scene.collection.objects.link(armature)
    bpy.context.view_layer.objects.active = armature
    bpy.ops.object.mode_set(mode="EDIT")
    bones = {}

    def add(own, parent, head, tail, side=""):
        mirror = (-1 if side == "Right" else 1, 1, 1)
        bone = bones[side + own] = armature.data.edit_bones.new(prefix + side + own)
        for end, place in (("head", head), ("tail", tail)):
            setattr(bone, end, [size * UNITS_PER_METRE * a * b for a, b in zip(place, mirror)])
        if parent:
            bone.parent = bones.get(side + parent) or bones[parent]
    for bone in BONES:
        add(*bone)
    for side in ("Left", "Right"):
        for bone in LIMBS:
            add(*bone, side=side)
    bpy.ops.object.mode_set(mode="OBJECT")
    return armature


class Layout:
    """Draws a panel without a window: checks what Blender would show, and lists it."""

    def __init__(self):
        self.shown = []

    def __getattr__(self, name):
        if name.startswith("use_property_"):
            raise AttributeError(name)
        known = bpy.types.UILayout.bl_rna.functions[name].parameters.keys()

        def draw(*arguments, **options):
            unknown = set(options) - set(known)
            assert not unknown, f"{name}: {unknown}"
            return self.draw(name, arguments, options)
        return draw

    def draw(self, name, arguments, options):
        if name == "operator":
            module, function = arguments[0].split(".")
            getattr(getattr(bpy.ops, module), function).get_rna_type()  # fails if there is none
        elif name in ("prop", "prop_search"):
            things = arguments if name == "prop_search" else arguments[:2]
            for thing, attribute in zip(things[::2], things[1::2]):
                getattr(thing, attribute)
        if name in ("operator", "prop", "prop_search", "label"):
            self.shown.append(arguments[1] if name.startswith("prop") else
                              options.get("text") or arguments[0])
        return types.SimpleNamespace() if name == "operator" else self


def drawn(panel):
    """What a panel shows now."""
    layout = Layout()
    panel.draw(types.SimpleNamespace(layout=layout), bpy.context)
    return layout.shown
