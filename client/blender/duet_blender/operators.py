"""The operators behind the panel's buttons. They work in small steps on a timer, so that Blender
stays responsive; without a window (blender --background) the steps run one after another."""

import os
import tempfile
import time

import bpy

from . import leader, partner, program, settings

STEP_SECONDS = 0.02  # maximum work per tick
TICK_SECONDS = 0.05


class _Working(bpy.types.Operator):
    """Base of operators that implement the generator work(context); each yield returns control to
    Blender."""

    bl_options = {"REGISTER"}
    _timer = None
    _steps = None

    def invoke(self, context, _event):
        if bpy.app.background:
            return self.execute(context)
        self._steps = self.work(context)
        self._timer = context.window_manager.event_timer_add(TICK_SECONDS, window=context.window)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def execute(self, context):
        try:
            for _ in self.work(context):
                time.sleep(0)
        except program.DuetError as error:
            return self._fail(context, error)
        return {"FINISHED"}

    def modal(self, context, event):
        if event.type == "ESC":
            self._steps.close()
            self._end(context, "Stopped")
            return {"CANCELLED"}
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        until = time.monotonic() + STEP_SECONDS
        try:
            while time.monotonic() < until:
                next(self._steps)
        except StopIteration:
            self._end(context, context.scene.duet.state)
            return {"FINISHED"}
        except program.DuetError as error:
            self._end(context, "")
            return self._fail(context, error)
        self._redraw(context)
        return {"PASS_THROUGH"}

    def _end(self, context, state):
        context.window_manager.event_timer_remove(self._timer)
        context.scene.duet.state = state
        self._redraw(context)

    def _fail(self, context, error):
        context.scene.duet.state = ""
        self.report({"ERROR"}, str(error))
        return {"CANCELLED"}

    @staticmethod
    def _redraw(context):
        for area in context.screen.areas if context.screen else ():
            area.tag_redraw()


class DUET_OT_ask_for_classes(_Working):
    """Shows a slider for each class of the server's model"""

    bl_idname = "duet.ask_for_classes"
    bl_label = "Ask the server for classes"

    def work(self, context):
        duet = context.scene.duet
        duet.state = "Asking the server"
        settings.set_classes(duet, (yield from program.classes(duet)))
        duet.state = ""


class DUET_OT_react(_Working):
    """Synthesises a partner who reacts to the leader and replaces the last partner. Esc cancels"""

    bl_idname = "duet.react"
    bl_label = "React"

    @classmethod
    def poll(cls, context):
        return context.scene.duet.leader is not None and context.mode == "OBJECT"

    def work(self, context):
        scene, duet = context.scene, context.scene.duet
        program.find(duet.program)
        with tempfile.TemporaryDirectory() as folder:
            duet.state = "Reading the leader"
            recording = leader.Recording(scene, duet.leader)
            yield from recording.take()
            motion = os.path.join(folder, "leader.bvh")
            recording.write(motion)
            duet.state = "Waiting for the server"
            follower = yield from self._ask(context, recording, motion, folder)
            partner.remove_last(scene)
            partner.add(scene, follower,
                        scene.unit_settings.scale_length / leader.metres_per_unit(scene))
        duet.state = f"{partner.NAME}: seed {duet.seed}"
        if not bpy.app.background:
            bpy.ops.ed.undo_push(message="React")

    def _ask(self, context, recording, motion, folder):
        """A generator that requests the follower and returns its file."""
        scene, duet = context.scene, context.scene.duet
        ask = ["synthesize", "--server", duet.server, "--leader", motion, *recording.reading_flags(),
               *recording.label_flags(), *recording.place_flags(), "--seed", duet.seed,
               "--variety", f"{duet.variety:.4g}", "--candidates", str(duet.candidates), "--quiet"]
        if duet.body == "LEADER":
            rig, pair = os.path.join(folder, "rig.glb"), os.path.join(folder, "pair.glb")
            partner.export_rig(scene, duet.leader, rig)
            yield from program.run(duet, *ask, "--out", pair, "--follower-rig", rig,
                                   *leader.joint_flags(duet, "--follower-rig-joint-map"))
            return os.path.join(folder, "pair.follower.glb")
        pair, follower = os.path.join(folder, "pair.json"), os.path.join(folder, "follower.glb")
        yield from program.run(duet, *ask, "--out", pair)
        yield from program.run(duet, "convert", pair, "--side", "right", "--out", follower, "--quiet")
        return follower


class DUET_OT_keep(bpy.types.Operator):
    """Keeps the last partner as a take, so that the next React adds another one"""

    bl_idname = "duet.keep"
    bl_label = "Keep as take"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        return partner.last(context.scene) is not None

    def execute(self, context):
        duet = context.scene.duet
        duet.state = partner.keep(context.scene, f"seed {duet.seed}")
        return {"FINISHED"}


_CLASSES = (DUET_OT_ask_for_classes, DUET_OT_react, DUET_OT_keep)


def register():
    for operator in _CLASSES:
        bpy.utils.register_class(operator)


def unregister():
    for operator in reversed(_CLASSES):
        bpy.utils.unregister_class(operator)
