"""Requests of the soak test, from stubs that protoc makes."""

import pathlib
import subprocess
import sys

SOURCE = pathlib.Path(__file__).resolve().parents[3]

SYNTHESIZE = "/duet.v1.MotionSynthesis/Synthesize"
LIST_MODELS = "/duet.v1.MotionSynthesis/ListModels"


def load_protos(folder):
    """The modules (motion, synthesis), which protoc writes to the folder."""
    subprocess.run(["protoc", f"-I{SOURCE / 'proto'}", f"--python_out={folder}",
                    "duet/v1/model.proto", "duet/v1/motion.proto", "duet/v1/reaction.proto",
                    "duet/v1/live.proto", "duet/v1/synthesis.proto"],
                   check=True)
    sys.path.insert(0, folder)
    from duet.v1 import motion_pb2, synthesis_pb2  # pylint: disable=import-outside-toplevel
    return motion_pb2, synthesis_pb2


def sample_request(protos, frames, rate=15.0):
    """A serialized request for a standing leader with the default model's joints."""
    motion, synthesis = protos
    joints = ("head neck torso left_shoulder left_elbow left_hand right_shoulder right_elbow "
              "right_hand left_hip left_knee left_foot right_hip right_knee right_foot").split()
    leader = motion.Motion(joint_names=joints, frame_rate_hz=rate, frame_count=frames,
                           unit=motion.LENGTH_UNIT_METRES, up_axis=motion.UP_AXIS_Y_UP)
    heights = {"head": 1.6, "neck": 1.4, "torso": 1.15, "shoulder": 1.38, "elbow": 1.1,
               "hand": 0.85, "hip": 0.92, "knee": 0.5, "foot": 0.08}
    one = []
    for joint in joints:
        side = 0.15 if joint.startswith("left") else -0.15 if joint.startswith("right") else 0.0
        one += [side, heights[joint.split("_")[-1]], 0.0]
    leader.positions.extend(one * frames)
    request = synthesis.SynthesizeRequest(leader=leader)
    request.label_vector.weights.add(interaction_class="punch", weight=1)
    return request.SerializeToString()
