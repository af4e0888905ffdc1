"""Both clients, waiting and asynchronous, against a server that answers as a test says."""

import asyncio
import threading
import unittest

import support
import duet
import duet.aio
import grpc
import numpy as np
from support import Failure, Script
from duet.v1 import synthesis_pb2

UNAVAILABLE = grpc.StatusCode.UNAVAILABLE


class Waiting:
    """Calls of duet.Client."""

    def run_calls(self, address, calls, **options):
        with duet.Client(address, **options) as client:
            return calls(client, lambda answer: answer, list)


class Awaiting:
    """The same calls of duet.aio.Client."""

    # One for all tests, and never closed: gRPC's poller may have a last word for it.
    loop = asyncio.new_event_loop()

    def run_calls(self, address, calls, **options):

        async def make():
            return duet.aio.Client(address, **options)

        async def gather(stream):
            return [item async for item in stream]

        def get(answer):
            return self.loop.run_until_complete(answer)

        client = get(make())
        try:
            return calls(client, get, lambda stream: get(gather(stream)))
        finally:
            get(client.close())


class Calls:
    def setUp(self):
        self.leader = support.leader()

    def calls(self, script, calls, **options):
        options = {"retry": support.QUICK, "timeout": support.LONGEST_CALL, **options}
        with support.serving(script) as address:
            return self.run_calls(address, calls, **options)

    def synthesize(self, *streams, request=None, **options):
        script = Script(*streams)
        fields = request or {}
        result = self.calls(script, lambda client, get, _: get(
            client.synthesize(self.leader, {"hug": 1}, **fields)), **options)
        return result, script

    def test_a_follower_comes_whole(self):
        result, script = self.synthesize(support.good_reply(self.leader),
                                         request={"seed": 3, "request_id": "mine"})
        np.testing.assert_array_equal(result.follower.positions, support.follower_of(self.leader))
        self.assertEqual(result.follower.joint_names, self.leader.joint_names)
        self.assertIs(result.leader, self.leader)
        self.assertEqual(result.attempt_count, 1)
        self.assertLessEqual(result.timings.first_chunk, result.timings.total)
        self.assertEqual(script.requests[0].seed, 3)
        self.assertEqual(script.metadata[0]["x-request-id"], "mine")

    def test_chunks_come_as_they_arrive(self):
        arrived = []

        def calls(client, get, gather):
            stream = client.stream(self.leader, {"hug": 1})
            arrived.extend(gather(stream))
            return get(stream.result())
        result = self.calls(Script(support.good_reply(self.leader)), calls)
        self.assertEqual([chunk.first_frame for chunk in arrived], [0, 2, 4])
        np.testing.assert_array_equal(np.concatenate([c.positions for c in arrived]),
                                      result.follower.positions)

    def test_a_broken_stream_is_run_again_on_the_same_version(self):
        reply = support.good_reply(self.leader, model_version=7)
        arrived = []

        def calls(client, get, gather):
            stream = client.stream(self.leader, {"hug": 1})
            arrived.extend(gather(stream))
            return get(stream.result())
        script = Script([*reply[:3], Failure(UNAVAILABLE)], reply)
        result = self.calls(script, calls)
        self.assertEqual([chunk.first_frame for chunk in arrived], [0, 2, 4])
        self.assertEqual(result.attempt_count, 2)
        self.assertEqual(script.requests[0].model.WhichOneof("version_choice"), None)
        self.assertEqual((script.requests[1].model.name, script.requests[1].model.version),
                         ("m", 7))

    def test_a_version_that_is_gone_ends_a_resumed_call(self):
        reply = support.good_reply(self.leader)
        with self.assertRaisesRegex(duet.DuetError, "after 4 frames and cannot be resumed: m@1"):
            self.synthesize([*reply[:3], Failure(UNAVAILABLE)],
                            [Failure(grpc.StatusCode.NOT_FOUND)])

    def test_attempts_are_counted_and_end(self):
        away = [Failure(UNAVAILABLE, "away")]
        with self.assertRaisesRegex(duet.UnavailableError, r"away \(after 4 attempts\)"):
            self.synthesize(*[away] * 5)
        result, _ = self.synthesize(away, away, support.good_reply(self.leader))
        self.assertEqual(result.attempt_count, 3)

    def test_bulk_work_waits_for_a_full_server(self):
        full = [Failure(grpc.StatusCode.RESOURCE_EXHAUSTED, "full", support.retry_info(0.001))]
        with self.assertRaisesRegex(duet.ServerBusyError, "full$"):
            self.synthesize(full, support.good_reply(self.leader))
        result, _ = self.synthesize(full, support.good_reply(self.leader),
                                    request={"priority": "bulk"})
        self.assertEqual(result.attempt_count, 2)

    def test_a_call_ends_at_its_deadline(self):
        go_on = threading.Event()
        held = support.held_reply(self.leader, go_on, go_on)
        with self.assertRaises(duet.DeadlineError) as caught:
            self.synthesize(held, timeout=0.1)
        self.assertIsInstance(caught.exception, TimeoutError)

    def test_a_malformed_reply_is_not_asked_for_again(self):
        with self.assertRaisesRegex(duet.MalformedReplyError, "without a payload"):
            self.synthesize([synthesis_pb2.SynthesizeResponse()])

    def test_models_are_listed_and_described(self):
        model = {"name": "m", "version": 2, "joint_names": ["a", "b"],
                 "bones": [{"parent_joint": 0, "child_joint": 1}], "samples": True}
        script = Script(
            Failure(UNAVAILABLE),
            synthesis_pb2.ListModelsResponse(models=[model]),
            synthesis_pb2.GetModelResponse(model=model, limits={"max_label_keyframes": 5}))
        models, details = self.calls(script, lambda client, get, _: (
            get(client.list_models()), get(client.get_model("m@2"))))
        self.assertEqual([(m.name, m.version, m.bones) for m in models], [("m", 2, ((0, 1),))])
        self.assertTrue(details.model.samples)
        self.assertEqual(details.limits.max_keyframes, 5)
        self.assertEqual(script.requests[2].model.version, 2)

    def test_a_bone_without_its_joint_is_refused(self):
        model = {"name": "m", "bones": [{"parent_joint": 0, "child_joint": 1}]}
        with self.assertRaisesRegex(duet.MalformedReplyError, "a bone from joint 0 to 1"):
            self.calls(Script(synthesis_pb2.ListModelsResponse(models=[model])),
                       lambda client, get, _: get(client.list_models()))

    def test_the_token_goes_along(self):
        _, script = self.synthesize(support.good_reply(self.leader), token="secret")
        self.assertEqual(script.metadata[0]["authorization"], "Bearer secret")

    def test_the_authority_is_what_calls_are_for(self):
        asked = []
        # gRPC for Python tells it nowhere else.
        script = Script([lambda context: asked.append(context._rpc_event.call_details.host),
                         *support.good_reply(self.leader)])
        self.calls(script, lambda client, get, _: get(client.synthesize(self.leader, {"hug": 1})),
                   authority="duet.test")
        self.assertEqual(asked, [b"duet.test"])

    def test_options_that_make_no_sense_are_refused(self):
        for options, message in (({"address": ""}, "address: empty"),
                                 ({"timeout": 0}, "timeout: 0, wanted more than 0"),
                                 ({"address": "far:1", "token": "x"}, "plain text to far:1, wanted tls"),
                                 ({"address": "127.evil.test:1", "token": "x"}, "plain text to 127"),
                                 ({"address": "localhost.test:1", "token": "x"}, "plain text to"),
                                 ({"address": "ipv4:127.0.0.1:1,8.8.8.8:1", "token": "x"}, "plain"),
                                 ({"token": "a b"}, "^token: has a blank"),
                                 ({"token": "a\n"}, "^token: has a blank")):
            with self.subTest(options=options), self.assertRaisesRegex(ValueError, message):
                duet.Client(**options)
        for address in ("localhost:1", "127.0.0.1:1", "[::1]:1", "dns:///localhost:1", "unix:/x",
                        "ipv4:127.0.0.1:1"):
            duet.Client(address, token="x").close()

    def test_many_requests_have_their_outcomes_in_order(self):
        together = support.Together(4)
        requests = [duet.SynthesisRequest(support.leader(), {"hug": 1}, seed=seed)
                    for seed in range(9)]

        def calls(client, _, gather):
            return gather(client.synthesize_many(iter(requests), concurrency=4))
        outcomes = self.calls(together, calls)
        self.assertEqual([outcome.request.seed for outcome in outcomes], list(range(9)))
        self.assertEqual(together.most, 4)
        self.assertEqual([outcome.error is None for outcome in outcomes],
                         [seed != 3 for seed in range(9)])
        self.assertEqual(outcomes[4].unwrap().seed, 4)
        with self.assertRaises(duet.InvalidRequestError):
            outcomes[3].unwrap()

    def test_concurrency_is_at_least_one(self):
        with self.assertRaisesRegex(ValueError, "concurrency: 0, wanted 1 or more"):
            self.calls(Script(), lambda client, get, _: client.synthesize_many([], concurrency=0))


class WaitingTest(Calls, Waiting, unittest.TestCase):
    def test_a_stream_is_cancelled_by_leaving_it(self):
        ended, go_on = threading.Event(), threading.Event()
        script = Script(support.held_reply(self.leader, ended, go_on))

        def calls(client, *_):
            with client.stream(self.leader, {"hug": 1}) as stream:
                next(stream)
            self.assertTrue(ended.wait(support.LONGEST_CALL))
            go_on.set()
            with self.assertRaises(duet.CancelledError):
                stream.result()
        self.calls(script, calls)
        self.assertEqual(len(script.requests), 1)

    def test_a_stream_is_cancelled_by_another_thread(self):
        go_on = threading.Event()
        script = Script(support.held_reply(self.leader, threading.Event(), go_on))

        def calls(client, *_):
            stream = client.stream(self.leader, {"hug": 1})
            next(stream)
            canceller = threading.Thread(target=stream.cancel)
            canceller.start()
            with self.assertRaises(duet.CancelledError):
                next(stream)
            canceller.join()
            go_on.set()
        self.calls(script, calls)
        self.assertEqual(len(script.requests), 1)


    def test_closing_the_client_ends_its_calls(self):
        go_on = threading.Event()
        script = Script(support.held_reply(self.leader, threading.Event(), go_on))

        def calls(client, *_):
            stream = client.stream(self.leader, {"hug": 1})
            next(stream)
            client.close()
            with self.assertRaisesRegex(duet.CancelledError, "the client was closed"):
                next(stream)
            with self.assertRaisesRegex(duet.CancelledError, "the client was closed"):
                client.list_models()
            go_on.set()
        self.calls(script, calls)


class AwaitingTest(Calls, Awaiting, unittest.TestCase):
    def test_a_closed_client_answers_no_more(self):
        def calls(client, get, gather):
            get(client.close())
            with self.assertRaisesRegex(duet.CancelledError, "the client was closed"):
                get(client.list_models())
            with self.assertRaisesRegex(duet.CancelledError, "the client was closed"):
                gather(client.stream(self.leader, {"hug": 1}))
        self.calls(Script(), calls)

    def test_cancelling_the_task_ends_the_call(self):
        ended, go_on = threading.Event(), threading.Event()
        script = Script(support.held_reply(self.leader, ended, go_on))

        async def call(client):
            async with client.stream(self.leader, {"hug": 1}) as stream:
                await stream.__anext__()
                task = asyncio.ensure_future(stream.result())
                await asyncio.sleep(0)
                task.cancel()
                with self.assertRaises(asyncio.CancelledError):
                    await task
            self.assertTrue(await self.loop.run_in_executor(None, ended.wait,
                                                            support.LONGEST_CALL))
            go_on.set()
        self.calls(script, lambda client, get, _: get(call(client)))
        self.assertEqual(len(script.requests), 1)


if __name__ == "__main__":
    unittest.main()
