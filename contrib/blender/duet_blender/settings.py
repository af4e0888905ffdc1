"""The settings in the panel: a property group of every scene."""

import bpy

from . import answers, pins

# The classes of the embedded default model, used until the user asks the server.
CLASSES = ("kick", "push", "shake_hands", "hug", "exchange_object", "punch")
# The joints of the embedded default model, in the order of the panel.
JOINTS = ("head", "neck", "torso", "left_shoulder", "left_elbow", "left_hand", "right_shoulder",
          "right_elbow", "right_hand", "left_hip", "left_knee", "left_foot", "right_hip", "right_knee",
          "right_foot")


class DuetLabel(bpy.types.PropertyGroup):
    """One interaction class; `name` is the class."""

    weight: bpy.props.FloatProperty(
        name="Weight",
        description="1 requests this class, 0 is neutral, -1 avoids it. Can be animated",
        default=0, min=-2, max=2, soft_min=-1, soft_max=1, options={"ANIMATABLE"})


class DuetJoint(bpy.types.PropertyGroup):
    """The joint `name` of the model, and the bones whose head it is."""

    bone: bpy.props.StringProperty(
        name="Bone",
        description="The leader's bone whose head is this joint. Empty: recognised by the bones' names")
    rig_bone: bpy.props.StringProperty(
        name="Bone of your armature",
        description="Your armature's bone whose head is this joint. Empty: recognised by the bones' names")


class DuetModel(bpy.types.PropertyGroup):
    """A model of the server; `name` is NAME@VERSION."""

    classes: bpy.props.StringProperty()  # separated by commas
    joints: bpy.props.StringProperty()
    is_default: bpy.props.BoolProperty()


def _show_model(settings, _context):
    model = settings.models.get(settings.model) or next(
        (model for model in settings.models if model.is_default), None)
    if model:
        set_classes(settings, model.classes.split(","))
        set_joints(settings, model.joints.split(","))


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
        description="An empty at the partner's start. Without one, the model chooses")
    target: bpy.props.PointerProperty(
        name="Armature", type=bpy.types.Object, poll=_is_armature,
        description="The armature whose copy the partner is")
    labels: bpy.props.CollectionProperty(type=DuetLabel)
    pins: bpy.props.CollectionProperty(type=pins.DuetPin)
    answers: bpy.props.CollectionProperty(type=answers.DuetAnswer)
    chosen: bpy.props.IntProperty(options={"SKIP_SAVE"})
    models: bpy.props.CollectionProperty(type=DuetModel)
    model: bpy.props.StringProperty(name="Model", update=_show_model,
                                    description="Empty: the server's default")
    joints: bpy.props.CollectionProperty(type=DuetJoint)
    unit: bpy.props.EnumProperty(
        name="Unit", description="The length of one unit of the leader's armature",
        items=(("SCENE", "Scene", "The unit of the scene"), ("METRES", "Metres", ""),
               ("CENTIMETRES", "Centimetres", ""), ("MILLIMETRES", "Millimetres", ""),
               ("INCHES", "Inches", "")))
    body: bpy.props.EnumProperty(
        name="Body", description="The partner's body",
        items=(("MANNEQUIN", "Mannequin", "Duet's mannequin"),
               ("LEADER", "Leader's rig", "A copy of the leader's armature and meshes"),
               ("OWN", "Your armature", "A copy of another armature of the scene and its meshes")))
    own_seed: bpy.props.BoolProperty(
        name="Seed", description="Request the answer of this seed. Otherwise the server chooses one by the leader's "
                                 "motion, and the field shows it")
    seed: bpy.props.IntProperty(name="Seed", min=0, description="Selects an answer of a model that samples")
    variety: bpy.props.FloatProperty(name="Variety", min=0, max=2, default=1,
                                     description="0: the typical answer; 1: as varied as people")
    candidates: bpy.props.IntProperty(
        name="Best of", min=1, max=16, default=1,
        description="Number of samples that the model draws for each window; the answer is the "
                    "best of them. More take longer")
    server: bpy.props.StringProperty(name="Server", default="localhost:50051")
    program: bpy.props.StringProperty(name="Program", default="duet", subtype="FILE_PATH",
                                      description="Path of the program `duet`")
    state: bpy.props.StringProperty(name="State", options={"SKIP_SAVE"})


def set_classes(settings, classes):
    """Sets the sliders to these classes. Weights of classes in both stay."""
    _set_names(settings.labels, classes, ("weight",))


def set_joints(settings, joints):
    """Sets the joints that bones can be chosen for. Choices of joints in both stay."""
    _set_names(settings.joints, joints, ("bone", "rig_bone"))


def _set_names(collection, names, fields):
    """Makes a collection of these names. Fields of names that it had keep their values."""
    if collection.keys() == list(names):
        return
    known = {one.name: {field: getattr(one, field) for field in fields} for one in collection}
    collection.clear()
    for name in names:
        one = collection.add()
        one.name = name
        for field, value in known.get(name, {}).items():
            setattr(one, field, value)


def set_models(settings, models):
    """Sets the models of `duet models --json`, and shows the chosen one's classes and joints."""
    settings.models.clear()
    for model in models:
        one = settings.models.add()
        one.name = f"{model['name']}@{model['version']}"
        one.classes = ",".join(model["interaction_classes"])
        one.joints = ",".join(model["joint_names"])
        one.is_default = model["is_default"]
    if settings.model not in settings.models:
        settings.model = ""
    _show_model(settings, None)


def fill(scene):
    """Adds the sliders and joints to a scene that has none."""
    if not scene.duet.labels:
        set_classes(scene.duet, CLASSES)
    if not scene.duet.joints:
        set_joints(scene.duet, JOINTS)


@bpy.app.handlers.persistent
def _fill_all(*_):
    for scene in bpy.data.scenes:
        fill(scene)


_register_classes, _unregister_classes = bpy.utils.register_classes_factory(
    (DuetLabel, DuetJoint, DuetModel, DuetSettings))


def register():
    _register_classes()
    bpy.types.Scene.duet = bpy.props.PointerProperty(type=DuetSettings)
    bpy.app.handlers.load_post.append(_fill_all)
    if hasattr(bpy.data, "scenes"):
        _fill_all()
    else:  # scenes cannot be accessed while Blender enables an add-on
        bpy.app.timers.register(_fill_all, first_interval=0)


def unregister():
    bpy.app.handlers.load_post.remove(_fill_all)
    del bpy.types.Scene.duet
    _unregister_classes()
