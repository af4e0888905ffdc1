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
        box.operator("duet.ask_for_classes", text="Ask the server for classes" if duet.labels
                     else "Show classes")
        layout.prop(duet, "seed")
        layout.prop(duet, "variety")
        layout.operator("duet.react", icon="ARMATURE_DATA")
        if duet.state:
            layout.label(text=duet.state)


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


def register():
    bpy.utils.register_class(VIEW3D_PT_duet)
    bpy.utils.register_class(VIEW3D_PT_duet_server)


def unregister():
    bpy.utils.unregister_class(VIEW3D_PT_duet_server)
    bpy.utils.unregister_class(VIEW3D_PT_duet)
