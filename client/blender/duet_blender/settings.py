"""What the panel holds: one group of properties on every scene."""

import bpy

# Of the server's own model, until the server has been asked for others.
CLASSES = ("kick", "push", "shake_hands", "hug", "exchange_object", "punch")
# Joints of the models, in the order in which they are shown.
JOINTS = ("head", "neck", "torso", "left_shoulder", "left_elbow", "left_hand", "right_shoulder",
          "right_elbow", "right_hand", "left_hip", "left_knee", "left_foot", "right_hip", "right_knee",
          "right_foot")


class DuetLabel(bpy.types.PropertyGroup):
    """One interaction class; `name` is the class."""

    weight: bpy.props.FloatProperty(
        name="Weight", description="1 wanted, 0 neutral, -1 avoided; may have key frames",
        default=0, min=-2, max=2, soft_min=-1, soft_max=1, options={"ANIMATABLE"})


class DuetJoint(bpy.types.PropertyGroup):
    """A joint of the model, `name`, and the bone whose head it is."""

    bone: bpy.props.StringProperty(
        name="Bone", description="The bone whose head this joint is; empty: found by the bones' names")


def _is_armature(_, thing):
    return thing.type == "ARMATURE"


def _is_empty(_, thing):
    return thing.type == "EMPTY"


class DuetSettings(bpy.types.PropertyGroup):
    leader: bpy.props.PointerProperty(
        name="Leader", type=bpy.types.Object, poll=_is_armature,
        description="The armature that the partner reacts to, over the scene's frames")
    place: bpy.props.PointerProperty(
        name="Place", type=bpy.types.Object, poll=_is_empty,
        description="An empty where the partner begins; without one the model chooses")
    labels: bpy.props.CollectionProperty(type=DuetLabel)
    joints: bpy.props.CollectionProperty(type=DuetJoint)
    unit: bpy.props.EnumProperty(
        name="Unit", description="The length of one unit of the leader's armature",
        items=(("SCENE", "Scene", "The unit of the scene"), ("METRES", "Metres", ""),
               ("CENTIMETRES", "Centimetres", ""), ("MILLIMETRES", "Millimetres", ""),
               ("INCHES", "Inches", "")))
    body: bpy.props.EnumProperty(
        name="Body", description="What the partner is shown as",
        items=(("MANNEQUIN", "Mannequin", "Duet's own"),
               ("LEADER", "Leader's rig", "A copy of the leader's armature and meshes")))
    seed: bpy.props.IntProperty(name="Seed", min=0, default=0,
                                description="Which answer of a model that samples")
    variety: bpy.props.FloatProperty(name="Variety", min=0, max=2, default=1,
                                     description="0 the typical answer, 1 as varied as people")
    server: bpy.props.StringProperty(name="Server", default="localhost:50051")
    program: bpy.props.StringProperty(name="Program", default="duet", subtype="FILE_PATH",
                                      description="Where the program `duet` is")
    state: bpy.props.StringProperty(name="State", options={"SKIP_SAVE"})


def set_classes(settings, classes):
    """Makes the sliders those of these classes; weights of the same names stay."""
    if [label.name for label in settings.labels] == list(classes):
        return
    weights = {label.name: label.weight for label in settings.labels}
    settings.labels.clear()
    for name in classes:
        label = settings.labels.add()
        label.name = name
        label.weight = weights.get(name, 0)


def fill(scene):
    """Gives a scene that has none its sliders and its joints."""
    if not scene.duet.labels:
        set_classes(scene.duet, CLASSES)
    if not scene.duet.joints:
        for name in JOINTS:
            scene.duet.joints.add().name = name


@bpy.app.handlers.persistent
def _fill_all(*_):
    for scene in bpy.data.scenes:
        fill(scene)


def register():
    bpy.utils.register_class(DuetLabel)
    bpy.utils.register_class(DuetJoint)
    bpy.utils.register_class(DuetSettings)
    bpy.types.Scene.duet = bpy.props.PointerProperty(type=DuetSettings)
    bpy.app.handlers.load_post.append(_fill_all)
    if hasattr(bpy.data, "scenes"):
        _fill_all()
    else:  # while Blender switches an add-on on, scenes are out of reach
        bpy.app.timers.register(_fill_all, first_interval=0)


def unregister():
    bpy.app.handlers.load_post.remove(_fill_all)
    del bpy.types.Scene.duet
    bpy.utils.unregister_class(DuetSettings)
    bpy.utils.unregister_class(DuetJoint)
    bpy.utils.unregister_class(DuetLabel)
