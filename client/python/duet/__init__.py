"""Duet: one character moves, another answers. The client for Python.

>>> import duet
>>> leader = duet.read_motion("samples/hug.bvh")
>>> with duet.Client("localhost:50051") as client:
...     result = client.synthesize(leader, labels={"hug": 1}, seed=3)
>>> result.follower.positions.shape
(91, 15, 3)
"""

from duet import aio
from duet.batch import Outcome
from duet.client import Client, SynthesisStream
from duet.errors import (CancelledError, DeadlineError, DuetError, FieldViolation,
                         InvalidRequestError, MalformedReplyError, ModelNotFoundError,
                         NotPermittedError, RequestMismatchError, ServerBusyError, UnavailableError)
from duet.files import MotionFileError, read_motion, read_pair, write_motion, write_page
from duet.motion import Motion
from duet.options import TlsOptions
from duet.request import SynthesisRequest
from duet.result import (FollowerChunk, ModelDetails, ModelInfo, RequestLimits, SynthesisResult,
                         Timings)
from duet.retry import RetryOptions

__all__ = [
    "CancelledError", "Client", "DeadlineError", "DuetError", "FieldViolation", "FollowerChunk",
    "InvalidRequestError", "MalformedReplyError", "ModelDetails", "ModelInfo",
    "ModelNotFoundError", "Motion", "MotionFileError", "NotPermittedError", "Outcome",
    "RequestLimits", "RequestMismatchError", "RetryOptions", "ServerBusyError", "SynthesisRequest",
    "SynthesisResult", "SynthesisStream", "Timings", "TlsOptions", "UnavailableError", "aio",
    "read_motion", "read_pair", "write_motion", "write_page",
]
