from google.protobuf.internal import containers as _containers
from google.protobuf import descriptor as _descriptor
from google.protobuf import message as _message
from typing import ClassVar as _ClassVar, Iterable as _Iterable, Mapping as _Mapping, Optional as _Optional, Union as _Union

DESCRIPTOR: _descriptor.FileDescriptor

class Bone(_message.Message):
    __slots__ = ["child_joint", "parent_joint"]
    CHILD_JOINT_FIELD_NUMBER: _ClassVar[int]
    PARENT_JOINT_FIELD_NUMBER: _ClassVar[int]
    child_joint: int
    parent_joint: int
    def __init__(self, parent_joint: _Optional[int] = ..., child_joint: _Optional[int] = ...) -> None: ...

class Model(_message.Message):
    __slots__ = ["accepts_follower_start", "answers_live", "bones", "description", "frame_rate_hz", "free_for_all_uses", "interaction_classes", "is_default", "joint_names", "name", "root_joint", "samples", "terms", "version", "version_labels", "weights_sha256", "window_frames"]
    ACCEPTS_FOLLOWER_START_FIELD_NUMBER: _ClassVar[int]
    ANSWERS_LIVE_FIELD_NUMBER: _ClassVar[int]
    BONES_FIELD_NUMBER: _ClassVar[int]
    DESCRIPTION_FIELD_NUMBER: _ClassVar[int]
    FRAME_RATE_HZ_FIELD_NUMBER: _ClassVar[int]
    FREE_FOR_ALL_USES_FIELD_NUMBER: _ClassVar[int]
    INTERACTION_CLASSES_FIELD_NUMBER: _ClassVar[int]
    IS_DEFAULT_FIELD_NUMBER: _ClassVar[int]
    JOINT_NAMES_FIELD_NUMBER: _ClassVar[int]
    NAME_FIELD_NUMBER: _ClassVar[int]
    ROOT_JOINT_FIELD_NUMBER: _ClassVar[int]
    SAMPLES_FIELD_NUMBER: _ClassVar[int]
    TERMS_FIELD_NUMBER: _ClassVar[int]
    VERSION_FIELD_NUMBER: _ClassVar[int]
    VERSION_LABELS_FIELD_NUMBER: _ClassVar[int]
    WEIGHTS_SHA256_FIELD_NUMBER: _ClassVar[int]
    WINDOW_FRAMES_FIELD_NUMBER: _ClassVar[int]
    accepts_follower_start: bool
    answers_live: bool
    bones: _containers.RepeatedCompositeFieldContainer[Bone]
    description: str
    frame_rate_hz: float
    free_for_all_uses: bool
    interaction_classes: _containers.RepeatedScalarFieldContainer[str]
    is_default: bool
    joint_names: _containers.RepeatedScalarFieldContainer[str]
    name: str
    root_joint: str
    samples: bool
    terms: str
    version: int
    version_labels: _containers.RepeatedScalarFieldContainer[str]
    weights_sha256: str
    window_frames: int
    def __init__(self, name: _Optional[str] = ..., version: _Optional[int] = ..., version_labels: _Optional[_Iterable[str]] = ..., is_default: bool = ..., interaction_classes: _Optional[_Iterable[str]] = ..., joint_names: _Optional[_Iterable[str]] = ..., bones: _Optional[_Iterable[_Union[Bone, _Mapping]]] = ..., root_joint: _Optional[str] = ..., frame_rate_hz: _Optional[float] = ..., window_frames: _Optional[int] = ..., accepts_follower_start: bool = ..., description: _Optional[str] = ..., samples: bool = ..., terms: _Optional[str] = ..., weights_sha256: _Optional[str] = ..., free_for_all_uses: bool = ..., answers_live: bool = ...) -> None: ...

class ModelSelector(_message.Message):
    __slots__ = ["name", "version", "version_label"]
    NAME_FIELD_NUMBER: _ClassVar[int]
    VERSION_FIELD_NUMBER: _ClassVar[int]
    VERSION_LABEL_FIELD_NUMBER: _ClassVar[int]
    name: str
    version: int
    version_label: str
    def __init__(self, name: _Optional[str] = ..., version: _Optional[int] = ..., version_label: _Optional[str] = ...) -> None: ...
