from google.protobuf.internal import containers as _containers
from google.protobuf.internal import enum_type_wrapper as _enum_type_wrapper
from google.protobuf import descriptor as _descriptor
from google.protobuf import message as _message
from typing import ClassVar as _ClassVar, Iterable as _Iterable, Mapping as _Mapping, Optional as _Optional, Union as _Union

CLEAN_UP_OFF: CleanUp
CLEAN_UP_ON: CleanUp
CLEAN_UP_UNSPECIFIED: CleanUp
DESCRIPTOR: _descriptor.FileDescriptor

class ClassWeight(_message.Message):
    __slots__ = ["interaction_class", "weight"]
    INTERACTION_CLASS_FIELD_NUMBER: _ClassVar[int]
    WEIGHT_FIELD_NUMBER: _ClassVar[int]
    interaction_class: str
    weight: float
    def __init__(self, interaction_class: _Optional[str] = ..., weight: _Optional[float] = ...) -> None: ...

class FrameRun(_message.Message):
    __slots__ = ["first_frame", "frame_count"]
    FIRST_FRAME_FIELD_NUMBER: _ClassVar[int]
    FRAME_COUNT_FIELD_NUMBER: _ClassVar[int]
    first_frame: int
    frame_count: int
    def __init__(self, first_frame: _Optional[int] = ..., frame_count: _Optional[int] = ...) -> None: ...

class LabelKeyframe(_message.Message):
    __slots__ = ["frame", "label_vector"]
    FRAME_FIELD_NUMBER: _ClassVar[int]
    LABEL_VECTOR_FIELD_NUMBER: _ClassVar[int]
    frame: int
    label_vector: LabelVector
    def __init__(self, frame: _Optional[int] = ..., label_vector: _Optional[_Union[LabelVector, _Mapping]] = ...) -> None: ...

class LabelVector(_message.Message):
    __slots__ = ["weights"]
    WEIGHTS_FIELD_NUMBER: _ClassVar[int]
    weights: _containers.RepeatedCompositeFieldContainer[ClassWeight]
    def __init__(self, weights: _Optional[_Iterable[_Union[ClassWeight, _Mapping]]] = ...) -> None: ...

class MotionGrade(_message.Message):
    __slots__ = ["bad_runs", "leader_skating", "overlapping", "skating", "twisted"]
    BAD_RUNS_FIELD_NUMBER: _ClassVar[int]
    LEADER_SKATING_FIELD_NUMBER: _ClassVar[int]
    OVERLAPPING_FIELD_NUMBER: _ClassVar[int]
    SKATING_FIELD_NUMBER: _ClassVar[int]
    TWISTED_FIELD_NUMBER: _ClassVar[int]
    bad_runs: _containers.RepeatedCompositeFieldContainer[FrameRun]
    leader_skating: float
    overlapping: float
    skating: float
    twisted: float
    def __init__(self, twisted: _Optional[float] = ..., skating: _Optional[float] = ..., leader_skating: _Optional[float] = ..., overlapping: _Optional[float] = ..., bad_runs: _Optional[_Iterable[_Union[FrameRun, _Mapping]]] = ...) -> None: ...

class CleanUp(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
    __slots__ = []
