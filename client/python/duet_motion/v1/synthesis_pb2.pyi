from duet_motion.v1 import live_pb2 as _live_pb2
from duet_motion.v1 import model_pb2 as _model_pb2
from duet_motion.v1 import motion_pb2 as _motion_pb2
from duet_motion.v1 import reaction_pb2 as _reaction_pb2
from google.protobuf.internal import containers as _containers
from google.protobuf.internal import enum_type_wrapper as _enum_type_wrapper
from google.protobuf import descriptor as _descriptor
from google.protobuf import message as _message
from typing import ClassVar as _ClassVar, Iterable as _Iterable, Mapping as _Mapping, Optional as _Optional, Union as _Union

DESCRIPTOR: _descriptor.FileDescriptor
PRIORITY_BULK: Priority
PRIORITY_INTERACTIVE: Priority
PRIORITY_UNSPECIFIED: Priority

class GetModelRequest(_message.Message):
    __slots__ = ["model"]
    MODEL_FIELD_NUMBER: _ClassVar[int]
    model: _model_pb2.ModelSelector
    def __init__(self, model: _Optional[_Union[_model_pb2.ModelSelector, _Mapping]] = ...) -> None: ...

class GetModelResponse(_message.Message):
    __slots__ = ["limits", "model"]
    LIMITS_FIELD_NUMBER: _ClassVar[int]
    MODEL_FIELD_NUMBER: _ClassVar[int]
    limits: RequestLimits
    model: _model_pb2.Model
    def __init__(self, model: _Optional[_Union[_model_pb2.Model, _Mapping]] = ..., limits: _Optional[_Union[RequestLimits, _Mapping]] = ...) -> None: ...

class JointConstraint(_message.Message):
    __slots__ = ["frame", "joint_name", "position", "softness"]
    FRAME_FIELD_NUMBER: _ClassVar[int]
    JOINT_NAME_FIELD_NUMBER: _ClassVar[int]
    POSITION_FIELD_NUMBER: _ClassVar[int]
    SOFTNESS_FIELD_NUMBER: _ClassVar[int]
    frame: int
    joint_name: str
    position: _motion_pb2.Point
    softness: float
    def __init__(self, joint_name: _Optional[str] = ..., frame: _Optional[int] = ..., position: _Optional[_Union[_motion_pb2.Point, _Mapping]] = ..., softness: _Optional[float] = ...) -> None: ...

class ListModelsRequest(_message.Message):
    __slots__ = []
    def __init__(self) -> None: ...

class ListModelsResponse(_message.Message):
    __slots__ = ["models"]
    MODELS_FIELD_NUMBER: _ClassVar[int]
    models: _containers.RepeatedCompositeFieldContainer[_model_pb2.Model]
    def __init__(self, models: _Optional[_Iterable[_Union[_model_pb2.Model, _Mapping]]] = ...) -> None: ...

class MotionChunk(_message.Message):
    __slots__ = ["first_frame", "frame_count", "positions", "rotations"]
    FIRST_FRAME_FIELD_NUMBER: _ClassVar[int]
    FRAME_COUNT_FIELD_NUMBER: _ClassVar[int]
    POSITIONS_FIELD_NUMBER: _ClassVar[int]
    ROTATIONS_FIELD_NUMBER: _ClassVar[int]
    first_frame: int
    frame_count: int
    positions: _containers.RepeatedScalarFieldContainer[float]
    rotations: _containers.RepeatedScalarFieldContainer[float]
    def __init__(self, first_frame: _Optional[int] = ..., frame_count: _Optional[int] = ..., positions: _Optional[_Iterable[float]] = ..., rotations: _Optional[_Iterable[float]] = ...) -> None: ...

class RequestLimits(_message.Message):
    __slots__ = ["max_abs_weight", "max_candidates", "max_chunk_frames", "max_constraints", "max_delay_frames", "max_duration_seconds", "max_frame_rate_hz", "max_label_keyframes", "max_plan_frames", "max_request_bytes", "max_variety", "min_frame_rate_hz", "min_frames"]
    MAX_ABS_WEIGHT_FIELD_NUMBER: _ClassVar[int]
    MAX_CANDIDATES_FIELD_NUMBER: _ClassVar[int]
    MAX_CHUNK_FRAMES_FIELD_NUMBER: _ClassVar[int]
    MAX_CONSTRAINTS_FIELD_NUMBER: _ClassVar[int]
    MAX_DELAY_FRAMES_FIELD_NUMBER: _ClassVar[int]
    MAX_DURATION_SECONDS_FIELD_NUMBER: _ClassVar[int]
    MAX_FRAME_RATE_HZ_FIELD_NUMBER: _ClassVar[int]
    MAX_LABEL_KEYFRAMES_FIELD_NUMBER: _ClassVar[int]
    MAX_PLAN_FRAMES_FIELD_NUMBER: _ClassVar[int]
    MAX_REQUEST_BYTES_FIELD_NUMBER: _ClassVar[int]
    MAX_VARIETY_FIELD_NUMBER: _ClassVar[int]
    MIN_FRAMES_FIELD_NUMBER: _ClassVar[int]
    MIN_FRAME_RATE_HZ_FIELD_NUMBER: _ClassVar[int]
    max_abs_weight: float
    max_candidates: int
    max_chunk_frames: int
    max_constraints: int
    max_delay_frames: int
    max_duration_seconds: float
    max_frame_rate_hz: float
    max_label_keyframes: int
    max_plan_frames: int
    max_request_bytes: int
    max_variety: float
    min_frame_rate_hz: float
    min_frames: int
    def __init__(self, min_frame_rate_hz: _Optional[float] = ..., max_frame_rate_hz: _Optional[float] = ..., min_frames: _Optional[int] = ..., max_duration_seconds: _Optional[float] = ..., max_chunk_frames: _Optional[int] = ..., max_label_keyframes: _Optional[int] = ..., max_abs_weight: _Optional[float] = ..., max_request_bytes: _Optional[int] = ..., max_variety: _Optional[float] = ..., max_candidates: _Optional[int] = ..., max_delay_frames: _Optional[int] = ..., max_plan_frames: _Optional[int] = ..., max_constraints: _Optional[int] = ...) -> None: ...

class SynthesisHeader(_message.Message):
    __slots__ = ["candidates", "clean_up", "engine", "frame_count", "frame_rate_hz", "interaction_classes", "joint_names", "model_name", "model_version", "request_id", "rig", "seed", "server_version", "unit", "up_axis", "variety"]
    CANDIDATES_FIELD_NUMBER: _ClassVar[int]
    CLEAN_UP_FIELD_NUMBER: _ClassVar[int]
    ENGINE_FIELD_NUMBER: _ClassVar[int]
    FRAME_COUNT_FIELD_NUMBER: _ClassVar[int]
    FRAME_RATE_HZ_FIELD_NUMBER: _ClassVar[int]
    INTERACTION_CLASSES_FIELD_NUMBER: _ClassVar[int]
    JOINT_NAMES_FIELD_NUMBER: _ClassVar[int]
    MODEL_NAME_FIELD_NUMBER: _ClassVar[int]
    MODEL_VERSION_FIELD_NUMBER: _ClassVar[int]
    REQUEST_ID_FIELD_NUMBER: _ClassVar[int]
    RIG_FIELD_NUMBER: _ClassVar[int]
    SEED_FIELD_NUMBER: _ClassVar[int]
    SERVER_VERSION_FIELD_NUMBER: _ClassVar[int]
    UNIT_FIELD_NUMBER: _ClassVar[int]
    UP_AXIS_FIELD_NUMBER: _ClassVar[int]
    VARIETY_FIELD_NUMBER: _ClassVar[int]
    candidates: int
    clean_up: _reaction_pb2.CleanUp
    engine: str
    frame_count: int
    frame_rate_hz: float
    interaction_classes: _containers.RepeatedScalarFieldContainer[str]
    joint_names: _containers.RepeatedScalarFieldContainer[str]
    model_name: str
    model_version: int
    request_id: str
    rig: _containers.RepeatedCompositeFieldContainer[_motion_pb2.RigJoint]
    seed: int
    server_version: str
    unit: _motion_pb2.LengthUnit
    up_axis: _motion_pb2.UpAxis
    variety: float
    def __init__(self, model_name: _Optional[str] = ..., model_version: _Optional[int] = ..., joint_names: _Optional[_Iterable[str]] = ..., frame_rate_hz: _Optional[float] = ..., unit: _Optional[_Union[_motion_pb2.LengthUnit, str]] = ..., up_axis: _Optional[_Union[_motion_pb2.UpAxis, str]] = ..., frame_count: _Optional[int] = ..., interaction_classes: _Optional[_Iterable[str]] = ..., request_id: _Optional[str] = ..., seed: _Optional[int] = ..., variety: _Optional[float] = ..., clean_up: _Optional[_Union[_reaction_pb2.CleanUp, str]] = ..., candidates: _Optional[int] = ..., rig: _Optional[_Iterable[_Union[_motion_pb2.RigJoint, _Mapping]]] = ..., engine: _Optional[str] = ..., server_version: _Optional[str] = ...) -> None: ...

class SynthesisSummary(_message.Message):
    __slots__ = ["chunk_count", "compute_seconds", "constraint_metres", "frame_count", "grade", "queue_seconds", "unfamiliarity", "window_count"]
    CHUNK_COUNT_FIELD_NUMBER: _ClassVar[int]
    COMPUTE_SECONDS_FIELD_NUMBER: _ClassVar[int]
    CONSTRAINT_METRES_FIELD_NUMBER: _ClassVar[int]
    FRAME_COUNT_FIELD_NUMBER: _ClassVar[int]
    GRADE_FIELD_NUMBER: _ClassVar[int]
    QUEUE_SECONDS_FIELD_NUMBER: _ClassVar[int]
    UNFAMILIARITY_FIELD_NUMBER: _ClassVar[int]
    WINDOW_COUNT_FIELD_NUMBER: _ClassVar[int]
    chunk_count: int
    compute_seconds: float
    constraint_metres: _containers.RepeatedScalarFieldContainer[float]
    frame_count: int
    grade: _reaction_pb2.MotionGrade
    queue_seconds: float
    unfamiliarity: float
    window_count: int
    def __init__(self, frame_count: _Optional[int] = ..., chunk_count: _Optional[int] = ..., window_count: _Optional[int] = ..., queue_seconds: _Optional[float] = ..., compute_seconds: _Optional[float] = ..., unfamiliarity: _Optional[float] = ..., grade: _Optional[_Union[_reaction_pb2.MotionGrade, _Mapping]] = ..., constraint_metres: _Optional[_Iterable[float]] = ...) -> None: ...

class SynthesizeRequest(_message.Message):
    __slots__ = ["candidates", "chunk_frames", "clean_up", "constraints", "follower_start", "label_keyframes", "label_vector", "leader", "model", "partner_direction", "priority", "reaction", "reply_joint_names", "reply_rotations", "seed", "up", "variety"]
    CANDIDATES_FIELD_NUMBER: _ClassVar[int]
    CHUNK_FRAMES_FIELD_NUMBER: _ClassVar[int]
    CLEAN_UP_FIELD_NUMBER: _ClassVar[int]
    CONSTRAINTS_FIELD_NUMBER: _ClassVar[int]
    FOLLOWER_START_FIELD_NUMBER: _ClassVar[int]
    LABEL_KEYFRAMES_FIELD_NUMBER: _ClassVar[int]
    LABEL_VECTOR_FIELD_NUMBER: _ClassVar[int]
    LEADER_FIELD_NUMBER: _ClassVar[int]
    MODEL_FIELD_NUMBER: _ClassVar[int]
    PARTNER_DIRECTION_FIELD_NUMBER: _ClassVar[int]
    PRIORITY_FIELD_NUMBER: _ClassVar[int]
    REACTION_FIELD_NUMBER: _ClassVar[int]
    REPLY_JOINT_NAMES_FIELD_NUMBER: _ClassVar[int]
    REPLY_ROTATIONS_FIELD_NUMBER: _ClassVar[int]
    SEED_FIELD_NUMBER: _ClassVar[int]
    UP_FIELD_NUMBER: _ClassVar[int]
    VARIETY_FIELD_NUMBER: _ClassVar[int]
    candidates: int
    chunk_frames: int
    clean_up: _reaction_pb2.CleanUp
    constraints: _containers.RepeatedCompositeFieldContainer[JointConstraint]
    follower_start: _motion_pb2.FollowerStart
    label_keyframes: _containers.RepeatedCompositeFieldContainer[_reaction_pb2.LabelKeyframe]
    label_vector: _reaction_pb2.LabelVector
    leader: _motion_pb2.Motion
    model: _model_pb2.ModelSelector
    partner_direction: _motion_pb2.Direction
    priority: Priority
    reaction: float
    reply_joint_names: _containers.RepeatedScalarFieldContainer[str]
    reply_rotations: bool
    seed: int
    up: _motion_pb2.Direction
    variety: float
    def __init__(self, model: _Optional[_Union[_model_pb2.ModelSelector, _Mapping]] = ..., leader: _Optional[_Union[_motion_pb2.Motion, _Mapping]] = ..., label_vector: _Optional[_Union[_reaction_pb2.LabelVector, _Mapping]] = ..., label_keyframes: _Optional[_Iterable[_Union[_reaction_pb2.LabelKeyframe, _Mapping]]] = ..., follower_start: _Optional[_Union[_motion_pb2.FollowerStart, _Mapping]] = ..., chunk_frames: _Optional[int] = ..., priority: _Optional[_Union[Priority, str]] = ..., reply_joint_names: _Optional[_Iterable[str]] = ..., partner_direction: _Optional[_Union[_motion_pb2.Direction, _Mapping]] = ..., seed: _Optional[int] = ..., variety: _Optional[float] = ..., clean_up: _Optional[_Union[_reaction_pb2.CleanUp, str]] = ..., candidates: _Optional[int] = ..., reply_rotations: bool = ..., up: _Optional[_Union[_motion_pb2.Direction, _Mapping]] = ..., constraints: _Optional[_Iterable[_Union[JointConstraint, _Mapping]]] = ..., reaction: _Optional[float] = ...) -> None: ...

class SynthesizeResponse(_message.Message):
    __slots__ = ["chunk", "header", "summary"]
    CHUNK_FIELD_NUMBER: _ClassVar[int]
    HEADER_FIELD_NUMBER: _ClassVar[int]
    SUMMARY_FIELD_NUMBER: _ClassVar[int]
    chunk: MotionChunk
    header: SynthesisHeader
    summary: SynthesisSummary
    def __init__(self, header: _Optional[_Union[SynthesisHeader, _Mapping]] = ..., chunk: _Optional[_Union[MotionChunk, _Mapping]] = ..., summary: _Optional[_Union[SynthesisSummary, _Mapping]] = ...) -> None: ...

class Priority(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
    __slots__ = []
