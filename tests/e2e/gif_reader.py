"""Reads animated GIFs (GIF 89a, W3C)."""

import dataclasses
import struct


@dataclasses.dataclass
class Frame:
    hundredths: int  # how long it is shown
    pixels: list     # (red, green, blue), row by row, as they are seen


class Gif:
    """All frames of a file in which every frame covers the whole picture."""

    def __init__(self, data):
        assert data[:6] == b"GIF89a", data[:6]
        self.width, self.height, flags = struct.unpack("<HHB", data[6:11])
        count = 2 << (flags & 7)
        assert flags & 0x80, "no palette for all frames"
        self.palette = [tuple(data[13 + 3 * i:16 + 3 * i]) for i in range(count)]
        self.repeats = False
        self.frames = []
        self._data, self._at = data, 13 + 3 * count
        self._read()

    def _take(self, count):
        taken = self._data[self._at:self._at + count]
        assert len(taken) == count, "cut short"
        self._at += count
        return taken

    def _blocks(self):
        all_blocks = b""
        while size := self._take(1)[0]:
            all_blocks += self._take(size)
        return all_blocks

    def _read(self):
        seen = [(0, 0, 0)] * (self.width * self.height)
        hundredths, transparent = 0, None
        while (kind := self._take(1)) != b";":
            if kind == b"!":
                label = self._take(1)[0]
                content = self._blocks()
                if label == 0xF9:
                    flags, hundredths, index = struct.unpack("<BHB", content)
                    transparent = index if flags & 1 else None
                    assert flags >> 2 & 7 == 1, "expected frames that stay"
                self.repeats = self.repeats or content.startswith(b"NETSCAPE2.0")
                continue
            assert kind == b",", kind
            left, top, width, height, flags = struct.unpack("<HHHHB", self._take(9))
            assert (left, top, width, height, flags) == (0, 0, self.width, self.height, 0)
            values = unpack(self._take(1)[0], self._blocks())
            assert len(values) == len(seen), (len(values), len(seen))
            seen = [before if value == transparent else self.palette[value]
                    for before, value in zip(seen, values)]
            self.frames.append(Frame(hundredths, seen))
        assert self._at == len(self._data), "more follows the end"


def unpack(bits, data):
    """LZW of the format: codes from `bits` + 1 to 12 bits."""
    clear, end = 1 << bits, (1 << bits) + 1
    table, size, before, out = [], bits + 1, None, bytearray()
    window, filled, position = 0, 0, 0
    while True:
        while filled < size:
            window |= data[position] << filled
            position += 1
            filled += 8
        code = window & ((1 << size) - 1)
        window >>= size
        filled -= size
        if code == clear:
            table = [bytes([value]) for value in range(clear)] + [b"", b""]
            size, before = bits + 1, None
            continue
        if code == end:
            assert position == len(data), "more follows the last code"
            return out
        assert code < len(table) or (before is not None and code == len(table)), "no such code"
        entry = table[code] if code < len(table) else before + before[:1]
        out += entry
        if before is not None and len(table) < 4096:
            table.append(before + entry[:1])
            if len(table) == 1 << size and size < 12:
                size += 1
        before = entry
