"""An independent reader and writer of the safetensors format, for tests.

  safetensors_text.py read FILE    prints a line for each tensor: name, shape, values
  safetensors_text.py write FILE   writes FILE from such lines on standard input

Written from the published description alone: 8 bytes of header length, a JSON header, the data.
"""

import json
import struct
import sys


def read(path):
    with open(path, "rb") as file:
        (length,) = struct.unpack("<Q", file.read(8))
        header = json.loads(file.read(length))
        data = file.read()
    header.pop("__metadata__", None)
    for name, entry in header.items():
        assert entry["dtype"] == "F32", entry
        begin, end = entry["data_offsets"]
        values = struct.unpack("<%df" % ((end - begin) // 4), data[begin:end])
        yield name, entry["shape"], values


def write(path, tensors):
    header, data = {"__metadata__": {"writer": "python"}}, b""
    for name, shape, values in tensors:
        packed = struct.pack("<%df" % len(values), *values)
        header[name] = {"dtype": "F32", "shape": shape,
                        "data_offsets": [len(data), len(data) + len(packed)]}
        data += packed
    text = json.dumps(header, indent=1).encode()
    text += b" " * (-len(text) % 8)
    with open(path, "wb") as file:
        file.write(struct.pack("<Q", len(text)) + text + data)


def parse_line(line):
    name, shape, values = line.rstrip("\n").split("\t")
    return (name, [int(size) for size in shape.split(",") if size],
            [float(value) for value in values.split()])


def main():
    mode, path = sys.argv[1:]
    if mode == "read":
        for name, shape, values in read(path):
            print(name, ",".join(map(str, shape)), " ".join(map(repr, values)), sep="\t")
    else:
        write(path, [parse_line(line) for line in sys.stdin])


main()
