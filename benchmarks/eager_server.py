"""A straightforward implementation: a Python gRPC server around the paper's generator in eager
PyTorch, with the same contract. The peer of duet-server in compare_servers.py.

    eager_server.py PORT_FILE [--generator Paper|Sampling]

Answers at the model's rate, for clips of one window. Needs Debian's python3-torch, python3-grpcio,
protobuf-compiler-grpc.
"""
import argparse
import concurrent.futures
import pathlib
import subprocess
import sys
import tempfile

import grpc
import torch

import inference_eager

PROTO = pathlib.Path(__file__).resolve().parent.parent / "proto"
FRAMES, WIDTH = inference_eager.FRAMES, 3 * inference_eager.JOINTS


def generated():
    """The contract's modules, made by protoc."""
    folder = tempfile.mkdtemp()
    plugin = subprocess.run(["which", "grpc_python_plugin"], capture_output=True, check=True,
                            text=True).stdout.strip()
    protos = [str(path.relative_to(PROTO)) for path in sorted((PROTO / "duet/v1").glob("*.proto"))]
    subprocess.run(["protoc", f"-I{PROTO}", f"--python_out={folder}", f"--grpc_python_out={folder}",
                    f"--plugin=protoc-gen-grpc_python={plugin}", *protos], check=True)
    sys.path.insert(0, folder)
    from duet.v1 import model_pb2, reaction_pb2, synthesis_pb2, synthesis_pb2_grpc
    return model_pb2, reaction_pb2, synthesis_pb2, synthesis_pb2_grpc


model_pb2, reaction_pb2, synthesis_pb2, synthesis_pb2_grpc = generated()


class Service(synthesis_pb2_grpc.MotionSynthesisServicer):
    def __init__(self, network, model):
        self.network, self.model = network, model

    def ListModels(self, request, context):
        return synthesis_pb2.ListModelsResponse(models=[self.model])

    def GetModel(self, request, context):
        return synthesis_pb2.GetModelResponse(model=self.model)

    def Synthesize(self, request, context):
        motion = request.leader
        leader = torch.tensor(motion.positions).view(1, motion.frame_count, WIDTH)
        weights = {one.interaction_class: one.weight for one in request.label_vector.weights}
        labels = torch.tensor([weights.get(name, 0.0) for name in self.model.interaction_classes])
        with torch.no_grad():
            follower = self.network(leader, labels.expand(1, motion.frame_count, -1),
                                    torch.zeros(1, inference_eager.START))[0]
        yield synthesis_pb2.SynthesizeResponse(header=synthesis_pb2.SynthesisHeader(
            model_name=self.model.name, model_version=1, joint_names=motion.joint_names,
            frame_rate_hz=motion.frame_rate_hz, unit=motion.unit, up_axis=motion.up_axis,
            frame_count=motion.frame_count, interaction_classes=self.model.interaction_classes,
            request_id="eager", variety=1, clean_up=reaction_pb2.CLEAN_UP_OFF))
        chunks = range(0, motion.frame_count, 30)
        for first in chunks:
            part = follower[first:first + 30]
            yield synthesis_pb2.SynthesizeResponse(chunk=synthesis_pb2.MotionChunk(
                first_frame=first, frame_count=len(part), positions=part.flatten().tolist()))
        yield synthesis_pb2.SynthesizeResponse(summary=synthesis_pb2.SynthesisSummary(
            frame_count=motion.frame_count, chunk_count=len(chunks), window_count=1))


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("port_file", type=pathlib.Path)
    parser.add_argument("--generator", default="Paper")
    chosen = parser.parse_args()
    torch.set_num_threads(1)
    network = getattr(inference_eager, chosen.generator)().eval()
    model = model_pb2.Model(
        name="eager", version=1, frame_rate_hz=15, window_frames=FRAMES, is_default=True,
        joint_names=[f"joint_{i}" for i in range(inference_eager.JOINTS)], root_joint="joint_0",
        bones=[model_pb2.Bone(parent_joint=0, child_joint=i)
               for i in range(1, inference_eager.JOINTS)],
        interaction_classes=[f"class_{i}" for i in range(inference_eager.CLASSES)])
    server = grpc.server(concurrent.futures.ThreadPoolExecutor(max_workers=64))
    synthesis_pb2_grpc.add_MotionSynthesisServicer_to_server(Service(network, model), server)
    port = server.add_insecure_port("127.0.0.1:0")
    server.start()
    chosen.port_file.write_text(str(port), encoding="utf-8")
    server.wait_for_termination()


if __name__ == "__main__":
    main()
