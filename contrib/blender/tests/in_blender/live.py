"""The add-on plays live, on a clock that the test turns; run by Blender itself.

    blender --background --factory-startup --python live.py -- ADD_ON_FOLDER LEADER.glb SERVERS PID DUET OUT

SERVERS: addresses of two servers, separated by a comma. PID: of the first one, which is killed in the
middle, when the test has started the second one: it does so when there is a file OUT/wanted, and then
writes OUT/started. Writes what happens as JSON into the folder OUT.
"""

import json
import os
import pathlib
import signal
import sys
import time

import bpy

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import scenes  # noqa: E402

addon_folder, leader_file, servers, pid, duet, out = sys.argv[sys.argv.index("--") + 1:]
OUT = pathlib.Path(out)
METRE = scenes.UNITS_PER_METRE
RATE, FIRST, LAST = 24, 11, 80
KILLED_AFTER, LABELS_AFTER = 30, 40  # frames
LIMBS = [(f"{side}_{joint}", f"{side}_{after}") for side in ("left", "right")
         for joint, after in (("shoulder", "elbow"), ("elbow", "hand"), ("hip", "knee"), ("knee", "foot"))]
state = {"sent": []}

scene, leader = scenes.open_leader(leader_file, addon_folder, (FIRST, LAST), FIRST)
import duet_blender  # noqa: E402
import duet_blender.live as live  # noqa: E402
import duet_blender.panel  # noqa: E402
import duet_blender.partner  # noqa: E402
import duet_blender.stream  # noqa: E402

duet_blender.register()
settings = scene.duet
settings.server, settings.program, settings.leader = f"ipv4:{servers}", duet, leader
assert bpy.ops.duet.ask_for_classes() == {"FINISHED"}


class Clock:
    now = 1000.0

    def __call__(self):
        return self.now


def remembering(send):
    def send_and_remember(self, line):
        state["sent"].append(line)
        send(self, line)
    return send_and_remember


duet_blender.stream.Stream.send = remembering(duet_blender.stream.Stream.send)
clock = Clock()


def start():
    """Starts a session on the test's clock."""
    before = len(state["sent"])
    session = live.start(scene, clock)
    del state["sent"][:before]
    return session


def attempt(action, error=RuntimeError):
    try:
        action()
    except error as failed:
        return str(failed)
    return ""


def tick_until(happened):
    """Ticks while the clock stands still. The limit only ends a test that hangs: on a machine with
    other work, a program that finds no server was seen to need more than a minute."""
    end = time.monotonic() + 200
    live.tick()
    while not happened():
        assert time.monotonic() < end, settings.state
        time.sleep(0.001)
        live.tick()


def play(session, frames):
    """Frames of the scene, each of which is answered before the next one."""
    for frame in frames:
        scene.frame_set(frame)
        tick_until(lambda: session.frames_answered == session.frames_sent > 0)
        tick_until(lambda: session.shows)
        bpy.context.view_layer.update()
        yield frame
        clock.now += 1 / RATE


def follower():
    return duet_blender.partner.last(scene)


def place(armature, bone):
    return [value / METRE for value in armature.matrix_world @ armature.pose.bones[bone].head]


def distance(a, b):
    return sum((x - y) ** 2 for x, y in zip(a, b)) ** 0.5


def end(session):
    live.stop()
    tick_until(lambda: not live.is_playing())
    bpy.context.view_layer.update()


# ---- What cannot begin.
state["no_label"] = attempt(bpy.ops.duet.play_live)
settings.labels["hug"].weight = 1
settings.program = "no-such-program"
state["no_program"] = attempt(bpy.ops.duet.play_live)
settings.program = duet
settings.server = "localhost:1"
start()
state["no_server"] = attempt(lambda: tick_until(lambda: False), duet_blender.program.DuetError)
state["after_failure"] = live.is_playing()
settings.server = f"ipv4:{servers}"

# ---- A session during which the first server dies.
session = start()
state["panel"] = scenes.drawn(duet_blender.panel.VIEW3D_PT_duet_live)
state["second"] = attempt(start, duet_blender.program.DuetError)
state["react"] = attempt(bpy.ops.duet.react)
heads, tails = [], []
for frame in play(session, range(FIRST, LAST + 1)):
    joints = session.joints
    answer = session.answers[-1]
    for index, joint in enumerate(joints):
        x, y, z = answer[3 * index:3 * index + 3]
        heads.append(distance(place(follower(), joint), (x, -z, y)))
    for bone, joint in LIMBS:
        tail = follower().matrix_world @ follower().pose.bones[bone].tail
        tails.append(distance([value / METRE for value in tail], place(follower(), joint)))
    if frame == FIRST + KILLED_AFTER:
        (OUT / "wanted").touch()
        tick_until((OUT / "started").exists)
        os.kill(int(pid), signal.SIGKILL)
    if frame == FIRST + LABELS_AFTER:
        settings.labels["hug"].weight, settings.labels["push"].weight = 0, 1
state["heads"], state["tails"] = max(heads), max(tails)
state["shown"] = len(heads) // len(session.joints)
state["playing"] = settings.state
end(session)
state["ended"] = settings.state
state["lines"] = list(state["sent"])
state["answers"] = [list(frame) for frame in session.answers]
state["joints"] = session.joints
state["frames"] = [session.frames_sent, session.frames_answered]
action = follower().animation_data.action
keys = [key.co.x for curve in action.fcurves for key in curve.keyframe_points]
state["keys"] = [min(keys), max(keys)]
scene.frame_set(LAST - 5)
kept = session.answers[LAST - 5 - FIRST]
hand = session.joints.index("left_hand")
x, y, z = kept[3 * hand:3 * hand + 3]
state["kept"] = distance(place(follower(), "left_hand"), (x, -z, y))
state["frame_now"] = scene.frame_current

# ---- Blender is busy for a moment, then for long.
session = start()
for _ in play(session, range(FIRST, FIRST + 3)):
    pass
state["gaps"] = []
for gap in (5 / RATE, 30):  # in addition to the frame that is due
    before = session.frames_sent
    clock.now += gap
    scene.frame_set(scene.frame_current + 6)
    tick_until(lambda: session.frames_answered == session.frames_sent > before)
    state["gaps"].append(session.frames_sent - before)
positions = [line["positions"] for line in state["sent"] if "positions" in line]
state["steps"] = [max(distance(a, b) for a, b in zip(*pair)) for pair in zip(positions, positions[1:])]

# ---- What ends a session.
state["twice"] = [live.stop(), live.stop()]
tick_until(lambda: not live.is_playing())
session = start()
for _ in play(session, range(FIRST, FIRST + 3)):
    pass
bpy.data.objects.remove(follower())
clock.now += 1 / RATE
state["removed"] = attempt(lambda: tick_until(lambda: False), duet_blender.program.DuetError)
session = start()
bpy.ops.wm.read_factory_settings(use_empty=True)
state["after_load"] = [live.is_playing(), session._stream._process.poll() is not None]

(OUT / "state.json").write_text(json.dumps(state), encoding="utf-8")
duet_blender.unregister()
