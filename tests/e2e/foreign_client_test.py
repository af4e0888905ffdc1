"""A client that shares no code with ours: Python's grpcio, with stubs generated from the protos."""

import math

import stubs
import tools
from live_clients import person
from stubs import grpc, motion_pb2, synthesis_pb2, synthesis_pb2_grpc

FRAMES = 40


class ForeignClientTest(tools.ServedTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        channel = grpc.insecure_channel(cls.server.address)
        cls.addClassCleanup(channel.close)
        cls.stub = synthesis_pb2_grpc.MotionSynthesisStub(channel)

    def request(self):
        """A leader who sways; metres, z up, as Blender would send it."""
        leader = motion_pb2.Motion(joint_names=tools.JOINTS, frame_rate_hz=24, unit=motion_pb2.LENGTH_UNIT_METRES,
                                   up_axis=motion_pb2.UP_AXIS_Z_UP, frame_count=FRAMES)
        for pose in person(tools.JOINTS, 24, FRAMES):
            for x, y, z in zip(pose[0::3], pose[1::3], pose[2::3]):
                leader.positions.extend((x, -z, y))
        request = synthesis_pb2.SynthesizeRequest(leader=leader)
        request.label_vector.weights.add(interaction_class="punch", weight=1)
        return request

    def test_lists_models(self):
        models = self.stub.ListModels(synthesis_pb2.ListModelsRequest(),
                                      timeout=tools.RUN_SECONDS).models
        self.assertEqual([(model.name, model.is_default) for model in models],
                         [("everyday", False), ("k3hi", False), ("salsa", False), ("sbu", True),
                          ("sbu", False)])
        self.assertEqual(set(models[3].interaction_classes), set(tools.CLASSES))
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
        details = stubs.details_of(caught.exception)
        violations = details["BadRequest"].field_violations
        fields = {violation.field for violation in violations}
        self.assertLessEqual({"leader.frame_rate_hz", "leader.positions[5]"}, fields)
        self.assertTrue(any(field.startswith("label_vector.weights[1]") for field in fields), fields)
        for violation in violations:
            self.assertRegex(violation.description, "^expected .*, got ")
        self.assertEqual((details["ErrorInfo"].domain, details["ErrorInfo"].reason), ("duet.v1", "INVALID_REQUEST"))

    def test_an_unknown_model_is_not_found(self):
        request = synthesis_pb2.GetModelRequest()
        request.model.name = "nobody"
        with self.assertRaises(grpc.RpcError) as caught:
            self.stub.GetModel(request, timeout=tools.RUN_SECONDS)
        self.assertEqual(caught.exception.code(), grpc.StatusCode.NOT_FOUND)


if __name__ == "__main__":
    tools.main()
