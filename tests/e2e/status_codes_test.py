"""Every status code that a caller may see, over the wire from a server process to a client that shares no
code with ours; and an engine that is slow, throws or answers nonsense, which fails no neighbour."""

import hashlib
import pathlib
import tempfile
import threading
import unittest

import tools
from stubs import grpc, motion_pb2, synthesis_pb2, synthesis_pb2_grpc

FAKE_SERVER = tools.PROGRAMS.parent / "tests" / "duet-fake-server"
FRAMES = 20  # less than a window
DRAINING = "the server is shutting down"


class StatusCodesTest(unittest.TestCase):
    def serve(self, *flags):
        server = tools.Server(*flags, metrics="127.0.0.1:0", program=FAKE_SERVER)
        self.addCleanup(server.stop)
        channel = grpc.insecure_channel(server.address)
        self.addCleanup(channel.close)
        self.stub = synthesis_pb2_grpc.MotionSynthesisStub(channel)
        self.channel = channel
        return server

    def request(self, interaction_class="punch", weight=1):
        """A leader who stands still; a weight of -1 is what the fake engine fails at."""
        leader = motion_pb2.Motion(
            joint_names=tools.JOINTS, frame_rate_hz=15, unit=motion_pb2.LENGTH_UNIT_METRES,
            up_axis=motion_pb2.UP_AXIS_Y_UP, frame_count=FRAMES,
            positions=[0.1 * (i % 45) for i in range(FRAMES * 45)])
        request = synthesis_pb2.SynthesizeRequest(leader=leader)
        request.label_vector.weights.add(interaction_class=interaction_class, weight=weight)
        return request

    def end_of(self, call):
        """How a call ends: its code and its message."""
        try:
            list(call)
        except grpc.RpcError as error:
            return error.code().name, error.details()
        return "OK", ""

    def code_of(self, call):
        return self.end_of(call)[0]

    def synthesize(self, request, **options):
        return self.stub.Synthesize(request, timeout=tools.RUN_SECONDS, **options)

    def slow_call(self, server):
        """A call that the engine has begun with, and goes on with until somebody ends it."""
        before = server.figure(r'duet_calls_in_flight\{method="Synthesize"\}')
        call = self.synthesize(self.request("shake_hands", -1))
        next(call)  # the header; the window is in line or with the engine
        tools.wait_until(lambda: server.figure(r'duet_calls_in_flight\{method="Synthesize"\}')
                         == before + 1 and server.figure("duet_queued_windows") == 0,
                         "the engine has the window")
        self.addCleanup(call.cancel)
        return call

    def ended(self, server, count):
        """The codes of the calls that are over, once there are so many."""
        tools.wait_until(lambda: len(server.events("call")) >= count, f"{count} calls are logged")
        return [entry["code"] for entry in server.events("call")]

    def test_codes_of_requests(self):
        self.serve()

        def of_changed(change):
            request = self.request()
            change(request)
            return self.end_of(self.synthesize(request))
        self.assertEqual(of_changed(lambda _: None), ("OK", ""))
        code, message = of_changed(lambda request: setattr(request.leader, "frame_rate_hz", -1))
        self.assertEqual(code, "INVALID_ARGUMENT")
        self.assertIn("leader.frame_rate_hz: expected 1 to 240 frames per second, got -1", message)
        self.assertEqual(of_changed(lambda request: request.leader.joint_names.__setitem__(0, "tail"))[0],
                         "FAILED_PRECONDITION")
        self.assertEqual(of_changed(lambda request: setattr(request.model, "name", "nobody"))[0], "NOT_FOUND")
        dance = self.channel.unary_unary("/duet.v1.MotionSynthesis/Dance")
        with self.assertRaises(grpc.RpcError) as caught:
            dance(b"", timeout=tools.RUN_SECONDS)
        self.assertEqual(caught.exception.code(), grpc.StatusCode.UNIMPLEMENTED)

    def test_unauthenticated_and_permission_denied(self):
        with tempfile.TemporaryDirectory() as folder:
            access = pathlib.Path(folder) / "access"
            digest = hashlib.sha256(b"secret").hexdigest()
            access.write_text(f"ops admin sha256:{digest}\n", encoding="utf-8")
            self.serve("--access-file", access)
            self.assertEqual(self.code_of(self.synthesize(self.request())), "UNAUTHENTICATED")
            token = (("authorization", "Bearer secret"),)
            self.assertEqual(self.code_of(self.synthesize(self.request(), metadata=token)),
                             "PERMISSION_DENIED")

    def test_resource_exhausted(self):
        server = self.serve("--max-calls", "1")
        self.slow_call(server)
        self.assertEqual(self.code_of(self.synthesize(self.request())), "RESOURCE_EXHAUSTED")

    def test_probes_do_not_wait_for_the_queue(self):
        server = self.serve("--workers", "1")
        self.slow_call(server)
        calls = [self.synthesize(self.request()) for _ in range(5)]
        tools.wait_until(lambda: server.figure("duet_queued_windows") == len(calls),
                         "the one worker is busy and all others wait")
        for path in ("/healthz", "/readyz"):
            self.assertEqual(server.page(path)[0], 200)
        health = self.channel.unary_unary("/grpc.health.v1.Health/Check")
        self.assertEqual(health(b"", timeout=tools.RUN_SECONDS), b"\x08\x01")  # SERVING
        self.assertEqual(server.figure("duet_queued_windows"), len(calls))
        for call in calls:
            call.cancel()

    def test_deadline_exceeded(self):
        # The server's own, so that nobody but the server says so, and in its words.
        server = self.serve("--max-call-seconds", "1")
        code, message = self.end_of(self.synthesize(self.request("shake_hands", -1)))
        self.assertEqual(code, "DEADLINE_EXCEEDED")
        self.assertIn("longer than the server answers any call", message)
        self.assertEqual(self.ended(server, 1), ["DEADLINE_EXCEEDED"])

    def test_cancelled(self):
        server = self.serve()
        call = self.slow_call(server)
        call.cancel()
        self.assertEqual(self.code_of(call), "CANCELLED")
        self.assertEqual(self.ended(server, 1), ["CANCELLED"])

    def test_unavailable(self):
        server = self.serve("--grace-seconds", str(tools.RUN_SECONDS))
        call = self.slow_call(server)
        stopping = threading.Thread(target=server.stop)
        stopping.start()
        self.addCleanup(stopping.join)
        # It says that it drains a moment before it does.
        tools.wait_until(lambda: server.events("draining"), "it drains")
        tools.wait_until(lambda: self.end_of(self.synthesize(self.request()))
                         == ("UNAVAILABLE", DRAINING), "new calls are refused")
        call.cancel()  # whoever is being answered keeps the server

    def test_engine_failure_fails_only_its_call(self):
        """One batch of a good window, three that fail in their ways, and a good one."""
        server = self.serve("--workers", "1", "--max-batch-windows", "8")
        slow = self.slow_call(server)
        calls = [self.synthesize(self.request(interaction_class, weight))
                 for interaction_class, weight in (("punch", 1), ("kick", -1), ("push", -1),
                                                   ("hug", -1), ("punch", 0.5))]
        tools.wait_until(lambda: server.figure("duet_queued_windows") == len(calls),
                         "all wait for the one worker")
        slow.cancel()
        self.assertEqual([self.code_of(call) for call in calls],
                         ["OK", "INTERNAL", "INTERNAL", "INTERNAL", "OK"])
        # The slow one and theirs.
        self.assertEqual(server.figure("duet_batch_size_count"), 2)
        self.assertEqual(server.figure("duet_batch_size_sum"), 1 + len(calls))


if __name__ == "__main__":
    if not FAKE_SERVER.exists():
        tools.skip("duet-fake-server is not built")
    tools.main()
