"""The operators behind the panel's buttons. They work in small steps on a timer, so that Blender
stays responsive; without a window (blender --background) the steps run one after another."""

import time

import bpy

from . import answers, partner, program, settings

STEP_SECONDS = 0.02  # maximum work per tick
TICK_SECONDS = 0.05


def _can_replace(context):
    """Whether the partner may be replaced."""
    return context.mode == "OBJECT"


def _push_undo(message):
    if not bpy.app.background:
        bpy.ops.ed.undo_push(message=message)


def _fail(operator, context, error):
    context.scene.duet.state = ""
    operator.report({"ERROR"}, str(error))
    return {"CANCELLED"}


def _redraw(context):
    for area in context.screen.areas if context.screen else ():
        area.tag_redraw()


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
            return _fail(self, context, error)
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
            return _fail(self, context, error)
        _redraw(context)
        return {"PASS_THROUGH"}

    def _end(self, context, state):
        context.window_manager.event_timer_remove(self._timer)
        context.scene.duet.state = state
        _redraw(context)


class DUET_OT_ask_for_classes(_Working):
    """Reads the server's models, and shows a slider for each class of the chosen one"""

    bl_idname = "duet.ask_for_classes"
    bl_label = "Ask the server for classes"

    def work(self, context):
        duet = context.scene.duet
        duet.state = "Asking the server"
        settings.set_models(duet, (yield from program.models(duet)))
        duet.state = ""


class _Asking(_Working):
    """Base of the operators that request answers and show the best one."""

    count = 1

    @classmethod
    def poll(cls, context):
        return context.scene.duet.leader is not None and _can_replace(context)

    def work(self, context):
        yield from answers.request(context.scene, self.count)
        yield from answers.show(context.scene, 0)
        _push_undo(self.bl_label)


class DUET_OT_react(_Asking):
    """Synthesises a partner who reacts to the leader and replaces the last partner. Esc cancels"""

    bl_idname = "duet.react"
    bl_label = "React"


class DUET_OT_show_eight(_Asking):
    """Synthesises eight answers with consecutive seeds, and shows the best one. Esc cancels"""

    bl_idname = "duet.show_eight"
    bl_label = "Show eight"
    count = answers.GALLERY_SIZE


class DUET_OT_choose(_Working):
    """Shows this answer in place of the last partner, and keeps its seed for the next React"""

    bl_idname = "duet.choose"
    bl_label = "Choose answer"

    index: bpy.props.IntProperty()

    @classmethod
    def poll(cls, context):
        return _can_replace(context)

    def work(self, context):
        yield from answers.show(context.scene, self.index)
        context.scene.duet.own_seed = True  # show() has shown the seed in the field
        _push_undo(self.bl_label)


class DUET_OT_key_labels(bpy.types.Operator):
    """Sets a key frame for the weight of every class in the current frame"""

    bl_idname = "duet.key_labels"
    bl_label = "Key all here"
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context):
        for label in context.scene.duet.labels:
            label.keyframe_insert("weight", frame=context.scene.frame_current)
        return {"FINISHED"}


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
        seed = duet.answers[duet.chosen].seed if duet.answers else duet.seed
        duet.state = partner.keep(context.scene, f"seed {seed}")
        return {"FINISHED"}


_CLASSES = (DUET_OT_ask_for_classes, DUET_OT_react, DUET_OT_show_eight, DUET_OT_choose,
            DUET_OT_key_labels, DUET_OT_keep)

register, unregister = bpy.utils.register_classes_factory(_CLASSES)
