"""Conversion of gRPC errors."""

import unittest

import support
import duet_motion as duet
import grpc
from duet_motion.errors import from_rpc_error, make_error
from duet_motion.rpc.v1 import status_pb2


class Refusal(grpc.RpcError):
    def __init__(self, code, message, metadata=()):
        super().__init__()
        self.code = lambda: code
        self.details = lambda: message
        self.trailing_metadata = lambda: metadata


class ErrorsTest(unittest.TestCase):
    def test_error_has_every_violation(self):
        error = from_rpc_error(Refusal(
            grpc.StatusCode.INVALID_ARGUMENT, "two fields",
            support.details(support.bad_request(("leader.unit", "0, expected 1"), ("", "and more")),
                            status_pb2.ErrorInfo(reason="INVALID_REQUEST"))))
        self.assertIsInstance(error, duet.InvalidRequestError)
        self.assertIsInstance(error, ValueError)
        self.assertEqual(error.violations, (duet.FieldViolation("leader.unit", "0, expected 1"),
                                            duet.FieldViolation("", "and more")))
        self.assertEqual(error.reason, "INVALID_REQUEST")
        self.assertEqual(str(error),
                         "INVALID_ARGUMENT: two fields: leader.unit: 0, expected 1; and more")
        self.assertTrue(error.is_permanent)

    def test_retry_delay_is_read(self):
        code = grpc.StatusCode.RESOURCE_EXHAUSTED
        full = from_rpc_error(Refusal(code, "full", support.details(support.retry_info(1.5))))
        self.assertIsInstance(full, duet.ServerBusyError)
        self.assertEqual(full.retry_delay, 1.5)
        self.assertFalse(full.is_permanent)
        large = from_rpc_error(Refusal(code, "too large"))
        self.assertIsNone(large.retry_delay)
        self.assertTrue(large.is_permanent)
        past = from_rpc_error(Refusal(code, "full", support.details(support.retry_info(-1))))
        self.assertEqual(past.retry_delay, 0)

    def test_malformed_details_are_ignored(self):
        for metadata in (None, (("grpc-status-details-bin", b"\xff"),), (("x", "y"),)):
            error = from_rpc_error(Refusal(grpc.StatusCode.UNAVAILABLE, "away", metadata))
            self.assertEqual((error.violations, error.reason, error.retry_delay), ((), "", None))
        broken = status_pb2.Status()
        broken.details.add(type_url="type.googleapis.com/google.rpc.BadRequest", value=b"\xff")
        error = from_rpc_error(Refusal(grpc.StatusCode.INTERNAL, "x", (
            ("grpc-status-details-bin", broken.SerializeToString()),)))
        self.assertEqual(error.violations, ())

    def test_status_code_selects_the_class(self):
        for code, kind in ((grpc.StatusCode.NOT_FOUND, duet.ModelNotFoundError),
                           (grpc.StatusCode.FAILED_PRECONDITION, duet.RequestMismatchError),
                           (grpc.StatusCode.UNAVAILABLE, duet.UnavailableError),
                           (grpc.StatusCode.DEADLINE_EXCEEDED, duet.DeadlineError),
                           (grpc.StatusCode.UNAUTHENTICATED, duet.NotPermittedError),
                           (grpc.StatusCode.INTERNAL, duet.DuetError)):
            self.assertIs(type(make_error(code, "")), kind)


if __name__ == "__main__":
    unittest.main()
