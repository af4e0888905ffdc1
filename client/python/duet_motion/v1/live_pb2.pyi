from duet_motion.v1 import model_pb2 as _model_pb2
from duet_motion.v1 import motion_pb2 as _motion_pb2
from duet_motion.v1 import reaction_pb2 as _reaction_pb2
from google.protobuf.internal import containers as _containers
from google.protobuf.internal import enum_type_wrapper as _enum_type_wrapper
from google.protobuf import descriptor as _descriptor
from google.protobuf import message as _message
from typing import ClassVar as _ClassVar, Iterable as _Iterable, Mapping as _Mapping, Optional as _Optional, Union as _Union

DESCRIPTOR: _descriptor.FileDescriptor
LIVE_NOTICE_KIND_DRAINING: LiveNoticeKind
LIVE_NOTICE_KIND_GAP_FILLED: LiveNoticeKind
LIVE_NOTICE_KIND_LATE: LiveNoticeKind
LIVE_NOTICE_KIND_SKIPPED: LiveNoticeKind
LIVE_NOTICE_KIND_UNSPECIFIED: LiveNoticeKind

class FollowerFrames(_message.Message):
    __slots__ = ["capture_seconds", "first_frame", "frame_count", "leader_frame", "plan_positions", "positions", "rig", "rotations", "server_seconds"]
    CAPTURE_SECONDS_FIELD_NUMBER: _ClassVar[int]
    FIRST_FRAME_FIELD_NUMBER: _ClassVar[int]
    FRAME_COUNT_FIELD_NUMBER: _ClassVar[int]
    LEADER_FRAME_FIELD_NUMBER: _ClassVar[int]
    PLAN_POSITIONS_FIELD_NUMBER: _ClassVar[int]
    POSITIONS_FIELD_NUMBER: _ClassVar[int]
    RIG_FIELD_NUMBER: _ClassVar[int]
    ROTATIONS_FIELD_NUMBER: _ClassVar[int]
    SERVER_SECONDS_FIELD_NUMBER: _ClassVar[int]
    capture_seconds: float
    first_frame: int
    frame_count: int
    leader_frame: int
    plan_positions: _containers.RepeatedScalarFieldContainer[float]
    positions: _containers.RepeatedScalarFieldContainer[float]
    rig: _containers.RepeatedCompositeFieldContainer[_motion_pb2.RigJoint]
    rotations: _containers.RepeatedScalarFieldContainer[float]
    server_seconds: float
    def __init__(self, first_frame: _Optional[int] = ..., frame_count: _Optional[int] = ..., positions: _Optional[_Iterable[float]] = ..., plan_positions: _Optional[_Iterable[float]] = ..., leader_frame: _Optional[int] = ..., capture_seconds: _Optional[float] = ..., server_seconds: _Optional[float] = ..., rig: _Optional[_Iterable[_Union[_motion_pb2.RigJoint, _Mapping]]] = ..., rotations: _Optional[_Iterable[float]] = ...) -> None: ...

class LabelChange(_message.Message):
    __slots__ = ["ease_frames", "frame", "label_vector"]
    EASE_FRAMES_FIELD_NUMBER: _ClassVar[int]
    FRAME_FIELD_NUMBER: _ClassVar[int]
    LABEL_VECTOR_FIELD_NUMBER: _ClassVar[int]
    ease_frames: int
    frame: int
    label_vector: _reaction_pb2.LabelVector
    def __init__(self, frame: _Optional[int] = ..., label_vector: _Optional[_Union[_reaction_pb2.LabelVector, _Mapping]] = ..., ease_frames: _Optional[int] = ...) -> None: ...

class LeaderFrames(_message.Message):
    __slots__ = ["capture_seconds", "first_frame", "frame_count", "positions"]
    CAPTURE_SECONDS_FIELD_NUMBER: _ClassVar[int]
    FIRST_FRAME_FIELD_NUMBER: _ClassVar[int]
    FRAME_COUNT_FIELD_NUMBER: _ClassVar[int]
    POSITIONS_FIELD_NUMBER: _ClassVar[int]
    capture_seconds: float
    first_frame: int
    frame_count: int
    positions: _containers.RepeatedScalarFieldContainer[float]
    def __init__(self, first_frame: _Optional[int] = ..., frame_count: _Optional[int] = ..., positions: _Optional[_Iterable[float]] = ..., capture_seconds: _Optional[float] = ...) -> None: ...

class LiveHeader(_message.Message):
    __slots__ = ["candidates", "clean_up", "delay_frames", "first_frame", "frame_rate_hz", "history_frames", "interaction_classes", "joint_names", "model_name", "model_version", "request_id", "seed", "unit", "up_axis", "variety"]
    CANDIDATES_FIELD_NUMBER: _ClassVar[int]
    CLEAN_UP_FIELD_NUMBER: _ClassVar[int]
    DELAY_FRAMES_FIELD_NUMBER: _ClassVar[int]
    FIRST_FRAME_FIELD_NUMBER: _ClassVar[int]
    FRAME_RATE_HZ_FIELD_NUMBER: _ClassVar[int]
    HISTORY_FRAMES_FIELD_NUMBER: _ClassVar[int]
    INTERACTION_CLASSES_FIELD_NUMBER: _ClassVar[int]
    JOINT_NAMES_FIELD_NUMBER: _ClassVar[int]
    MODEL_NAME_FIELD_NUMBER: _ClassVar[int]
    MODEL_VERSION_FIELD_NUMBER: _ClassVar[int]
    REQUEST_ID_FIELD_NUMBER: _ClassVar[int]
    SEED_FIELD_NUMBER: _ClassVar[int]
    UNIT_FIELD_NUMBER: _ClassVar[int]
    UP_AXIS_FIELD_NUMBER: _ClassVar[int]
    VARIETY_FIELD_NUMBER: _ClassVar[int]
    candidates: int
    clean_up: _reaction_pb2.CleanUp
    delay_frames: int
    first_frame: int
    frame_rate_hz: float
    history_frames: int
    interaction_classes: _containers.RepeatedScalarFieldContainer[str]
    joint_names: _containers.RepeatedScalarFieldContainer[str]
    model_name: str
    model_version: int
    request_id: str
    seed: int
    unit: _motion_pb2.LengthUnit
    up_axis: _motion_pb2.UpAxis
    variety: float
    def __init__(self, model_name: _Optional[str] = ..., model_version: _Optional[int] = ..., joint_names: _Optional[_Iterable[str]] = ..., frame_rate_hz: _Optional[float] = ..., unit: _Optional[_Union[_motion_pb2.LengthUnit, str]] = ..., up_axis: _Optional[_Union[_motion_pb2.UpAxis, str]] = ..., interaction_classes: _Optional[_Iterable[str]] = ..., request_id: _Optional[str] = ..., seed: _Optional[int] = ..., variety: _Optional[float] = ..., clean_up: _Optional[_Union[_reaction_pb2.CleanUp, str]] = ..., candidates: _Optional[int] = ..., delay_frames: _Optional[int] = ..., first_frame: _Optional[int] = ..., history_frames: _Optional[int] = ...) -> None: ...

class LiveHistory(_message.Message):
    __slots__ = ["first_frame", "follower_frame_count", "follower_positions", "rig_follower_positions", "rig_leader_positions"]
    FIRST_FRAME_FIELD_NUMBER: _ClassVar[int]
    FOLLOWER_FRAME_COUNT_FIELD_NUMBER: _ClassVar[int]
    FOLLOWER_POSITIONS_FIELD_NUMBER: _ClassVar[int]
    RIG_FOLLOWER_POSITIONS_FIELD_NUMBER: _ClassVar[int]
    RIG_LEADER_POSITIONS_FIELD_NUMBER: _ClassVar[int]
    first_frame: int
    follower_frame_count: int
    follower_positions: _containers.RepeatedScalarFieldContainer[float]
    rig_follower_positions: _containers.RepeatedScalarFieldContainer[float]
    rig_leader_positions: _containers.RepeatedScalarFieldContainer[float]
    def __init__(self, first_frame: _Optional[int] = ..., follower_frame_count: _Optional[int] = ..., follower_positions: _Optional[_Iterable[float]] = ..., rig_leader_positions: _Optional[_Iterable[float]] = ..., rig_follower_positions: _Optional[_Iterable[float]] = ...) -> None: ...

class LiveNotice(_message.Message):
    __slots__ = ["frames", "kind"]
    FRAMES_FIELD_NUMBER: _ClassVar[int]
    KIND_FIELD_NUMBER: _ClassVar[int]
    frames: _reaction_pb2.FrameRun
    kind: LiveNoticeKind
    def __init__(self, kind: _Optional[_Union[LiveNoticeKind, str]] = ..., frames: _Optional[_Union[_reaction_pb2.FrameRun, _Mapping]] = ...) -> None: ...

class LiveStart(_message.Message):
    __slots__ = ["candidates", "clean_up", "delay_frames", "follower_start", "history", "label_keyframes", "label_vector", "leader", "model", "partner_direction", "plan_frames", "reaction", "reply_rotations", "seed", "up", "variety"]
    CANDIDATES_FIELD_NUMBER: _ClassVar[int]
    CLEAN_UP_FIELD_NUMBER: _ClassVar[int]
    DELAY_FRAMES_FIELD_NUMBER: _ClassVar[int]
    FOLLOWER_START_FIELD_NUMBER: _ClassVar[int]
    HISTORY_FIELD_NUMBER: _ClassVar[int]
    LABEL_KEYFRAMES_FIELD_NUMBER: _ClassVar[int]
    LABEL_VECTOR_FIELD_NUMBER: _ClassVar[int]
    LEADER_FIELD_NUMBER: _ClassVar[int]
    MODEL_FIELD_NUMBER: _ClassVar[int]
    PARTNER_DIRECTION_FIELD_NUMBER: _ClassVar[int]
    PLAN_FRAMES_FIELD_NUMBER: _ClassVar[int]
    REACTION_FIELD_NUMBER: _ClassVar[int]
    REPLY_ROTATIONS_FIELD_NUMBER: _ClassVar[int]
    SEED_FIELD_NUMBER: _ClassVar[int]
    UP_FIELD_NUMBER: _ClassVar[int]
    VARIETY_FIELD_NUMBER: _ClassVar[int]
    candidates: int
    clean_up: _reaction_pb2.CleanUp
    delay_frames: int
    follower_start: _motion_pb2.FollowerStart
    history: LiveHistory
    label_keyframes: _containers.RepeatedCompositeFieldContainer[_reaction_pb2.LabelKeyframe]
    label_vector: _reaction_pb2.LabelVector
    leader: _motion_pb2.Motion
    model: _model_pb2.ModelSelector
    partner_direction: _motion_pb2.Direction
    plan_frames: int
    reaction: float
    reply_rotations: bool
    seed: int
    up: _motion_pb2.Direction
    variety: float
    def __init__(self, model: _Optional[_Union[_model_pb2.ModelSelector, _Mapping]] = ..., leader: _Optional[_Union[_motion_pb2.Motion, _Mapping]] = ..., label_vector: _Optional[_Union[_reaction_pb2.LabelVector, _Mapping]] = ..., label_keyframes: _Optional[_Iterable[_Union[_reaction_pb2.LabelKeyframe, _Mapping]]] = ..., follower_start: _Optional[_Union[_motion_pb2.FollowerStart, _Mapping]] = ..., partner_direction: _Optional[_Union[_motion_pb2.Direction, _Mapping]] = ..., seed: _Optional[int] = ..., variety: _Optional[float] = ..., clean_up: _Optional[_Union[_reaction_pb2.CleanUp, str]] = ..., candidates: _Optional[int] = ..., up: _Optional[_Union[_motion_pb2.Direction, _Mapping]] = ..., delay_frames: _Optional[int] = ..., plan_frames: _Optional[int] = ..., history: _Optional[_Union[LiveHistory, _Mapping]] = ..., reply_rotations: bool = ..., reaction: _Optional[float] = ...) -> None: ...

class LiveSummary(_message.Message):
    __slots__ = ["compute_seconds", "frame_count", "gap_frames", "late_frames", "queue_seconds", "skipped_frames", "window_count"]
    COMPUTE_SECONDS_FIELD_NUMBER: _ClassVar[int]
    FRAME_COUNT_FIELD_NUMBER: _ClassVar[int]
    GAP_FRAMES_FIELD_NUMBER: _ClassVar[int]
    LATE_FRAMES_FIELD_NUMBER: _ClassVar[int]
    QUEUE_SECONDS_FIELD_NUMBER: _ClassVar[int]
    SKIPPED_FRAMES_FIELD_NUMBER: _ClassVar[int]
    WINDOW_COUNT_FIELD_NUMBER: _ClassVar[int]
    compute_seconds: float
    frame_count: int
    gap_frames: int
    late_frames: int
    queue_seconds: float
    skipped_frames: int
    window_count: int
    def __init__(self, frame_count: _Optional[int] = ..., window_count: _Optional[int] = ..., queue_seconds: _Optional[float] = ..., compute_seconds: _Optional[float] = ..., gap_frames: _Optional[int] = ..., late_frames: _Optional[int] = ..., skipped_frames: _Optional[int] = ...) -> None: ...

class SynthesizeLiveRequest(_message.Message):
    __slots__ = ["frames", "label_change", "start"]
    FRAMES_FIELD_NUMBER: _ClassVar[int]
    LABEL_CHANGE_FIELD_NUMBER: _ClassVar[int]
    START_FIELD_NUMBER: _ClassVar[int]
    frames: LeaderFrames
    label_change: LabelChange
    start: LiveStart
    def __init__(self, start: _Optional[_Union[LiveStart, _Mapping]] = ..., frames: _Optional[_Union[LeaderFrames, _Mapping]] = ..., label_change: _Optional[_Union[LabelChange, _Mapping]] = ...) -> None: ...

class SynthesizeLiveResponse(_message.Message):
    __slots__ = ["frames", "header", "notice", "summary"]
    FRAMES_FIELD_NUMBER: _ClassVar[int]
    HEADER_FIELD_NUMBER: _ClassVar[int]
    NOTICE_FIELD_NUMBER: _ClassVar[int]
    SUMMARY_FIELD_NUMBER: _ClassVar[int]
    frames: FollowerFrames
    header: LiveHeader
    notice: LiveNotice
    summary: LiveSummary
    def __init__(self, header: _Optional[_Union[LiveHeader, _Mapping]] = ..., frames: _Optional[_Union[FollowerFrames, _Mapping]] = ..., notice: _Optional[_Union[LiveNotice, _Mapping]] = ..., summary: _Optional[_Union[LiveSummary, _Mapping]] = ...) -> None: ...

class LiveNoticeKind(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
    __slots__ = []
