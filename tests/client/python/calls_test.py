"""Calls of the blocking and the asyncio client against a scripted server."""

import asyncio
import concurrent.futures
import socket
import threading
import unittest

import support
import duet_motion as duet
from duet_motion._live_call import LiveCall
import duet_motion.aio
import grpc
import numpy as np
from support import Failure, Script
from duet_motion.v1 import synthesis_pb2

UNAVAILABLE = grpc.StatusCode.UNAVAILABLE


class Waiting:
    """Runs calls on duet.Client."""

    def run_calls(self, address, calls, **options):
        with duet.Client(address, **options) as client:
            return calls(client, lambda answer: answer, list)


class Awaiting:
    """Runs the same calls on duet.aio.Client."""

    # One loop for all tests, never closed, because gRPC's poller may still use it.
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
        options = {"retry": support.QUICK, "timeout": support.LONGEST_CALL,
                   "wait": support.LONGEST_CALL, **options}
        with support.serving(script) as address:
            return self.run_calls(address, calls, **options)

    def synthesize(self, *streams, request=None, **options):
        script = Script(*streams)
        fields = request or {}
        result = self.calls(script, lambda client, get, _: get(
            client.synthesize(self.leader, {"hug": 1}, **fields)), **options)
        return result, script

    def test_synthesize_returns_the_whole_follower(self):
        result, script = self.synthesize(support.good_reply(self.leader),
                                         request={"seed": 3, "request_id": "mine"})
        np.testing.assert_array_equal(result.follower.positions, support.follower_of(self.leader))
        self.assertEqual(result.follower.joint_names, self.leader.joint_names)
        self.assertIs(result.leader, self.leader)
        self.assertEqual(result.attempt_count, 1)
        self.assertLessEqual(result.timings.first_chunk, result.timings.total)
        self.assertEqual(script.requests[0].seed, 3)
        self.assertEqual(script.metadata[0]["x-request-id"], "mine")

    def test_stream_yields_chunks_as_they_arrive(self):
        arrived = []

        def calls(client, get, gather):
            stream = client.stream(self.leader, {"hug": 1})
            arrived.extend(gather(stream))
            return get(stream.result())
        result = self.calls(Script(support.good_reply(self.leader)), calls)
        self.assertEqual([chunk.first_frame for chunk in arrived], [0, 2, 4])
        np.testing.assert_array_equal(np.concatenate([c.positions for c in arrived]),
                                      result.follower.positions)

    def test_broken_stream_is_retried_on_the_same_version(self):
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

    def test_retry_fails_if_the_version_is_gone(self):
        reply = support.good_reply(self.leader)
        with self.assertRaisesRegex(duet.DuetError, "after 4 frames and cannot be resumed: m@1"):
            self.synthesize([*reply[:3], Failure(UNAVAILABLE)],
                            [Failure(grpc.StatusCode.NOT_FOUND)])

    def test_unreachable_server_is_reported_with_its_address(self):
        with socket.socket() as unused:  # bound, but nobody listens
            unused.bind(("127.0.0.1", 0))
            address = "127.0.0.1:%d" % unused.getsockname()[1]
            for call in (lambda client: client.list_models(), lambda client: client.get_model(),
                         lambda client: client.synthesize(self.leader, {"hug": 1})):
                with self.assertRaisesRegex(
                        duet.UnavailableError,
                        f"^UNAVAILABLE: the server at {address} is not running: it refused the "
                        r"connection \(\d+ attempts? in [\d.]+ s\); start it with duet-server"):
                    self.run_calls(address, lambda client, get, _: get(call(client)), wait=0.05,
                                   timeout=support.LONGEST_CALL)

    def test_attempts_are_counted_and_limited(self):
        away = [Failure(UNAVAILABLE, "away")]
        with self.assertRaisesRegex(duet.UnavailableError, r"away \(after 4 attempts\)"):
            self.synthesize(*[away] * 5)
        result, _ = self.synthesize(away, away, support.good_reply(self.leader))
        self.assertEqual(result.attempt_count, 3)

    def test_full_server_is_retried_after_its_delay(self):
        full = [Failure(grpc.StatusCode.RESOURCE_EXHAUSTED, "full", support.retry_info(0.001))]
        for priority in ("interactive", "bulk"):
            result, _ = self.synthesize(full, support.good_reply(self.leader),
                                        request={"priority": priority})
            self.assertEqual(result.attempt_count, 2)
        with self.assertRaisesRegex(duet.ServerBusyError, "full$"):
            self.synthesize(full, retry=duet.RetryOptions(max_attempts=1))

    def test_timeout_of_a_call_overrides_the_clients(self):
        for options in ({"request": {"timeout": 0.1}}, {"timeout": 0.1}):
            go_on = threading.Event()
            with self.assertRaises(duet.DeadlineError) as caught:
                self.synthesize(support.held_reply(self.leader, go_on, go_on), **options)
            self.assertIsInstance(caught.exception, TimeoutError)
        for name in ("list_models", "get_model"):
            with self.assertRaises(duet.DeadlineError):
                self.calls(support.Holding(), lambda client, get, _: get(
                    getattr(client, name)(timeout=0.1)))
            with self.assertRaisesRegex(ValueError, "timeout: expected a finite number above 0"):
                self.calls(Script(), lambda client, get, _: get(getattr(client, name)(timeout=0)))

    def test_malformed_reply_is_not_retried(self):
        with self.assertRaisesRegex(duet.MalformedReplyError, "without a payload"):
            self.synthesize([synthesis_pb2.SynthesizeResponse()])

    def test_models_are_listed_and_described(self):
        model = {"name": "m", "version": 2, "joint_names": ["a", "b"],
                 "bones": [{"parent_joint": 0, "child_joint": 1}], "samples": True,
                 "free_for_all_uses": True}
        script = Script(
            Failure(UNAVAILABLE),
            synthesis_pb2.ListModelsResponse(models=[model]),
            synthesis_pb2.GetModelResponse(model=model, limits={"max_label_keyframes": 5}))
        models, details = self.calls(script, lambda client, get, _: (
            get(client.list_models()), get(client.get_model("m@2"))))
        self.assertEqual([(m.name, m.version, m.bones) for m in models], [("m", 2, ((0, 1),))])
        self.assertTrue(details.model.samples)
        self.assertTrue(details.model.free_for_all_uses)
        self.assertEqual(details.limits.max_keyframes, 5)
        self.assertEqual(script.requests[2].model.version, 2)

    def test_token_and_authority_are_sent(self):
        asked = []
        # gRPC for Python exposes the authority only here.
        _, script = self.synthesize([lambda context: asked.append(context._rpc_event.call_details.host),
                                     *support.good_reply(self.leader)], token="secret", authority="localhost")
        self.assertEqual(script.metadata[0]["authorization"], "Bearer secret")
        self.assertEqual(asked, [b"localhost"])

    def test_invalid_options_are_rejected(self):
        for options, message in (({"address": ""}, "address: expected host:port, got an empty"),
                                 ({"timeout": 0}, "timeout: expected a finite number above 0, got 0"),
                                 ({"address": "far:1", "token": "x"}, "expected tls, got plain text to far:1"),
                                 ({"address": "127.evil.test:1", "token": "x"}, "plain text to 127"),
                                 ({"address": "localhost.test:1", "token": "x"}, "plain text to"),
                                 ({"address": "ipv4:127.0.0.1:1,8.8.8.8:1", "token": "x"}, "plain"),
                                 ({"token": "a b"}, "^token: expected printable ASCII"),
                                 ({"wait": -1}, "wait: expected a number of seconds, 0 or more, got -1"),
                                 ({"max_concurrent_calls": 0}, "max_concurrent_calls: expected 1 or"),
                                 ({"token": "a\n"}, "^token: expected printable ASCII")):
            with self.subTest(options=options), self.assertRaisesRegex(ValueError, message):
                duet.Client(**options)
        for address in ("localhost:1", "127.0.0.1:1", "[::1]:1", "dns:///localhost:1", "unix:/x",
                        "ipv4:127.0.0.1:1"):
            duet.Client(address, token="x").close()

    def test_anything_but_a_request_is_a_type_error(self):
        fields = {"leader": support.leader(), "labels": {"hug": 1}}
        with self.assertRaisesRegex(TypeError, "^request: expected a duet_motion.SynthesisRequest, got "
                                               "dict"):
            self.calls(Script(), lambda client, get, _: get(client.synthesize_request(fields)))
        with self.assertRaisesRegex(TypeError, "^request: expected a duet_motion.LiveRequest, got dict"):
            LiveCall({"leader": None}, None)


class WaitingTest(Calls, Waiting, unittest.TestCase):
    def test_threads_wait_for_their_turn(self):
        together = support.Together(4)

        def calls(client, *_):
            with concurrent.futures.ThreadPoolExecutor(20) as pool:
                return list(pool.map(
                    lambda seed: client.synthesize(support.leader(), {"hug": 1}, seed=seed).seed,
                    range(10, 40)))
        self.assertEqual(self.calls(together, calls, max_concurrent_calls=4), list(range(10, 40)))
        self.assertEqual(together.most, 4)

    def test_call_without_a_turn_times_out(self):
        begun, go_on = threading.Event(), threading.Event()
        held = [lambda _: begun.set(), *support.held_reply(self.leader, threading.Event(), go_on)[:3],
                lambda _: go_on.wait(support.LONGEST_CALL)]
        script = Script(held, support.good_reply(self.leader))

        def calls(client, *_):
            first = threading.Thread(target=lambda: self.assertRaises(
                duet.UnavailableError, client.synthesize, self.leader, {"hug": 1}))
            first.start()
            self.assertTrue(begun.wait(support.LONGEST_CALL))
            with self.assertRaisesRegex(duet.DeadlineError, "max_concurrent_calls=1 calls"):
                client.synthesize(self.leader, {"hug": 1}, timeout=0.05)
            go_on.set()
            first.join()
            client.synthesize(self.leader, {"hug": 1})
        self.calls(script, calls, max_concurrent_calls=1, retry=duet.RetryOptions(max_attempts=1))

    def test_leaving_the_stream_cancels_it(self):
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
    def test_gathered_calls_wait_for_their_turn(self):
        together = support.Together(4)

        async def ask(client):
            return await asyncio.gather(*(client.synthesize(support.leader(), {"hug": 1}, seed=seed)
                                          for seed in range(10, 40)))
        results = self.calls(together, lambda client, get, _: get(ask(client)),
                             max_concurrent_calls=4)
        self.assertEqual([result.seed for result in results], list(range(10, 40)))
        self.assertEqual(together.most, 4)

    def test_call_without_a_turn_times_out(self):
        begun, go_on = threading.Event(), threading.Event()
        script = Script([lambda _: begun.set(), *support.held_reply(self.leader, go_on, go_on)],
                        support.good_reply(self.leader))

        async def ask(client):
            first = asyncio.ensure_future(client.synthesize(self.leader, {"hug": 1}))
            # Otherwise, a later call may get the first reply.
            await self.loop.run_in_executor(None, begun.wait, support.LONGEST_CALL)
            with self.assertRaisesRegex(duet.DeadlineError, "max_concurrent_calls=1 calls"):
                await client.synthesize(self.leader, {"hug": 1}, timeout=0.05)
            waiting = asyncio.ensure_future(client.synthesize(self.leader, {"hug": 1}))
            await asyncio.sleep(0)
            waiting.cancel()
            first.cancel()
            await asyncio.wait({first, waiting})
            go_on.set()
            # Both returned their turn.
            return await client.synthesize(self.leader, {"hug": 1})
        self.assertEqual(self.calls(script, lambda client, get, _: get(ask(client)),
                                    max_concurrent_calls=1).attempt_count, 1)

    def test_stream_is_cancelled_during_its_backoff(self):
        told = []
        retry = duet.RetryOptions(initial_backoff=1000, max_backoff=1000,
                                  on_wait=lambda *_: told.append(stream.cancel()))
        stream = None

        async def call(client):
            nonlocal stream
            stream = client.stream(self.leader, {"hug": 1})
            with self.assertRaisesRegex(duet.CancelledError, "the call was cancelled"):
                await stream.result()
        self.calls(Script([Failure(UNAVAILABLE)]), lambda client, get, _: get(call(client)),
                   retry=retry, timeout=10_000, wait=10_000)
        self.assertEqual(told, [None])

    def test_calls_on_a_closed_client_are_cancelled(self):
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
