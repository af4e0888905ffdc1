"""Translates field names in errors from the wire to arrays.

On the wire a motion is one flat list of numbers, so a server rejects ``leader.positions[147]``.
Callers use arrays, where the same value is ``leader.positions[3, 4, 0]``, the x of a named joint.
"""

from __future__ import annotations

import dataclasses
import re
from typing import Match

from duet_motion.errors import DuetError
from duet_motion.motion import Motion, place

_FLAT = re.compile(r"\b(leader|follower_start\.pose)\.positions\[(\d+)\]")


def with_joint_names(error: DuetError, leader: Motion) -> DuetError:
    """The same error with array indices and joint names in its fields and messages."""
    def index(match: Match[str]) -> str:
        frame, joint, axis = _place(leader, match)
        if match[1] == "leader":
            return f"leader.positions[{frame}, {joint}, {axis}]"
        return f"follower_start[{joint}, {axis}]"

    def index_and_name(match: Match[str]) -> str:
        frame, joint, axis = _place(leader, match)
        return f"{index(match)} ({place(frame, leader.joint_names[joint], axis)})"

    def name(field: str, description: str) -> str:
        match = _FLAT.search(field)
        if match is None:
            return description
        frame, joint, axis = _place(leader, match)
        return f"{place(frame, leader.joint_names[joint], axis)}: {description}"

    violations = tuple(
        dataclasses.replace(violation, field=_FLAT.sub(index, violation.field),
                            description=name(violation.field, violation.description))
        for violation in error.violations)
    return type(error)(error.code, _FLAT.sub(index_and_name, error.message), violations,
                       error.reason, error.retry_delay)


def _place(leader: Motion, match: Match[str]) -> tuple[int, int, int]:
    """The frame, joint and axis of a flat index."""
    value = int(match[2])
    return (value // (3 * leader.joint_count), value // 3 % leader.joint_count, value % 3)
