"""Open Sound Control 1.0, as far as motion protocols use it."""

import struct
from typing import Iterator, List, Sequence, Tuple, Union

Value = Union[float, str]
_MAX_DEPTH = 4  # of bundles in bundles
_MAX_ARGUMENTS = 64
_FORMATS = {"i": ">i", "h": ">q", "f": ">f", "d": ">d"}


def messages(datagram: bytes, depth: int = 0) -> Iterator[Tuple[str, str, bytes]]:
    """The address, the types and the arguments' bytes of each message of a datagram, which is one message
    or a bundle.

    Raises:
        ValueError: the datagram is malformed; messages before that place have been yielded.
    """
    if not datagram.startswith(b"#bundle\0"):
        address, rest = _text(datagram)
        types, rest = _text(rest) if address.startswith("/") else ("", b"")
        if not types.startswith(","):
            raise ValueError("OSC: expected an address that begins with '/' and types that begin with ',', "
                             f"got {datagram[:40]!r}")
        yield address, types[1:], rest
        return
    if depth >= _MAX_DEPTH:
        raise ValueError(f"OSC: expected at most {_MAX_DEPTH} levels of bundles, got more")
    at = 16  # after the name and the time
    while at < len(datagram):
        size = int.from_bytes(datagram[at:at + 4], "big")
        if size == 0 or at + 4 + size > len(datagram):
            raise ValueError(f"OSC: expected elements within the bundle, got one of {size} bytes")
        yield from messages(datagram[at + 4:at + 4 + size], depth + 1)
        at += 4 + size


def arguments(types: str, data: bytes) -> List[Value]:
    """The arguments of a message: numbers and texts.

    Raises:
        ValueError: there are too many, of other types, or fewer bytes than they need.
    """
    if len(types) > _MAX_ARGUMENTS:
        raise ValueError(f"OSC: expected at most {_MAX_ARGUMENTS} arguments, got {len(types)}")
    values: List[Value] = []
    for kind in types:
        if kind in "TF":
            values.append(kind == "T")
        elif kind == "s":
            text, data = _text(data)
            values.append(text)
        elif kind in _FORMATS and len(data) >= struct.calcsize(_FORMATS[kind]):
            size = struct.calcsize(_FORMATS[kind])
            values.append(struct.unpack(_FORMATS[kind], data[:size])[0])
            data = data[size:]
        else:
            raise ValueError(f"OSC: expected arguments of the types {types!r}, got too few bytes or an "
                             f"unknown type {kind!r}")
    return values


def message(address: str, types: str, *values: Value) -> bytes:
    """An element of a bundle."""
    data = _padded(address) + _padded("," + types)
    for kind, value in zip(types, values):
        data += _padded(str(value)) if kind == "s" else struct.pack(_FORMATS[kind], value)
    return len(data).to_bytes(4, "big") + data


def bundle(elements: Sequence[bytes]) -> bytes:
    """A bundle of messages that takes effect at once."""
    return _padded("#bundle") + (1).to_bytes(8, "big") + b"".join(elements)


def _text(data: bytes) -> Tuple[str, bytes]:
    """A text that ends with a NUL byte, without its padding to a multiple of 4, and what follows."""
    end = data.find(b"\0")
    if end < 0:
        raise ValueError(f"OSC: expected a text that ends with a zero, got {data[:40]!r}")
    return data[:end].decode("utf-8", "replace"), data[(end // 4 + 1) * 4:]


def _padded(text: str) -> bytes:
    data = text.encode() + b"\0"
    return data + bytes(-len(data) % 4)
