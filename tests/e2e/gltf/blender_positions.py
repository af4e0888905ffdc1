"""Where Blender has the joints of a .glb, as JSON in a file; run by Blender itself.

    blender --background --factory-startup --python blender_positions.py -- FILE FRAMES RATE OUT

{armature: {joint: [[x, y, z], ... frames]}} in glTF's axes: Blender's z is up.
"""

import json
import sys

import bpy
import numpy

# Debian 12's Blender asks its numpy for a name that it no longer has.
if not hasattr(numpy, "bool"):
    numpy.bool = bool

source, frames, rate, out = sys.argv[sys.argv.index("--") + 1:]
bpy.ops.wm.read_factory_settings(use_empty=True)
# The importer places keys by the scene's rate.
scene = bpy.context.scene
scene.render.fps = round(float(rate))
scene.render.fps_base = round(float(rate)) / float(rate)
bpy.ops.import_scene.gltf(filepath=source)
armatures = [thing for thing in scene.objects if thing.type == "ARMATURE"]
positions = {armature.name: {bone.name: [] for bone in armature.pose.bones}
             for armature in armatures}
for frame in range(int(frames)):
    scene.frame_set(frame)
    for armature in armatures:
        for bone in armature.pose.bones:
            x, y, z = armature.matrix_world @ bone.head
            positions[armature.name][bone.name].append([x, z, -y])
with open(out, "w", encoding="utf-8") as file:
    json.dump(positions, file)
