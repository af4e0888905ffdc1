"""Exports the sample kick as FBX in every combination of rig, rate, unit and up axis.

    blender --background --factory-startup --python fbx_matrix.py -- MAKE_FILES.py OUT

OUT/cases.json lists the files and the names of their joints.
"""

import importlib.util
import itertools
import json
import pathlib
import sys

MAKE_FILES, OUT = map(pathlib.Path, sys.argv[sys.argv.index("--") + 1:])
spec = importlib.util.spec_from_file_location("make_files", MAKE_FILES)
make_files = importlib.util.module_from_spec(spec)
spec.loader.exec_module(make_files)

FRAMES = 4


def sided(left, right, **words):
    """Names of both sides' joints: the word for a joint and the ending of its side."""
    return {f"{side}_{joint}": word + ending
            for side, ending in (("left", left), ("right", right)) for joint, word in words.items()}


RIGS = {
    "duet": {},
    "mixamo": {joint: name for joint, name in make_files.MIXAMO.items() if joint != "head_end"},
    "unreal": {"torso": "spine_02", "neck": "neck_01", "head": "head",
               **sided("_l", "_r", shoulder="upperarm", elbow="lowerarm", hand="hand", hip="thigh",
                       knee="calf", foot="foot")},
    "rigify": {"torso": "spine.002", "neck": "neck", "head": "head",
               **sided(".L", ".R", shoulder="upper_arm", elbow="forearm", hand="hand", hip="thigh",
                       knee="shin", foot="foot")},
}
UNITS = {"metres": 1, "centimetres": 100, "inches": 1 / 0.0254}  # of the scene, in a metre
AXES = {"y_up": {}, "z_up": {"axis_forward": "Y", "axis_up": "Z"}}
# How Blender spreads the unit over the file's statement and the root's scale; each in turn.
SCALES = itertools.cycle(("FBX_SCALE_NONE", "FBX_SCALE_UNITS", "FBX_SCALE_CUSTOM", "FBX_SCALE_ALL"))

cases = []
for (rig, names), rate, (unit, per_metre), (axis, options) in itertools.product(
        RIGS.items(), (24, 30, 60), UNITS.items(), AXES.items()):
    make_files.clear(rate, per_metre)
    make_files.CENTIMETRE = 0.01 * per_metre  # its armatures are in the scene's unit
    make_files.person("kick", names, frames=FRAMES)
    scale, name = next(SCALES), f"{rig}_{rate}_{unit}_{axis}"
    make_files.export(OUT, name, apply_scale_options=scale, **options)
    cases.append({"file": f"{name}.fbx", "rig": rig, "rate": rate, "scale": scale})
(OUT / "cases.json").write_text(json.dumps(
    {"first": make_files.FIRST, "frames": FRAMES, "cases": cases, "names": RIGS}), encoding="utf-8")
