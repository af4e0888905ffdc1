"""Maps the names of enum values in Python to those on the wire."""

from __future__ import annotations

from duet_motion.v1 import motion_pb2, reaction_pb2, synthesis_pb2

UNITS = {
    "metres": motion_pb2.LENGTH_UNIT_METRES,
    "millimetres": motion_pb2.LENGTH_UNIT_MILLIMETRES,
    "sbu-normalised": motion_pb2.LENGTH_UNIT_SBU_NORMALISED,
}
UP_AXES = {
    "y-up": motion_pb2.UP_AXIS_Y_UP,
    "z-up": motion_pb2.UP_AXIS_Z_UP,
    "y-down": motion_pb2.UP_AXIS_Y_DOWN,
}
PRIORITIES = {
    "interactive": synthesis_pb2.PRIORITY_INTERACTIVE,
    "bulk": synthesis_pb2.PRIORITY_BULK,
}
CLEAN_UP = {
    None: reaction_pb2.CLEAN_UP_UNSPECIFIED,
    True: reaction_pb2.CLEAN_UP_ON,
    False: reaction_pb2.CLEAN_UP_OFF,
}
