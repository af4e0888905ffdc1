"""Plays plans (plans.py) on a running server, and keeps what it answered."""

import dataclasses
import itertools

import live_clients
from live_clients import Session, grpc, live_pb2, synthesis_pb2, synthesis_pb2_grpc
from live_fuzz import labels, messages, plans

KINDS = {live_pb2.LIVE_NOTICE_KIND_GAP_FILLED: "gap", live_pb2.LIVE_NOTICE_KIND_LATE: "late",
         live_pb2.LIVE_NOTICE_KIND_SKIPPED: "skipped"}


@dataclasses.dataclass
class Answer:
    """What came of a session. `frames`, `rotations`: values by frame. `notices`: (kind, first frame, count)."""
    code: str = "OK"
    text: str = ""
    fields: list = dataclasses.field(default_factory=list)
    cancelled: bool = False
    first_frame: int = 0
    history_frames: int = 0
    frames: dict = dataclasses.field(default_factory=dict)
    rotations: dict = dataclasses.field(default_factory=dict)
    rig: bytes = b""
    notices: list = dataclasses.field(default_factory=list)
    summary: dict = None  # field -> value; None without one

    @property
    def skipped(self):
        return sum(count for kind, _, count in self.notices if kind == "skipped")


def models_of(channel, names, patience):
    """Name -> (joints, root) of the default version."""
    stub = synthesis_pb2_grpc.MotionSynthesisStub(channel)
    found = {}
    for name in names:
        request = synthesis_pb2.GetModelRequest(model={"name": name})
        model = stub.GetModel(request, timeout=patience).model
        found[name] = (list(model.joint_names), model.root_joint)
    return found


class Player:
    def __init__(self, channel, models, patience):
        self._channel = channel
        self._models = models
        self._patience = patience

    def play(self, made):
        """The answer to a plan."""
        wording = self._wording(made)
        sent = made["lead_in"] + (made["history"]["first_frame"] if made["history"] else 0)
        return self._session(wording, wording.start(), made["steps"], sent, made)

    def resume(self, made, whole, at):
        """The answer to a session that goes on where `whole`, the answer to the plan, is interrupted. None where it
        cannot be: no frame had arrived, or the caller asked for nothing."""
        steps = made["steps"]
        sent = self._sent(made, steps[:at["after"]])
        is_over = at["after"] >= len(steps)
        received = (sent if is_over else sent - plans.delay(made)) - at["lost"]
        if received < 1:
            return None
        first = max(0, received - whole.history_frames - at["extra"])
        first = max(first, sent - int(10 * made["rate"]))
        wording = self._wording(made)
        start = wording.resumed(
            first, sent - first, [whole.frames[frame] for frame in range(first, received)], whole.frames[0],
            labels.after(made["labels"], steps[:at["after"]], made["lead_in"], plans.delay(made)))
        return self._session(wording, start, _in_messages(steps[at["after"]:], at["message"]), sent, made)

    def _wording(self, made):
        return messages.Messages(made, *self._models[made["model"]])

    @staticmethod
    def _sent(made, steps):
        return max([made["lead_in"], *(step[1] + step[2] for step in steps if step[0] == "frames")])

    def _session(self, wording, start, steps, sent, made):
        session = Session(self._channel, start, timeout=self._patience)
        answer = Answer()
        try:
            for step in steps:
                sent = self._take(session, wording, step, sent, made)
            if made["end"] == "cancel":
                answer.cancelled = session.call.cancel()
            else:
                session.drain()
        except grpc.RpcError:
            pass
        finally:
            session.finish()
        if not answer.cancelled:
            answer.code, answer.text, answer.fields = session.error()
        _fill(answer, session)
        return answer

    @staticmethod
    def _take(session, wording, step, sent, made):
        """Takes a step; returns the index of the next leader frame."""
        if step == ["wait"]:
            due = sent - plans.delay(made)
            while session.header is None or due > _received(session):
                assert session.read(), "the stream ended before the frames that are due"
            return sent
        session.send(wording.step(step, sent))
        return max(sent, step[1] + step[2]) if step[0] == "frames" else sent


def _received(session):
    """The index of the first follower frame that has not arrived."""
    return max(session.frames, default=session.header.first_frame - 1) + 1


def _in_messages(steps, size):
    """The steps with their leader frames in messages of another size, unless something else lies between them."""
    if any(step[0] not in ("frames", "wait") for step in steps):
        return steps
    frames = [step for step in steps if step[0] == "frames"]
    if not frames:
        return steps
    begin, end = frames[0][1], frames[-1][1] + frames[-1][2]
    return [*itertools.chain.from_iterable(
        (["frames", first, min(size, end - first)], ["wait"]) for first in range(begin, end, size))]


def _fill(answer, session):
    if session.header is not None:
        answer.first_frame = session.header.first_frame
        answer.history_frames = session.header.history_frames
    answer.frames = session.frames
    for part in session.parts:
        width = len(part.rotations) // max(1, part.frame_count)
        for i in range(part.frame_count if width else 0):
            answer.rotations[part.first_frame + i] = list(part.rotations[width * i:width * (i + 1)])
        answer.rig += b"".join(joint.SerializeToString() for joint in part.rig)
    answer.notices = [(KINDS.get(notice.kind, str(notice.kind)), notice.frames.first_frame,
                       notice.frames.frame_count) for notice in session.notices]
    if session.summary is not None:
        answer.summary = {field.name: getattr(session.summary, field.name)
                          for field in live_clients.live_pb2.LiveSummary.DESCRIPTOR.fields}
