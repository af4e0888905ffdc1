"""Helpers of the Python package's tests: a leader, valid replies, a scripted server."""

import concurrent.futures
import contextlib
import itertools
import os
import pathlib
import sys
import threading

SOURCE = pathlib.Path(__file__).parents[3]
PACKAGE = SOURCE / "client" / "python"
sys.path.insert(0, str(PACKAGE))
# These servers have no health service; gRPC would log this at every connection.
os.environ.setdefault("GRPC_VERBOSITY", "NONE")
# Ignore the settings of the person who runs the tests.
os.environ.pop("DUET_SERVER", None)

try:
    import grpc
    import numpy as np
except ImportError as error:
    print(f"skipped: {error}; install the packages python3-grpcio and python3-numpy")
    sys.exit(77)  # CTest: the test was skipped

import duet_motion as duet  # noqa: E402
from duet_motion.rpc.v1 import status_pb2  # noqa: E402
from duet_motion.v1 import live_pb2, motion_pb2, synthesis_pb2, synthesis_pb2_grpc  # noqa: E402

# The programs of the build.
PROGRAMS = pathlib.Path(os.environ.get("DUET_BIN_DIR", SOURCE / "build/release/bin"))

JOINTS = ("root", "left", "right")
# Backoff too short to matter, and an upper bound for calls that should finish immediately.
QUICK = duet.RetryOptions(max_attempts=4, initial_backoff=0.001, max_backoff=0.001)
LONGEST_CALL = 60


def leader(frames=6, **changes):
    """A leader whose positions are all distinct."""
    positions = np.arange(frames * 9, dtype=np.float32).reshape(frames, 3, 3)
    return duet.Motion(**{"positions": positions, "joint_names": JOINTS, "frame_rate_hz": 30,
                          **changes})


def header(motion, **changes):
    values = {"model_name": "m", "model_version": 1, "joint_names": motion.joint_names,
              "frame_rate_hz": motion.frame_rate_hz, "unit": 1, "up_axis": 1,
              "frame_count": motion.frame_count, "interaction_classes": ["hug"],
              "request_id": "r", "seed": 3, "variety": 0.5, "candidates": 4,
              "clean_up": 1}
    return synthesis_pb2.SynthesizeResponse(
        header=synthesis_pb2.SynthesisHeader(**{**values, **changes}))


def follower_of(motion):
    """The follower in a valid reply: the leader moved by a metre."""
    return motion.positions + np.float32([1, 0, 0])


def chunk(motion, first, count, **changes):
    positions = follower_of(motion)[first:first + count]
    values = {"first_frame": first, "frame_count": count, "positions": positions.ravel().tolist()}
    return synthesis_pb2.SynthesizeResponse(
        chunk=synthesis_pb2.MotionChunk(**{**values, **changes}))


def summary(motion, chunks, **changes):
    values = {"frame_count": motion.frame_count, "chunk_count": chunks, "window_count": 1,
              "queue_seconds": 0.25, "compute_seconds": 0.5, "unfamiliarity": 0.75}
    return synthesis_pb2.SynthesizeResponse(
        summary=synthesis_pb2.SynthesisSummary(**{**values, **changes}))


def good_reply(motion, size=2, **changes):
    firsts = range(0, motion.frame_count, size)
    return [header(motion, **changes),
            *(chunk(motion, first, min(size, motion.frame_count - first)) for first in firsts),
            summary(motion, len(firsts))]


def details(*messages):
    """Trailing metadata with google.rpc details."""
    status = status_pb2.Status()
    for message in messages:
        name = message.DESCRIPTOR.name
        status.details.add(type_url=f"type.googleapis.com/google.rpc.{name}",
                           value=message.SerializeToString())
    return (("grpc-status-details-bin", status.SerializeToString()),)


def retry_info(seconds):
    info = status_pb2.RetryInfo()
    info.retry_delay.FromNanoseconds(int(seconds * 1e9))
    return info


def bad_request(*violations):
    refusal = status_pb2.BadRequest()
    for field, description in violations:
        refusal.field_violations.add(field=field, description=description)
    return refusal


class Failure(Exception):
    """The error that ends a scripted call."""

    def __init__(self, code, message="", *messages):
        super().__init__(code, message)
        self.code, self.message, self.details = code, message, details(*messages)


class Script(synthesis_pb2_grpc.MotionSynthesisServicer):
    """Answers from a script with one entry per attempt, and records requests and metadata. An entry
    is a message, a Failure, or a list of messages that may contain callables, which are called with
    the context, and end with a Failure."""

    def __init__(self, *answers):
        self.answers, self.requests, self.metadata = list(answers), [], []

    def _next(self, request, context):
        self.requests.append(request)
        self.metadata.append(dict(context.invocation_metadata()))
        return self.answers.pop(0)

    def _abort(self, failure, context):
        context.set_trailing_metadata(failure.details)
        context.abort(failure.code, failure.message)

    def _unary(self, request, context):
        answer = self._next(request, context)
        if isinstance(answer, Failure):
            self._abort(answer, context)
        return answer

    ListModels = GetModel = _unary

    def Synthesize(self, request, context):
        for item in self._next(request, context):
            if isinstance(item, Failure):
                self._abort(item, context)
            elif callable(item):
                item(context)
            else:
                yield item


class Holding(synthesis_pb2_grpc.MotionSynthesisServicer):
    """Holds calls until their deadlines."""

    def _hold(self, _, context):
        ended = threading.Event()
        if context.add_callback(ended.set):
            ended.wait(LONGEST_CALL)

    ListModels = GetModel = _hold


def held_reply(motion, ended, go_on):
    """A stream that stops after its first chunk until `go_on`, and sets `ended` when the call
    ends."""
    head, first = good_reply(motion)[:2]
    # The callback is added before the chunk, so the test that has the chunk gets `ended`.
    return [head, lambda context: context.add_callback(ended.set) or ended.set(), first,
            lambda context: go_on.wait(LONGEST_CALL)]


@contextlib.contextmanager
def serving(servicer, credentials=None, threads=8):
    """Runs a server with this servicer and yields its address."""
    server = grpc.server(concurrent.futures.ThreadPoolExecutor(threads))
    synthesis_pb2_grpc.add_MotionSynthesisServicer_to_server(servicer, server)
    if credentials is None:
        port = server.add_insecure_port("127.0.0.1:0")
    else:
        port = server.add_secure_port("127.0.0.1:0", credentials)
    server.start()
    try:
        yield f"127.0.0.1:{port}"
    finally:
        server.stop(None).wait()


class Together(synthesis_pb2_grpc.MotionSynthesisServicer):
    """Measures how many calls a client makes at a time, and rejects seed 3.

    The first `wanted` calls wait for each other, so a client that makes fewer at a time blocks.
    They then wait a moment for one more, which must not come. `most` is the maximum number of
    concurrent calls.
    """

    def __init__(self, wanted):
        self._barrier = threading.Barrier(wanted)
        self._lock = threading.Lock()
        self._begun, self._wanted = 0, wanted
        self._running, self.most = 0, 0
        self._one_more = threading.Event()

    def Synthesize(self, request, context):
        with self._lock:
            self._begun += 1
            self._running += 1
            self.most = max(self.most, self._running)
            is_first = self._begun <= self._wanted
            if self._running > self._wanted:
                self._one_more.set()
        if is_first:
            self._barrier.wait(LONGEST_CALL)
            self._one_more.wait(0.2)
        with self._lock:
            self._running -= 1
        if request.seed == 3:
            context.abort(grpc.StatusCode.INVALID_ARGUMENT, "seed: 3")
        motion = leader(request.leader.frame_count)
        yield from good_reply(motion, seed=request.seed)


class Mirror(synthesis_pb2_grpc.MotionSynthesisServicer):
    """Answers live sessions: the follower is the leader moved by a metre. Records what each stream
    sent, as `streams`, lists of requests.

    `scripts` has one dict for each stream; later streams have none. `after`: number of final frames
    in the stream until the script acts. `act`: a Failure that ends the stream, "end" (without a
    summary), "drain" (a notice; the stream goes on), "hang" (nothing more is sent), or a message to
    send. `header`: changed fields of the header. `extra`: messages to send behind the header.
    """

    HISTORY = 4

    def __init__(self, *scripts):
        self._scripts, self.streams, self.metadata = list(scripts), [], []

    def SynthesizeLive(self, requests, context):
        script = self._scripts.pop(0) if self._scripts else {}
        received = []
        self.streams.append(received)
        self.metadata.append(dict(context.invocation_metadata()))
        start = self._take(requests, received).start
        poses = np.float32(start.leader.positions).reshape(-1, len(JOINTS), 3)
        first = start.history.first_frame
        leader = {first + index: pose for index, pose in enumerate(poses)}
        done = begun = first + start.history.follower_frame_count
        yield live_header(start, begun, history_frames=self.HISTORY, **script.get("header", {}))
        yield from script.get("extra", ())
        # The start may have frames that are due.
        for message in itertools.chain(received[:1], requests):
            if message.HasField("start"):
                message = live_pb2.SynthesizeLiveRequest()
            else:
                received.append(message)
            if message.HasField("frames"):
                block = np.float32(message.frames.positions).reshape(-1, len(JOINTS), 3)
                leader.update(enumerate(block, message.frames.first_frame))
            while done + start.delay_frames in leader:
                if script.get("after") == done - begun:
                    act = script["act"]
                    if isinstance(act, Failure):
                        context.set_trailing_metadata(act.details)
                        context.abort(act.code, act.message)
                    elif act == "end":
                        return
                    elif act == "hang":
                        ended = threading.Event()
                        context.add_callback(ended.set)
                        ended.wait(LONGEST_CALL)
                        return
                    yield live_notice(4) if act == "drain" else act
                yield live_frames(start, done, leader, message.frames.capture_seconds)
                done += 1
        while done in leader:  # half-closed
            yield live_frames(start, done, leader, 0)
            done += 1
        yield live_pb2.SynthesizeLiveResponse(summary=live_pb2.LiveSummary(
            frame_count=done - begun, window_count=3, queue_seconds=0.25, compute_seconds=0.5))

    def _take(self, requests, received):
        received.append(next(requests))
        return received[-1]


def live_header(start, first, **changes):
    leader = start.leader
    values = {"model_name": "m", "model_version": 1, "joint_names": leader.joint_names,
              "frame_rate_hz": leader.frame_rate_hz, "unit": leader.unit,
              "up_axis": leader.up_axis, "interaction_classes": ["hug"], "request_id": "r",
              "seed": start.seed, "variety": 0.5, "clean_up": 1, "candidates": 4,
              "delay_frames": start.delay_frames, "first_frame": first}
    return live_pb2.SynthesizeLiveResponse(header=live_pb2.LiveHeader(**{**values, **changes}))


def live_frames(start, frame, leader, capture_seconds):
    pose = leader[frame] + np.float32([1, 0, 0])
    rotations = {}
    if start.reply_rotations:
        begun = start.history.first_frame + start.history.follower_frame_count
        rig = [motion_pb2.RigJoint(name="root", parent=-1, joint=0),
               motion_pb2.RigJoint(name="left", parent=0, joint=1, offset={"y": 0.5})]
        rotations = {"rig": rig if frame == begun else [],
                     "rotations": [0, 0, 0, 1, *live_quaternion(frame)]}
    return live_pb2.SynthesizeLiveResponse(frames=live_pb2.FollowerFrames(
        **rotations, first_frame=frame, frame_count=1, positions=pose.ravel().tolist(),
        plan_positions=np.tile(pose.ravel(), start.plan_frames).tolist(),
        leader_frame=max(leader), capture_seconds=capture_seconds, server_seconds=0.125))


def live_quaternion(frame):
    """That of the second joint: x, y, z, w with w >= 0 of a steady turn about x."""
    half = 0.25 * frame
    sign = 1 if np.cos(half) >= 0 else -1
    return [float(sign * np.sin(half)), 0.0, 0.0, float(sign * np.cos(half))]


def live_notice(kind, first=0, count=0):
    notice = live_pb2.LiveNotice(kind=kind)
    if count:
        notice.frames.first_frame, notice.frames.frame_count = first, count
    return live_pb2.SynthesizeLiveResponse(notice=notice)
