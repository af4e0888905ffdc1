from google.protobuf.internal import containers as _containers
from google.protobuf.internal import enum_type_wrapper as _enum_type_wrapper
from google.protobuf import descriptor as _descriptor
from google.protobuf import message as _message
from typing import ClassVar as _ClassVar, Iterable as _Iterable, Mapping as _Mapping, Optional as _Optional, Union as _Union

DESCRIPTOR: _descriptor.FileDescriptor
LENGTH_UNIT_METRES: LengthUnit
LENGTH_UNIT_MILLIMETRES: LengthUnit
LENGTH_UNIT_SBU_NORMALISED: LengthUnit
LENGTH_UNIT_UNSPECIFIED: LengthUnit
UP_AXIS_UNSPECIFIED: UpAxis
UP_AXIS_Y_DOWN: UpAxis
UP_AXIS_Y_UP: UpAxis
UP_AXIS_Z_UP: UpAxis

class Direction(_message.Message):
    __slots__ = ["x", "y", "z"]
    X_FIELD_NUMBER: _ClassVar[int]
    Y_FIELD_NUMBER: _ClassVar[int]
    Z_FIELD_NUMBER: _ClassVar[int]
    x: float
    y: float
    z: float
    def __init__(self, x: _Optional[float] = ..., y: _Optional[float] = ..., z: _Optional[float] = ...) -> None: ...

class FollowerStart(_message.Message):
    __slots__ = ["pose", "root_position"]
    POSE_FIELD_NUMBER: _ClassVar[int]
    ROOT_POSITION_FIELD_NUMBER: _ClassVar[int]
    pose: Pose
    root_position: Point
    def __init__(self, root_position: _Optional[_Union[Point, _Mapping]] = ..., pose: _Optional[_Union[Pose, _Mapping]] = ...) -> None: ...

class Motion(_message.Message):
    __slots__ = ["frame_count", "frame_rate_hz", "joint_names", "positions", "unit", "up_axis"]
    FRAME_COUNT_FIELD_NUMBER: _ClassVar[int]
    FRAME_RATE_HZ_FIELD_NUMBER: _ClassVar[int]
    JOINT_NAMES_FIELD_NUMBER: _ClassVar[int]
    POSITIONS_FIELD_NUMBER: _ClassVar[int]
    UNIT_FIELD_NUMBER: _ClassVar[int]
    UP_AXIS_FIELD_NUMBER: _ClassVar[int]
    frame_count: int
    frame_rate_hz: float
    joint_names: _containers.RepeatedScalarFieldContainer[str]
    positions: _containers.RepeatedScalarFieldContainer[float]
    unit: LengthUnit
    up_axis: UpAxis
    def __init__(self, joint_names: _Optional[_Iterable[str]] = ..., frame_rate_hz: _Optional[float] = ..., unit: _Optional[_Union[LengthUnit, str]] = ..., up_axis: _Optional[_Union[UpAxis, str]] = ..., frame_count: _Optional[int] = ..., positions: _Optional[_Iterable[float]] = ...) -> None: ...

class Point(_message.Message):
    __slots__ = ["x", "y", "z"]
    X_FIELD_NUMBER: _ClassVar[int]
    Y_FIELD_NUMBER: _ClassVar[int]
    Z_FIELD_NUMBER: _ClassVar[int]
    x: float
    y: float
    z: float
    def __init__(self, x: _Optional[float] = ..., y: _Optional[float] = ..., z: _Optional[float] = ...) -> None: ...

class Pose(_message.Message):
    __slots__ = ["positions"]
    POSITIONS_FIELD_NUMBER: _ClassVar[int]
    positions: _containers.RepeatedScalarFieldContainer[float]
    def __init__(self, positions: _Optional[_Iterable[float]] = ...) -> None: ...

class RigJoint(_message.Message):
    __slots__ = ["joint", "name", "offset", "parent"]
    JOINT_FIELD_NUMBER: _ClassVar[int]
    NAME_FIELD_NUMBER: _ClassVar[int]
    OFFSET_FIELD_NUMBER: _ClassVar[int]
    PARENT_FIELD_NUMBER: _ClassVar[int]
    joint: int
    name: str
    offset: Point
    parent: int
    def __init__(self, name: _Optional[str] = ..., parent: _Optional[int] = ..., offset: _Optional[_Union[Point, _Mapping]] = ..., joint: _Optional[int] = ...) -> None: ...

class LengthUnit(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
    __slots__ = []

class UpAxis(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
    __slots__ = []
