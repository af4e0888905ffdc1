"""Senders of motion capture, written from the published layouts of the protocols.

A person in a T pose who stands, waves the left arm and sways; every frame as the datagrams of one
protocol. Positions are those of Unity: left-handed, y up, metres.
"""

import json
import math
import pathlib
import struct
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import frames  # noqa: E402

# Bone, parent, offset in Unity's axes: the left hand is at -x.
BONES = tuple((bone, parent, (-x, y, z)) for bone, parent, (x, y, z) in frames.BONES)

XSENS = ("Hips", "Spine", "Spine", "Chest", "UpperChest", "Neck", "Head", "RightShoulder",
         "RightUpperArm", "RightLowerArm", "RightHand", "LeftShoulder", "LeftUpperArm",
         "LeftLowerArm", "LeftHand", "RightUpperLeg", "RightLowerLeg", "RightFoot", "RightToes",
         "LeftUpperLeg", "LeftLowerLeg", "LeftFoot", "LeftToes")

ROKOKO = {"hip": "Hips", "spine": "Spine", "chest": "UpperChest", "neck": "Neck", "head": "Head",
          "leftShoulder": "LeftShoulder", "leftUpperArm": "LeftUpperArm",
          "leftLowerArm": "LeftLowerArm", "leftHand": "LeftHand", "rightShoulder": "RightShoulder",
          "rightUpperArm": "RightUpperArm", "rightLowerArm": "RightLowerArm",
          "rightHand": "RightHand", "leftUpLeg": "LeftUpperLeg", "leftLeg": "LeftLowerLeg",
          "leftFoot": "LeftFoot", "leftToe": "LeftToes", "rightUpLeg": "RightUpperLeg",
          "rightLeg": "RightLowerLeg", "rightFoot": "RightFoot", "rightToe": "RightToes"}


def wave(seconds):
    """The angle of the left arm about z, and the sway of the hips in x."""
    return 0.8 * math.sin(2 * seconds), 0.1 * math.sin(seconds)


def positions(seconds):
    """The positions of all bones."""
    angle, sway = wave(seconds)
    at = {}
    for bone, parent, (x, y, z) in BONES:
        if bone in ("LeftLowerArm", "LeftHand"):
            x, y = x * math.cos(angle) - y * math.sin(angle), x * math.sin(angle) + y * math.cos(angle)
        above = at.get(parent, (sway, 0, 0))
        at[bone] = (above[0] + x, above[1] + y, above[2] + z)
    return at


def osc_text(text):
    data = text.encode() + b"\0"
    return data + bytes(-len(data) % 4)


def osc_bundle(messages):
    return osc_text("#bundle") + struct.pack(">Q", 1) + b"".join(
        struct.pack(">I", len(message)) + message for message in messages)


def vmc(frame, seconds):
    """Two bundles, as senders split a frame."""
    del frame
    angle, sway = wave(seconds)
    messages = [osc_text("/VMC/Ext/OK") + osc_text(",i") + struct.pack(">i", 1),
                osc_text("/VMC/Ext/T") + osc_text(",f") + struct.pack(">f", seconds)]
    for bone, _, (x, y, z) in BONES:
        x += sway if bone == "Hips" else 0
        turn = (0, 0, math.sin(angle / 2), math.cos(angle / 2)) if bone == "LeftUpperArm" else (0, 0, 0, 1)
        messages.append(osc_text("/VMC/Ext/Bone/Pos") + osc_text(",sfffffff") + osc_text(bone)
                        + struct.pack(">7f", x, y, z, *turn))
    return [osc_bundle(messages[:12]), osc_bundle(messages[12:])]


def xsens(frame, seconds):
    at = positions(seconds)
    items = b""
    for segment, bone in enumerate(XSENS, start=1):
        x, y, z = at[bone]
        # Unity's x, y, z to MVN's: forward is x, left is y, up is z.
        items += struct.pack(">I3f4f", segment, z, -x, y, 1, 0, 0, 0)
    return [b"MXTP02" + struct.pack(">IBBIBBBBHH", frame, 0x80, len(XSENS), int(seconds * 1000), 0,
                                    len(XSENS), 0, 0, 0, len(items)) + items]


def rokoko(frame, seconds):
    del frame
    at = positions(seconds)
    body = {joint: {"position": dict(zip("xyz", at[bone])),
                    "rotation": {"x": 0, "y": 0, "z": 0, "w": 1}} for joint, bone in ROKOKO.items()}
    actor = {"name": "Ann", "color": [0, 0, 0],
             "meta": {"hasGloves": False, "hasBody": True, "hasFace": False}, "body": body}
    scene = {"timestamp": seconds, "actors": [actor], "characters": [], "props": []}
    return [json.dumps({"version": "3,0", "fps": 30, "scene": scene}).encode()]

