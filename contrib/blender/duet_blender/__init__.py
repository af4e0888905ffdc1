"""The Blender add-on: synthesises a partner for an animated armature."""

bl_info = {
    "name": "Duet",
    "author": "Duet",
    "version": (1, 0, 0),
    "blender": (3, 4, 0),
    "location": "3D View > Sidebar > Duet",
    "description": "Synthesises a partner who reacts to an animated armature",
    "category": "Animation",
}

from . import answers, operators, panel, pins, settings  # noqa: E402  (Blender wants bl_info first)

_MODULES = (pins, answers, settings, operators, panel)


def register():
    for module in _MODULES:
        module.register()


def unregister():
    for module in reversed(_MODULES):
        module.unregister()
