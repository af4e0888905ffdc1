"""Draws contrib/blender/panel.png: the Blender add-on's panel, and an armature that follows an answer.

    xvfb-run -s "-screen 0 1280x800x24" blender --factory-startup --enable-event-simulate \
        --window-geometry 0 0 1280 800 --python contrib/blender/draw_panel.py -- SERVER PROGRAMS OUT.png

SERVER is a duet-server's address and PROGRAMS the folder of duet. The file in the repository is cropped to the 3D
view and has 128 colours.
"""

import pathlib
import subprocess
import sys
import tempfile

import bpy
import numpy
from mathutils import Euler, Vector

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
sys.path[:0] = [str(HERE), str(HERE / "tests" / "in_blender")]
import duet_blender  # noqa: E402
import duet_blender.partner  # noqa: E402
import scenes  # noqa: E402

if "bool" not in numpy.__dict__:  # Debian 12's importer, see duet_blender.partner
    numpy.bool = bool

server, programs, out = sys.argv[sys.argv.index("--") + 1:]
DUET = pathlib.Path(programs) / "duet"
FRAME = 50  # of the hug
TAB = 157   # pixels from the top of the sidebar to the add-on's tab


def react():
    """The sample hug, eight answers, a pinned hand, and a character that follows."""
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "hug.glb"
        subprocess.run([DUET, "convert", ROOT / "samples" / "hug.bvh", "--out", file, "--quiet"], check=True)
        bpy.ops.import_scene.gltf(filepath=str(file))
    scene = bpy.context.scene
    scene.render.fps, scene.frame_start, scene.frame_end = 30, 1, 90
    leader = next(thing for thing in scene.objects if thing.type == "ARMATURE")
    leader.name = "Leader"
    duet_blender.register()
    settings = scene.duet
    settings.server, settings.program, settings.leader = server, str(DUET), leader
    bpy.ops.duet.ask_for_classes()
    settings.labels["hug"].weight = 1
    bpy.ops.duet.show_eight()
    scene.frame_set(FRAME)
    scenes.UNITS_PER_METRE = 1
    settings.target = scenes.add_character(scene, "Character", 1, "mixamorig:")
    bpy.ops.duet.follow()
    bpy.ops.duet.add_pin(joint="right_hand")
    for thing in scene.objects:
        thing.select_set(False)
    settings.target.show_in_front = True
    for thing in (leader, duet_blender.partner.last(scene)):  # their meshes stay visible
        thing.hide_set(True)


def view():
    """The 3D view and its area."""
    window = bpy.context.window_manager.windows[0]
    area = next(area for area in window.screen.areas if area.type == "VIEW_3D")
    return window, area


def look():
    _, area = view()
    space = area.spaces[0]
    space.show_region_ui, space.show_region_toolbar = True, False
    space.overlay.show_relationship_lines = False
    heads = [thing.matrix_world @ bone.head for thing in bpy.context.scene.objects
             if thing.type == "ARMATURE" for bone in thing.pose.bones]
    space.region_3d.view_location = sum(heads, Vector()) / len(heads) + Vector((0, 0, 0.05))
    space.region_3d.view_distance = 3.1
    space.region_3d.view_rotation = Euler((1.3, 0, 0.5)).to_quaternion()


def open_tab():
    """Clicks the add-on's tab, the last one of the sidebar."""
    window, area = view()
    region = next(region for region in area.regions if region.type == "UI")
    x, y = region.x + region.width - 14, region.y + region.height - TAB
    window.event_simulate(type="MOUSEMOVE", value="NOTHING", x=x, y=y)
    for value in ("PRESS", "RELEASE"):
        window.event_simulate(type="LEFTMOUSE", value=value, x=x, y=y)


def leave():
    """Takes the pointer away from the tab."""
    window, area = view()
    window.event_simulate(type="MOUSEMOVE", value="NOTHING", x=area.x + 60, y=area.y + 60)


def shoot():
    window, _ = view()
    with bpy.context.temp_override(window=window):
        bpy.ops.screen.screenshot(filepath=out)
    bpy.ops.wm.quit_blender()


def step(actions=iter((look, open_tab, leave, shoot))):
    """One action after the other: Blender draws between them."""
    next(actions)()
    return 2.0


bpy.context.preferences.view.show_splash = False
for thing in list(bpy.context.scene.objects):
    bpy.data.objects.remove(thing)
react()
bpy.app.timers.register(step, first_interval=2)
