"""Plays live: sends the leader's armature as it is now, and moves the partner as the answers come."""

import array
import collections
import json
import os
import statistics
import tempfile
import time

import bpy
from mathutils import Vector

from . import answers, leader, partner, program
from .program import DuetError
from .puppet import Puppet
from .stream import Stream

EASE_SECONDS = 0.2    # of a change of the sliders
KEPT_SECONDS = 300    # of the partner's motion, for its action
_LATENCY_SECONDS = 5  # of the latencies in the panel
# If Blender is busy for longer, the session stands still meanwhile.
_LONGEST_GAP_SECONDS = 0.5
_STOP_SECONDS = 2     # for the frames that are due at the end
_STEP_SECONDS = 0.02  # of each tick while the partner's motion is kept

_session = None


class Latency:
    """Times from leader frames, as they are sent, to the answers that wait for them."""

    def __init__(self, rate, delay):
        self._delay = delay
        self._sent = collections.deque()  # times of frames without an answer
        self._first = 0                   # the index of the first of them
        self._answered, self._shown = (collections.deque(maxlen=round(_LATENCY_SECONDS * rate))
                                       for _ in range(2))

    def send(self, now):
        self._sent.append(now)

    def _forget(self, frame):
        last = self._first + len(self._sent) - 1
        while self._first < min(frame + self._delay, last):
            self._sent.popleft()
            self._first += 1

    def answer(self, frame, arrived):
        self._forget(frame)
        self._answered.append(arrived - self._sent[0])

    def show(self, now):
        """The last answer is shown."""
        self._shown.append(now - self._sent[0])

    def describe(self):
        if not self._shown:
            return "waiting for the first answer"
        answered, shown = (1000 * statistics.median(times) for times in (self._answered, self._shown))
        return f"answers after {answered:.0f} ms, shown after {shown:.0f} ms"


class Session:
    """A live session of a scene. tick() does everything and never waits."""

    def __init__(self, scene, clock):
        duet = scene.duet
        path = program.find(duet.program)
        self._scene, self._clock = scene, clock
        self._leader = duet.leader.name
        self._recording = leader.Recording(scene, duet.leader, with_pins=False)
        self._recording.take_frame()
        flags = [*leader.joint_flags(duet, "--joint-map"), *self._recording.label_flags(),
                 *self._recording.place_flags()]
        self.rate = leader.frame_rate(scene)
        self.frames_sent = self.frames_answered = 0
        self._latency = Latency(self.rate, duet.delay)
        self._weights = self._recording.weights[0]
        self._places = None  # the leader's, in the last frame that was sent
        self._kept = collections.deque(maxlen=round(KEPT_SECONDS * self.rate))
        self._first_frame = scene.frame_current
        self._puppet = None
        self._begin, self._stop_by, self._error = clock(), None, ""
        self._stream = Stream(path, [
            "--server", duet.server, *(["--model", duet.model] if duet.model else []),
            *(["--seed", duet.seed] if duet.own_seed else []), "--variety", f"{duet.variety:.4g}", "--candidates", duet.candidates,
            "--delay", duet.delay, *flags], clock)
        self._stream.send({"joints": [name for name, _, _, _ in self._recording.joints],
                           "rate": self.rate})
        self._work = self._phases()
        self._keeps = self.is_over = False

    @property
    def joints(self):
        """The names of the partner's joints, after the first answer."""
        return self._stream.joints

    @property
    def answers(self):
        """The partner's last frames: flat arrays of positions in metres, y up."""
        return self._kept

    @property
    def shows(self):
        """Whether the partner is in the scene, and moves."""
        return self._puppet is not None

    def tick(self):
        """Sends the leader if a frame is due, and shows the newest answer."""
        if self._stop_by is None:
            self._send()
            if self._stream.has_ended():
                self._fail(self._stream.error() or "The session has ended.")
        elif self._clock() > self._stop_by:
            self._stream.kill()
        self._show()
        try:
            next(self._work)
            until = time.monotonic() + _STEP_SECONDS
            while self._keeps and time.monotonic() < until:
                next(self._work)
        except StopIteration:
            self.is_over = True
        self._scene.duet.state = self._describe()

    def stop(self):
        """Ends the leader's motion. The session is over some ticks later, and at once if it is
        stopped twice."""
        if self._stop_by is not None:
            self._stream.kill()
            return
        self._stream.finish()
        self._stop_by = self._clock() + _STOP_SECONDS

    def kill(self):
        """Ends the session without touching the scene."""
        self._work.close()
        self._stream.kill()

    def _fail(self, message):
        self._error = message
        self._stop_by = self._clock()
        if not self.frames_answered:
            raise DuetError(message)

    def _describe(self):
        if self._error:
            return self._error
        if self.is_over:
            return f"{partner.NAME}: {self.frames_answered} frames played live"
        if self._stop_by is not None:
            return "Leave pose mode" if bpy.context.mode != "OBJECT" else "Keeping the motion"
        latency = "looking for a server" if self._stream.interrupted else self._latency.describe()
        parts = [f"Live, {self.frames_sent / self.rate:.0f} s: {latency}"]
        if self._stream.resumed:
            parts.append("resumed " + ("once" if self._stream.resumed == 1 else
                                       f"{self._stream.resumed} times"))
        return ", ".join(parts)

    # The leader.

    def _send(self):
        now = self._clock()
        due = int((now - self._begin) * self.rate + 1e-6) + 1 - self.frames_sent
        if due > max(1, _LONGEST_GAP_SECONDS * self.rate):
            self._begin += (due - 1) / self.rate
            due = 1
        if due < 1:
            return
        self._send_labels()
        places = self._places_now()
        before = self._places or places
        for frame in range(1, due + 1):
            self._stream.send({"positions": [
                [round(a + (b - a) * frame / due, 5) for a, b in zip(*pair)]
                for pair in zip(before, places)]})
            self._latency.send(now)
        self._places = places
        self.frames_sent += due

    def _places_now(self):
        armature = bpy.data.objects.get(self._leader)
        if armature is None:
            raise DuetError(f"{self._leader}: expected an armature, got none any more")
        self._recording.armature = armature
        try:
            return self._recording.places()
        except KeyError as bone:
            raise DuetError(f"{self._leader}: expected the bone {bone}, got none any more") from bone

    def _send_labels(self):
        weights = [label.weight for label in self._scene.duet.labels]
        if weights != self._weights:
            self._weights = weights
            names = [label.name for label in self._scene.duet.labels]
            self._stream.send({"labels": dict(zip(names, weights)), "ease": EASE_SECONDS})

    # The partner.

    def _show(self):
        """Takes the answers that have come, and moves the partner to the newest one."""
        taken = self._stream.take()
        for frame, positions, arrived in taken:
            self._kept.append(array.array("f", (value for place in positions for value in place)))
            self._latency.answer(frame, arrived)
        self.frames_answered += len(taken)
        if self._puppet and taken:
            if partner.last(self._scene) != self._puppet.armature:
                raise DuetError("The partner was removed.")
            self._pose(self._kept[-1])
            self._latency.show(self._clock())

    def _pose(self, frame):
        metres = self._recording.metres
        self._puppet.pose([Vector((x, -z, y)) / metres
                           for x, y, z in zip(frame[::3], frame[1::3], frame[2::3])])

    def _phases(self):
        """A generator with a step for each tick: waits for the first answer, adds the partner, waits
        for the end, and keeps the partner's motion as an action."""
        while not self._kept:
            if self._stream.has_ended():
                return
            yield
        scene, duet = self._scene, self._scene.duet
        with tempfile.TemporaryDirectory() as folder:
            file, skeleton = os.path.join(folder, "live.json"), os.path.join(folder, "model.json")
            model = yield from _model(duet)
            with open(skeleton, "w", encoding="utf-8") as out:
                json.dump(model, out)
            self._write(file, list(self._kept)[:1] * 2)
            yield from answers.show_file(scene, file, "left", ["--skeleton", skeleton], "MANNEQUIN")
            armature = partner.last(scene)
            armature.animation_data_clear()
            self._puppet = Puppet(armature, self.joints)
            self._pose(self._kept[-1])
            while not self._stream.has_ended() or self._stop_by is None:
                yield
            while bpy.context.mode != "OBJECT":  # an armature cannot be imported
                yield
            self._show()
            self._puppet = None
            self._keeps = True
            self._write(file, self._kept)
            first = self._first_frame + self.frames_answered - len(self._kept)
            yield from answers.show_file(scene, file, "left", ["--skeleton", skeleton], duet.body,
                                         first)

    def _write(self, path, frames):
        """Writes the partner's motion as a file of Duet."""
        rows = [[list(frame[i:i + 3]) for i in range(0, len(frame), 3)] for frame in frames]
        with open(path, "w", encoding="utf-8") as file:
            json.dump({"format": "duet-motion", "version": 1, "frame_rate_hz": self.rate,
                       "unit": "metres", "up_axis": "y-up", "joint_names": self.joints,
                       "leader": rows * (1 if len(rows) > 1 else 2)}, file)


def _model(duet):
    """A generator that returns the chosen model, as `duet models --json` describes it."""
    models = yield from program.models(duet)
    for model in models:
        if duet.model in (f"{model['name']}@{model['version']}", model["name"]) or (
                not duet.model and model["is_default"]):
            return model
    raise DuetError(f"model: expected one that the server serves, got {duet.model!r}")


def start(scene, clock=time.monotonic):
    """Starts a session. Raises DuetError."""
    global _session
    if is_playing():
        raise DuetError("A live session is playing. Stop it first.")
    _session = Session(scene, clock)
    return _session


def is_playing():
    return _session is not None


def tick():
    """One step of the session; returns whether it goes on. Raises DuetError if it fails."""
    global _session
    if _session is None:
        return False
    try:
        _session.tick()
    except BaseException:
        end()
        raise
    if _session.is_over:
        _session = None
    return is_playing()


def stop():
    if _session is not None:
        _session.stop()


@bpy.app.handlers.persistent
def end(*_):
    """Ends the session at once, before Blender replaces the data that it uses."""
    global _session
    if _session is not None:
        _session.kill()
        _session = None


_HANDLERS = ("load_pre", "undo_pre", "redo_pre")


def register():
    for name in _HANDLERS:
        getattr(bpy.app.handlers, name).append(end)


def unregister():
    end()
    for name in _HANDLERS:
        getattr(bpy.app.handlers, name).remove(end)
