"""A client that shares no code with ours: Python's grpcio, with stubs generated from the protos."""

import math
import tempfile

import tools

try:
    import grpc
except ImportError as error:
    tools.skip(f"{error}; install the package python3-grpcio")

PROTOS = ("duet/v1/model.proto", "duet/v1/motion.proto", "duet/v1/reaction.proto",
          "duet/v1/live.proto", "duet/v1/synthesis.proto",
          "duet/rpc/v1/status.proto")
FRAMES = 40


class ForeignClientTest(tools.ServedTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        channel = grpc.insecure_channel(cls.server.address)
        cls.addClassCleanup(channel.close)
        cls.stub = synthesis_pb2_grpc.MotionSynthesisStub(channel)

    def request(self):
        """A standing leader who raises a hand; metres, z up, as Blender would send it."""
        model = self.stub.GetModel(synthesis_pb2.GetModelRequest(), timeout=tools.RUN_SECONDS).model
        leader = motion_pb2.Motion(joint_names=model.joint_names, frame_rate_hz=24,
                                   unit=motion_pb2.LENGTH_UNIT_METRES,
                                   up_axis=motion_pb2.UP_AXIS_Z_UP, frame_count=FRAMES)
        for frame in range(FRAMES):
            for joint in model.joint_names:
                leader.positions.extend(standing(joint, frame / FRAMES))
        request = synthesis_pb2.SynthesizeRequest(leader=leader)
        request.label_vector.weights.add(interaction_class="punch", weight=1)
        return request

    def test_lists_models(self):
        models = self.stub.ListModels(synthesis_pb2.ListModelsRequest(),
                                      timeout=tools.RUN_SECONDS).models
        self.assertEqual([(model.name, model.is_default) for model in models],
                         [("k3hi", False), ("salsa", False), ("sbu", True), ("sbu", False)])
        self.assertEqual(set(models[2].interaction_classes), set(tools.CLASSES))
        for model in models:
            self.assertEqual(len(model.bones), len(model.joint_names) - 1)

    def test_synthesizes(self):
        request = self.request()
        request.chunk_frames = 8
        responses = list(self.stub.Synthesize(request, timeout=tools.RUN_SECONDS))
        kinds = [response.WhichOneof("payload") for response in responses]
        self.assertEqual(kinds[0], "header")
        self.assertEqual(kinds[-1], "summary")
        self.assertEqual(set(kinds[1:-1]), {"chunk"})
        header, summary = responses[0].header, responses[-1].summary
        self.assertEqual(header.frame_count, FRAMES)
        self.assertEqual(header.frame_rate_hz, 24)
        self.assertEqual(header.up_axis, motion_pb2.UP_AXIS_Z_UP)
        self.assertEqual(list(header.joint_names), list(request.leader.joint_names))
        self.assertEqual(summary.frame_count, FRAMES)
        self.assertEqual(summary.chunk_count, len(responses) - 2)

        frames = 0
        for response in responses[1:-1]:
            chunk = response.chunk
            self.assertEqual(chunk.first_frame, frames)
            self.assertLessEqual(chunk.frame_count, 8)
            self.assertEqual(len(chunk.positions), chunk.frame_count * len(header.joint_names) * 3)
            self.assertTrue(all(map(math.isfinite, chunk.positions)))
            frames += chunk.frame_count
        self.assertEqual(frames, FRAMES)
        # The reply is in the caller's world: heads are up.
        first = responses[1].chunk.positions
        joints = list(header.joint_names)
        head, foot = (first[3 * joints.index(joint) + 2] for joint in ("head", "left_foot"))
        self.assertGreater(head - foot, 1)

    def test_a_subset_of_joints(self):
        request = self.request()
        request.reply_joint_names.extend(["right_hand", "head"])
        responses = list(self.stub.Synthesize(request, timeout=tools.RUN_SECONDS))
        self.assertEqual(list(responses[0].header.joint_names), ["right_hand", "head"])
        values = sum(len(response.chunk.positions) for response in responses)
        self.assertEqual(values, FRAMES * 2 * 3)

    def test_rejection_names_every_field(self):
        request = self.request()
        request.leader.frame_rate_hz = 0
        request.leader.positions[5] = math.nan
        request.label_vector.weights.add(interaction_class="dance", weight=1)
        with self.assertRaises(grpc.RpcError) as caught:
            list(self.stub.Synthesize(request, timeout=tools.RUN_SECONDS))
        self.assertEqual(caught.exception.code(), grpc.StatusCode.INVALID_ARGUMENT)
        trailers = dict(caught.exception.trailing_metadata())
        status = status_pb2.Status.FromString(trailers["grpc-status-details-bin"])
        self.assertEqual(status.code, grpc.StatusCode.INVALID_ARGUMENT.value[0])
        details = {detail.type_url.rsplit("/", 1)[1]: detail.value for detail in status.details}
        violations = status_pb2.BadRequest.FromString(details["google.rpc.BadRequest"])
        fields = {violation.field for violation in violations.field_violations}
        self.assertLessEqual({"leader.frame_rate_hz", "leader.positions[5]"}, fields)
        self.assertTrue(any(field.startswith("label_vector.weights[1]") for field in fields), fields)
        for violation in violations.field_violations:
            self.assertRegex(violation.description, "^expected .*, got ")
        info = status_pb2.ErrorInfo.FromString(details["google.rpc.ErrorInfo"])
        self.assertEqual(info.domain, "duet.v1")
        self.assertEqual(info.reason, "INVALID_REQUEST")

    def test_an_unknown_model_is_not_found(self):
        request = synthesis_pb2.GetModelRequest()
        request.model.name = "nobody"
        with self.assertRaises(grpc.RpcError) as caught:
            self.stub.GetModel(request, timeout=tools.RUN_SECONDS)
        self.assertEqual(caught.exception.code(), grpc.StatusCode.NOT_FOUND)


def standing(joint, phase):
    """x (left), y (back), z (up) of a joint of a person; the right hand rises with `phase`."""
    if joint == "right_hand":
        return (-0.3, -0.4 * phase, 0.8 + 0.6 * phase)
    side = 1 if joint.startswith("left") else -1 if joint.startswith("right") else 0
    part = joint.split("_")[-1]
    across, up = {"head": (0, 1.6), "neck": (0, 1.4), "torso": (0, 1.15), "shoulder": (0.17, 1.38),
                  "elbow": (0.25, 1.1), "hand": (0.27, 0.85), "hip": (0.1, 0.92),
                  "knee": (0.11, 0.5), "foot": (0.12, 0.08)}[part]
    return (side * across, 0.0, up)


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as stubs:
        tools.generate_stubs(stubs, *PROTOS)
        from duet.rpc.v1 import status_pb2
        from duet.v1 import motion_pb2, synthesis_pb2, synthesis_pb2_grpc
        tools.main()
