"""The panel "Duet" in the 3D view's sidebar."""

import bpy


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
        box.operator("duet.ask_for_classes")
        layout.prop(duet, "seed")
        layout.prop(duet, "variety")
        layout.prop(duet, "candidates")
        layout.prop(duet, "body")
        layout.operator("duet.react", icon="ARMATURE_DATA")
        layout.operator("duet.keep", icon="PINNED")
        if duet.state:
            layout.label(text=duet.state)


class VIEW3D_PT_duet_reading(bpy.types.Panel):
    bl_label = "Reading the leader"
    bl_parent_id = "VIEW3D_PT_duet"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        layout, duet = self.layout, context.scene.duet
        layout.use_property_split = True
        layout.prop(duet, "unit")
        layout.label(text="Bones whose names are not recognised:")
        for joint in duet.joints:
            title = joint.name.replace("_", " ").capitalize()
            if duet.leader:
                layout.prop_search(joint, "bone", duet.leader.data, "bones", text=title)
            else:
                layout.prop(joint, "bone", text=title)


class VIEW3D_PT_duet_server(bpy.types.Panel):
    bl_label = "Server"
    bl_parent_id = "VIEW3D_PT_duet"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        self.layout.use_property_split = True
        self.layout.prop(context.scene.duet, "server")
        self.layout.prop(context.scene.duet, "program")


_PANELS = (VIEW3D_PT_duet, VIEW3D_PT_duet_reading, VIEW3D_PT_duet_server)


def register():
    for panel in _PANELS:
        bpy.utils.register_class(panel)


def unregister():
    for panel in reversed(_PANELS):
        bpy.utils.unregister_class(panel)
