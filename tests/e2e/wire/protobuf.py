"""Protocol Buffers' wire format by hand: enough to write small messages and to take any apart."""

import dataclasses
import struct

VARINT, FIXED64, LENGTH_DELIMITED, FIXED32 = 0, 1, 2, 5


@dataclasses.dataclass(frozen=True)
class Field:
    """One field of a message: `value` is an int for VARINT, else the bytes without their length."""
    number: int
    kind: int
    value: object

    def encoded(self):
        tag = varint(self.number << 3 | self.kind)
        if self.kind == VARINT:
            return tag + varint(self.value)
        if self.kind == LENGTH_DELIMITED:
            return tag + varint(len(self.value)) + self.value
        return tag + self.value


def varint(value):
    """An unsigned integer of at most 64 bits."""
    out = b""
    while value >= 0x80:
        out += bytes((value & 0x7F | 0x80,))
        value >>= 7
    return out + bytes((value,))


def message(**fields):
    """A message of fields named f1, f2, ...: str and bytes are length-delimited, int a varint, float a
    float. A list is a repeated field."""
    out = b""
    for name, value in ((name, one) for name, given in fields.items()
                        for one in (given if isinstance(given, list) else [given])):
        if isinstance(value, str):
            value = value.encode()
        kind = VARINT
        if isinstance(value, bytes):
            kind = LENGTH_DELIMITED
        elif isinstance(value, float):
            kind, value = FIXED32, struct.pack("<f", value)
        out += Field(int(name[1:]), kind, value).encoded()
    return out


def parse(data):
    """The fields of a message in order; None if the bytes are not one."""
    fields, at = [], 0
    while at < len(data):
        tag, at = _read_varint(data, at)
        if tag is None or tag >> 3 == 0:
            return None
        number, kind = tag >> 3, tag & 7
        if kind == VARINT:
            value, at = _read_varint(data, at)
            if value is None:
                return None
        elif kind in (FIXED64, FIXED32, LENGTH_DELIMITED):
            size = {FIXED64: 8, FIXED32: 4}.get(kind)
            if size is None:
                size, at = _read_varint(data, at)
            if size is None or at + size > len(data):
                return None
            value, at = data[at:at + size], at + size
        else:
            return None
        fields.append(Field(number, kind, value))
    return fields


def _read_varint(data, at):
    value = shift = 0
    while at < len(data) and shift < 64:
        byte = data[at]
        value |= (byte & 0x7F) << shift
        at, shift = at + 1, shift + 7
        if byte < 0x80:
            return value, at
    return None, at


def encode(fields):
    return b"".join(field.encoded() for field in fields)


def values(data, number):
    """The values of one field of a message, in order."""
    return [field.value for field in parse(data) or () if field.number == number]
