#!/usr/bin/env python3
"""Converts FBX to glTF and back with Blender (3.4 or later): duet_fbx.py IN.fbx OUT.glb, duet_fbx.py IN.glb OUT.fbx

Every take becomes an animation of the glTF at the file's rate. Of a glTF, the FBX has the one that Blender shows.
"""

import os
import pathlib
import shutil
import sys

try:
    import bpy
except ImportError:
    bpy = None  # outside of Blender, which runs this file again
else:
    import numpy

USAGE = "usage: duet_fbx.py IN.fbx OUT.glb, or duet_fbx.py IN.glb OUT.fbx"
RATE_HZ = 30  # of keys in a FBX; a glTF has times instead of a rate


def show_all_takes():
    """Makes the exporter write each take: it leaves out actions that no track plays. People whose takes have the
    same name move together, as in the FBX."""
    for rig in bpy.data.objects:
        if rig.animation_data is None:
            continue
        rig.animation_data.action = None
        for action in bpy.data.actions:
            owner, _, take = action.name.partition("|")
            if owner == rig.name:
                track = rig.animation_data.nla_tracks.new()
                track.name = take
                track.strips.new(take, int(action.frame_range[0]), action)


def to_gltf(source, out):
    bpy.ops.import_scene.fbx(filepath=source)
    show_all_takes()
    bpy.ops.export_scene.gltf(filepath=out, export_format="GLB", export_frame_range=False, export_def_bones=False)


def to_fbx(source, out):
    bpy.context.scene.render.fps = RATE_HZ
    bpy.ops.import_scene.gltf(filepath=source)
    # A simplified take would move joints by up to 2 mm.
    bpy.ops.export_scene.fbx(filepath=out, add_leaf_bones=False, bake_anim=True, bake_anim_simplify_factor=0)


def run_in_blender(arguments):
    """Goes on with this file in Blender; does not return."""
    blender = shutil.which("blender")
    if blender is None:
        sys.exit("duet_fbx: expected the program blender, which is not installed; install Debian's package blender")
    # Blender takes its modules, numpy among them, from where the first python3 of PATH is: a pyenv's has none.
    os.environ["PATH"] = os.pathsep.join([os.path.dirname(blender), os.environ["PATH"]])
    os.execv(blender, [blender, "--background", "--factory-startup", "--python-exit-code", "1", "--python", __file__,
                       "--", *arguments])


def main(arguments):
    kinds = [pathlib.Path(name).suffix.lower() for name in arguments]
    if kinds not in ([".fbx", ".glb"], [".glb", ".fbx"]):
        sys.exit(USAGE)
    if bpy is None:
        run_in_blender(arguments)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    if "bool" not in numpy.__dict__:  # Debian 12's glTF add-on uses it, and its numpy no longer has it
        numpy.bool = bool
    (to_gltf if kinds[0] == ".fbx" else to_fbx)(*arguments)


if __name__ == "__main__":
    main(sys.argv[sys.argv.index("--") + 1:] if bpy else sys.argv[1:])
