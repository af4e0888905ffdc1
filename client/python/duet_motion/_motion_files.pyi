"""The extension module that reads and writes motion files (client/python/extension). Not part of
every wheel: see _file_extension.py."""

import os
from typing import Any, Dict, List, Mapping, Optional, Union

Path = Union[str, bytes, "os.PathLike[str]"]

class Error(Exception): ...

class Person:
    @property
    def positions(self) -> memoryview:
        """``[frames, joints, 3]`` of float32, read-only, in memory that belongs to the person."""
    @property
    def joint_names(self) -> List[str]: ...
    @property
    def frame_rate_hz(self) -> float: ...

def read(path: Path, *, side: str, frame_rate_hz: Optional[float], unit: str, up_axis: str,
         metres_per_unit: Optional[float], joint_map: Mapping[str, str],
         resample_hz: Optional[float], layout: str = "", body_model: str = "") -> List[Person]: ...
def write(document: str, path: Path) -> None: ...
def estimate_vertical(documents: List[str]) -> Dict[str, Any]: ...
