"""A client of live sessions that shares no code with ours: Python's grpcio, with stubs generated from
the protos, and a leader who moves."""

import math
import queue

import stubs
import tools
from stubs import grpc, live_pb2, motion_pb2, synthesis_pb2, synthesis_pb2_grpc  # noqa: F401

# Across to the left and up, in metres.
_PLACES = {"head": (0, 1.6), "neck": (0, 1.4), "torso": (0, 1.15), "chest": (0, 1.3),
           "spine": (0, 1.1), "hips": (0, 0.95), "shoulder": (0.17, 1.38), "collar": (0.08, 1.36),
           "elbow": (0.25, 1.1), "wrist": (0.27, 0.9), "hand": (0.28, 0.82), "hip": (0.1, 0.92),
           "knee": (0.11, 0.5), "ankle": (0.12, 0.09), "foot": (0.12, 0.06), "toe": (0.13, 0.02)}


def person(joints, rate, frames, from_frame=0):
    """Frames of a person who sways, turns and raises the hands: a list of lists of 3 x joints values,
    in metres, x to the left, y up, z ahead."""
    return [[value for joint in joints for value in _place(joint, frame / rate)]
            for frame in range(from_frame, from_frame + frames)]


def _place(joint, seconds):
    words = joint.lower().split("_")
    side = 1 if "left" in words else -1 if "right" in words else 0
    part = next((word for word in reversed(words) if word in _PLACES), None)
    across, up = _PLACES.get(part, (0.05, 1.0))
    x, z = side * across, 0.0
    if part in ("elbow", "wrist", "hand"):
        reach = 0.5 + 0.5 * math.sin(2.2 * seconds + side)
        z += 0.35 * reach
        up += 0.3 * reach
    if part in ("toe", "foot"):
        z += 0.1
    turn = 0.4 * math.sin(0.7 * seconds)
    x, z = x * math.cos(turn) + z * math.sin(turn), z * math.cos(turn) - x * math.sin(turn)
    return (x + 0.2 * math.sin(1.3 * seconds), up, z + 0.15 * math.sin(0.9 * seconds))


def start_message(joints=tools.JOINTS, rate=30, label="hug", **changes):
    """The first message of a session in metres, y up."""
    start = live_pb2.LiveStart(**{"seed": 7, **changes})
    leader = start.leader
    if not leader.joint_names:
        leader.joint_names.extend(joints)
    leader.frame_rate_hz = leader.frame_rate_hz or rate
    leader.unit = leader.unit or motion_pb2.LENGTH_UNIT_METRES
    leader.up_axis = leader.up_axis or motion_pb2.UP_AXIS_Y_UP
    if label:
        start.label_vector.weights.add(interaction_class=label, weight=1)
    return live_pb2.SynthesizeLiveRequest(start=start)


def frames_message(first, frames, capture_seconds=0.0):
    return live_pb2.SynthesizeLiveRequest(frames=live_pb2.LeaderFrames(
        first_frame=first, frame_count=len(frames), capture_seconds=capture_seconds,
        positions=[value for frame in frames for value in frame]))


def label_message(label, **changes):
    change = live_pb2.LabelChange(**changes)
    change.label_vector.weights.add(interaction_class=label, weight=1)
    return live_pb2.SynthesizeLiveRequest(label_change=change)


class Session:
    """One call. What arrived is in `header`, `frames` (by index), `parts`, `notices`, `summary`."""

    def __init__(self, channel, start, **options):
        self._messages = queue.SimpleQueue()
        self._messages.put(start)
        stub = synthesis_pb2_grpc.MotionSynthesisStub(channel)
        self.call = stub.SynthesizeLive(iter(self._messages.get, None),
                                        **{"timeout": tools.RUN_SECONDS, **options})
        self.header = self.summary = None
        self.frames, self.parts, self.notices = {}, [], []

    def send(self, message):
        self._messages.put(message)

    def finish(self):
        self._messages.put(None)

    def read(self):
        """Takes one message; False at the end. Raises grpc.RpcError."""
        response = next(self.call, None)
        if response is None:
            return False
        kind = response.WhichOneof("payload")
        if kind == "frames":
            self._keep(response.frames)
        elif kind == "notice":
            self.notices.append(response.notice)
        else:
            setattr(self, kind, getattr(response, kind))
        return True

    def _keep(self, part):
        values = 3 * len(self.header.joint_names)
        expected = max(self.frames, default=self.header.first_frame - 1) + 1
        assert part.first_frame == expected, "frames follow one another without gaps"
        assert len(part.positions) == values * part.frame_count
        for i in range(part.frame_count):
            self.frames[part.first_frame + i] = list(part.positions[values * i:values * (i + 1)])
        self.parts.append(part)

    def wait_for(self, frame):
        """Reads until a frame is there."""
        while frame not in self.frames:
            assert self.read(), f"the stream ended before frame {frame}"

    def drain(self):
        """Ends the messages and reads to the end."""
        self.finish()
        while self.read():
            pass

    def error(self):
        """Reads to the end: the status code, the message, and the fields of its BadRequest."""
        try:
            while self.read():
                pass
        except grpc.RpcError as failure:
            refusal = stubs.details_of(failure).get("BadRequest")
            fields = [violation.field for violation in refusal.field_violations] if refusal else []
            return failure.code().name, failure.details(), fields
        return "OK", "", []


def lockstep(channel, start, leader, labels=None, first=0):
    """A whole session that sends leader frame by frame, each after the answer to the one before.
    `labels`: messages to send before a frame. `first`: the index of leader[0]."""
    session = Session(channel, start)
    delay = start.start.delay_frames
    for frame, pose in enumerate(leader, first):
        if labels and frame in labels:
            session.send(labels[frame])
        session.send(frames_message(frame, [pose], frame))
        if frame >= delay:
            session.wait_for(frame - delay)
    session.drain()
    return session
