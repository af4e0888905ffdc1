"""Real requests of every method that the server offers: what the fuzzer starts from.

The fuzzer asks the server by reflection what it serves, and fails for a method that has none here."""

import array
import pathlib
import struct

import tools
from wire.protobuf import FIXED64, Field, message, values

HEALTH = "grpc.health.v1.Health"
REFLECTION = "grpc.reflection.v1alpha.ServerReflection"
SYNTHESIS = "duet.v1.MotionSynthesis"
SYNTHESIZE = f"{SYNTHESIS}/Synthesize"
LIVE = f"{SYNTHESIS}/SynthesizeLive"
ADMIN = "duet.admin.v1.Admin"
# Methods whose answer has no end unless the client cancels the call.
ENDLESS = (f"{HEALTH}/Watch",)
# A model that exists in order to be loaded, unloaded and labelled. No request that changes anything
# names another one, so that good calls have the same answer throughout.
SPARE = "spare"


def requests_of_methods(source):
    """"service/method" -> its requests, the simplest first. `source`: the project's folder."""
    samples = pathlib.Path(source) / "tests/fuzz/corpus/synthesis_request"
    synthesize = [(samples / name).read_bytes() for name in ("sample", "options")]
    synthesize += [with_rotations(synthesize[0]), with_time_line(synthesize[0])]
    version, label = message(f1=SPARE, f2=1), message(f1=SPARE, f2="blue", f3=1)
    return {
        SYNTHESIZE: synthesize,
        LIVE: live_messages(synthesize[0]),
        f"{SYNTHESIS}/ListModels": [b""],
        f"{SYNTHESIS}/GetModel": [message(f1=message(f1="sbu", f2=3)),
                                  message(f1=message(f1=SPARE, f3="blue")), b""],
        f"{ADMIN}/ListModels": [b""],
        f"{ADMIN}/LoadModel": [version],
        f"{ADMIN}/UnloadModel": [version],
        f"{ADMIN}/Reload": [b""],
        f"{ADMIN}/SetLabel": [label],
        f"{ADMIN}/DeleteLabel": [message(f1=SPARE, f2="blue")],
        f"{HEALTH}/Check": [message(f1=SYNTHESIS), b""],
        f"{HEALTH}/Watch": [message(f1=SYNTHESIS), b""],
        f"{REFLECTION}/ServerReflectionInfo": [
            message(f7=""), message(f1="host", f3="duet/v1/synthesis.proto"),
            message(f4=f"{SYNTHESIS}.Synthesize"), message(f5=message(f1="duet.v1.Motion", f2=7)),
            message(f6="duet.v1.Motion")],
    }


def standing(frames, rate=15, chunk_frames=30, keyframes=0):
    """A request for the answer to a person of the model sbu who stands. Encoded by hand, because generated Python code
    takes seconds for the longest leaders."""
    heights = {"head": 1.6, "neck": 1.4, "torso": 1.15, "shoulder": 1.38, "elbow": 1.1, "hand": 0.85, "hip": 0.92,
               "knee": 0.5, "foot": 0.08}
    pose = [value for joint in tools.JOINTS
            for value in (0.15 * (joint.startswith("left") - joint.startswith("right")), heights[joint.split("_")[-1]], 0)]
    leader = (message(f1=tools.JOINTS) + Field(2, FIXED64, struct.pack("<d", rate)).encoded() +
              message(f3=1, f4=1, f5=frames, f6=array.array("f", pose).tobytes() * frames))  # metres, y up
    weights = message(f1=message(f1="punch", f2=1.0))
    labels = message(f4=[message(f1=i, f2=weights) for i in range(keyframes)]) or message(f3=weights)
    return message(f2=leader) + labels + message(f6=chunk_frames)


def with_rotations(sample):
    """A request with the fields that neither of the files has."""
    return sample + message(f7=1, f12=1, f13=2, f14=1, f15=message(f1=0.05, f2=1.0))


def with_time_line(sample):
    """A request with weights that change over time, a pose to start from, a vertical and a pin."""
    leader, labels = values(sample, 2)[0], values(sample, 3)[0]
    pin = message(f1="right_hand", f2=1, f3=message(f1=0.5, f2=1.0, f3=0.5), f4=0.5)
    return (message(f2=leader, f13=4, f14=1, f15=message(f1=0.05, f2=1.0), f16=pin) +
            time_line_and_pose(leader, labels))


def time_line_and_pose(leader, labels):
    """The fields label_keyframes and follower_start. The follower stands where the leader does."""
    return (message(f4=message(f2=labels)) + message(f4=message(f1=1, f2=labels)) +
            message(f5=message(f2=message(f1=first_frame(leader)))))


def first_frame(leader):
    positions = values(leader, 6)[0]  # of two frames
    return positions[:len(positions) // 2]


def live_messages(sample):
    """Starts of a new and of a resumed session, and of one with a pose, then what may follow a start. The
    fields that a LiveStart and a clip's request share have the same numbers."""
    leader, labels = values(sample, 2)[0], values(sample, 3)[0]
    positions, first = values(leader, 6)[0], first_frame(leader)
    history = message(f1=5, f2=2, f3=positions, f4=first, f5=first)
    resumed = message(f2=leader, f4=message(f2=labels), f7=7, f8=0.5, f9=1, f10=2,
                      f11=message(f1=0.05, f2=1.0), f12=2, f13=3, f14=history, f15=1)
    return [message(f1=sample), message(f1=sample + message(f15=1)), message(f1=resumed),
            message(f1=message(f2=leader, f10=4, f11=message(f1=0.05, f2=1.0), f12=2, f13=3, f15=1) +
                    time_line_and_pose(leader, labels)),
            message(f2=message(f1=7, f2=2, f3=positions)),
            message(f3=message(f2=labels, f3=3))]


def openings(method, requests):
    """The messages of which one must come before others in a call of a method, the one with the most
    fields first; none if each message stands alone."""
    starts = requests[:-2] if method == LIVE else []
    return sorted(starts, key=len, reverse=True)
