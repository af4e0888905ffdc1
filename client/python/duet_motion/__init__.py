"""Duet synthesises the second person of a two-person interaction. This is its Python client.

>>> import duet_motion as duet
>>> leader = duet.read_motion("samples/hug.bvh")
>>> with duet.Client() as client:                     # DUET_SERVER, or localhost:50051
...     result = client.synthesize(leader, labels={"hug": 1}, seed=3)
>>> result.follower.positions.shape
(91, 15, 3)
"""

from duet_motion import aio, research
from duet_motion.client import Client, SynthesisStream
from duet_motion.errors import (CancelledError, DeadlineError, DuetError, FieldViolation,
                                InvalidRequestError, MalformedReplyError, ModelNotFoundError,
                                NotPermittedError, RequestMismatchError, ServerBusyError,
                                UnavailableError)
from duet_motion.files import MotionFileError, read_motion, read_pair, write_motion, write_page
from duet_motion.live import LiveHeader, LiveNotice, LivePart, LiveRequest, LiveSummary
from duet_motion.motion import Motion
from duet_motion.options import TlsOptions
from duet_motion.request import Constraint, SynthesisRequest
from duet_motion.result import (FollowerChunk, FrameRun, JointRotations, ModelDetails, ModelInfo,
                                MotionGrade, RequestLimits, RigJoint, SynthesisResult, Timings)
from duet_motion.retry import RetryOptions
from duet_motion.sets import DataSetError, MotionSet, PaddedBatch, SetItem, pad, read_set

__version__ = "1.0.0"

__all__ = [
    "CancelledError", "Client", "Constraint", "DataSetError", "DeadlineError", "DuetError",
    "FieldViolation", "FollowerChunk", "FrameRun", "InvalidRequestError", "JointRotations",
    "LiveHeader", "LiveNotice", "LivePart", "LiveRequest", "LiveSummary", "MalformedReplyError",
    "ModelDetails", "ModelInfo", "ModelNotFoundError", "Motion", "MotionFileError", "MotionGrade",
    "MotionSet", "NotPermittedError", "PaddedBatch", "RequestLimits", "RequestMismatchError",
    "RetryOptions", "RigJoint", "ServerBusyError", "SetItem", "SynthesisRequest", "SynthesisResult",
    "SynthesisStream", "Timings", "TlsOptions", "UnavailableError",
    "__version__", "aio", "pad", "research", "read_motion", "read_pair", "read_set", "write_motion",
    "write_page",
]
