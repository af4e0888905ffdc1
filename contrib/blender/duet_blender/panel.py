"""The panel "Duet" in the 3D view's sidebar."""

import bpy

from . import pins


class VIEW3D_PT_duet(bpy.types.Panel):
    bl_label = "Duet"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Duet"

    def draw(self, context):
        layout, duet = self.layout, context.scene.duet
        layout.use_property_split = True
        layout.use_property_decorate = True  # the dots that set key frames
        layout.prop(duet, "leader")
        layout.prop(duet, "place")
        box = layout.box()
        for label in duet.labels:
            box.prop(label, "weight", text=label.name.replace("_", " ").capitalize(), slider=True)
        row = box.row(align=True)
        row.operator("duet.key_labels", icon="KEY_HLT")
        row.operator("duet.ask_for_classes", icon="FILE_REFRESH", text="Classes")
        row = layout.row(heading="Seed")
        row.prop(duet, "own_seed", text="")
        field = row.row()
        field.active = duet.own_seed
        field.prop(duet, "seed", text="")
        layout.prop(duet, "variety")
        layout.prop(duet, "candidates")
        layout.prop(duet, "body")
        if duet.body == "OWN":
            layout.prop(duet, "target")
        row = layout.row(align=True)
        row.operator("duet.react", icon="ARMATURE_DATA")
        row.operator("duet.show_eight", icon="OUTLINER_OB_GROUP_INSTANCE")
        if len(duet.answers) > 1:
            _draw_answers(layout, duet)
        layout.operator("duet.keep", icon="PINNED")
        if duet.state:
            layout.label(text=duet.state)


def _draw_answers(layout, duet):
    """One row for each answer, best first."""
    column = layout.column(align=True)
    for index, answer in enumerate(duet.answers):
        icon = "CHECKMARK" if answer.faults <= 0.05 else "DOT" if answer.faults <= 0.25 else "ERROR"
        text = ", ".join(filter(None, (f"Seed {answer.seed}", answer.grade, answer.pins)))
        column.operator("duet.choose", text=text, icon=icon,
                        depress=index == duet.chosen).index = index


class _Part:
    """Base of the panels below the first one."""

    bl_parent_id = "VIEW3D_PT_duet"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_options = {"DEFAULT_CLOSED"}


class VIEW3D_PT_duet_pins(_Part, bpy.types.Panel):
    bl_label = "Pins"

    def draw(self, context):
        layout, duet = self.layout, context.scene.duet
        layout.use_property_split = True
        for index, pin in enumerate(duet.pins):
            box = layout.box()
            row = box.row()
            row.prop_search(pin, "joint", duet, "joints")
            row.operator("duet.remove_pin", text="", icon="X").index = index
            box.prop(pin, "thing")
            if pin.thing and pin.thing.type == "ARMATURE":
                box.prop_search(pin, "bone", pin.thing.data, "bones")
            if pin.thing:
                frames = pins.keyed_frames_of(pin)
                if not frames:
                    box.prop(pin, "frame")
                elif len(frames) == 1:
                    box.label(text=f"1 key frame, {frames[0]}")
                else:
                    box.label(text=f"{len(frames)} key frames, {frames[0]} to {frames[-1]}")
            box.prop(pin, "softness", slider=True)
        layout.operator("duet.add_pin", icon="PINNED")


class VIEW3D_PT_duet_reading(_Part, bpy.types.Panel):
    bl_label = "Reading the leader"

    def draw(self, context):
        layout, duet = self.layout, context.scene.duet
        layout.use_property_split = True
        layout.prop(duet, "unit")
        layout.label(text="Bones whose names are not recognised:")
        _draw_bones(layout, duet.joints, "bone", duet.leader)
        if duet.body == "OWN":
            layout.label(text="Of your armature:")
            _draw_bones(layout, duet.joints, "rig_bone", duet.target)


def _draw_bones(layout, joints, field, armature):
    for joint in joints:
        title = joint.name.replace("_", " ").capitalize()
        if armature:
            layout.prop_search(joint, field, armature.data, "bones", text=title)
        else:
            layout.prop(joint, field, text=title)


class VIEW3D_PT_duet_server(_Part, bpy.types.Panel):
    bl_label = "Server"

    def draw(self, context):
        self.layout.use_property_split = True
        self.layout.prop(context.scene.duet, "server")
        self.layout.prop(context.scene.duet, "program")
        self.layout.prop_search(context.scene.duet, "model", context.scene.duet, "models")


_PANELS = (VIEW3D_PT_duet, VIEW3D_PT_duet_pins, VIEW3D_PT_duet_reading, VIEW3D_PT_duet_server)
register, unregister = bpy.utils.register_classes_factory(_PANELS)
