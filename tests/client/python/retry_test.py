"""Retries, by the rules of the C++ client (tests/client/retry_test.cc)."""

import dataclasses
import pathlib
import re
import unittest

import support  # noqa: F401
import duet_motion as duet
import grpc
from duet_motion._call import Attempts, CallSettings, Environment
from duet_motion.errors import make_error
from duet_motion.retry import describe_unreachable, retry_wait

UNAVAILABLE = grpc.StatusCode.UNAVAILABLE


class RetryTest(unittest.TestCase):

    def test_causes_of_gone_servers_are_named_as_by_the_other_client(self):
        source = (pathlib.Path(__file__).parents[3] / "client/internal/retry.cc").read_text(
            encoding="utf-8")
        causes = re.findall(r'^    {"(.+)", "(.+)"},$', source, re.MULTILINE)
        self.assertGreater(len(causes), 9)
        for sign, text in causes:
            self.assertEqual(describe_unreachable("a:1", f"failed: {sign}"), f"the server at a:1 {text}")
        self.assertEqual(describe_unreachable("a:1", "odd"), "the server at a:1 cannot be reached: odd")

    def test_backoff_doubles_up_to_its_maximum(self):
        error, options = make_error(UNAVAILABLE, ""), duet.RetryOptions(max_backoff=1)
        waits = [retry_wait(options, attempt, error, 1.0) for attempt in range(1, 7)]
        for wait, wanted in zip(waits, (0.1, 0.2, 0.4, 0.8, 1.0, 1.0)):
            self.assertAlmostEqual(wait, wanted)
        self.assertAlmostEqual(retry_wait(options, 1, error, 0.0), 0.05)
        self.assertAlmostEqual(retry_wait(options, 10**6, error, 1.0), 1.0)

    def test_servers_delay_is_the_minimum_wait_with_jitter(self):
        options = duet.RetryOptions()
        asked = make_error(UNAVAILABLE, "", retry_delay=5.0)
        self.assertAlmostEqual(retry_wait(options, 1, asked, 0.0), 5.0)
        self.assertAlmostEqual(retry_wait(options, 1, asked, 1.0), 5.05)
        sooner = make_error(UNAVAILABLE, "", retry_delay=0.01)
        self.assertAlmostEqual(retry_wait(options, 1, sooner, 1.0), 0.1)


class AttemptsTest(unittest.TestCase):
    def setUp(self):
        self.now = 100.0
        environment = Environment(now=lambda: self.now, uniform=lambda: 1.0)
        self.waits = []
        self.retry = duet.RetryOptions(
            max_attempts=4, on_wait=lambda error, wait: self.waits.append((error.message, wait)))
        self.settings = CallSettings(10.0, self.retry, environment=environment, wait=60.0,
                                     address="lab:50051")
        self.attempts = Attempts(self.settings)

    def fail(self, error, **settings):
        """Makes attempts that fail with the error until there is no further one."""
        self.attempts = Attempts(dataclasses.replace(
            self.settings, retry=duet.RetryOptions(), **settings))
        while True:
            self.attempts.begin()
            self.now += self.attempts.wait_after(error)

    def test_responding_server_is_retried_until_the_deadline(self):
        with self.assertRaisesRegex(duet.UnavailableError, "loading .*the deadline leaves no time"):
            self.fail(make_error(UNAVAILABLE, "loading", reason="LOADING"), wait=1.0)
        # 0.1 + 0.2 + ... + 3.2 s, and 5 s more would be too long.
        self.assertEqual(self.attempts.made, 7)

    def test_unreachable_server_is_retried_for_wait_seconds(self):
        start = self.now
        with self.assertRaisesRegex(
                duet.UnavailableError,
                r"^UNAVAILABLE: the server at lab:50051 is not running: it refused the connection "
                r"\(7 attempts in 5.0 s\); "
                r"start .*DUET_SERVER.*wait=SECONDS"):
            self.fail(make_error(UNAVAILABLE, "failed to connect to all addresses; last error: UNKNOWN: "
                                 "ipv4:10.0.0.1:50051: Failed to connect to remote host: Connection "
                                 "refused"), wait=5.0)
        self.assertAlmostEqual(self.now - start, 5)
        with self.assertRaisesRegex(duet.UnavailableError, r"\(1 attempt in 0.0 s\)"):
            self.fail(make_error(UNAVAILABLE, "Connection refused"), wait=0.0)
        with self.assertRaisesRegex(duet.UnavailableError, "at lab:50051 is not running: .* .7 attempts"):
            self.fail(make_error(UNAVAILABLE, "Connection refused"), wait=60.0)  # the deadline comes first

    def test_partial_reply_restarts_the_wait(self):
        attempts = Attempts(dataclasses.replace(self.settings, retry=duet.RetryOptions(), wait=1.0))
        for answered in (False, True, False):
            attempts.begin()
            self.now += 0.9 + attempts.wait_after(make_error(UNAVAILABLE, "away"), answered)
        attempts.begin()
        with self.assertRaisesRegex(duet.UnavailableError, "the server at lab:50051 cannot"):
            attempts.wait_after(make_error(UNAVAILABLE, "away"))


if __name__ == "__main__":
    unittest.main()
