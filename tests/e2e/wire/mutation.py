"""Changes to a request: bytes as tests/fuzz/mutation.cc changes them, and fields of the message."""

from wire import protobuf
from wire.protobuf import Field

LONGEST_STRETCH = 64
MOST_CHANGES = 4
LONGEST_REQUEST = 30000  # so that two of them fit into HTTP/2's first window
EXTREME_INTEGERS = (0, 1, 127, 128, 2**31 - 1, 2**31, 2**32 - 1, 2**32, 2**63 - 1, 2**63, 2**64 - 1)
# 0, -0, infinities, NaNs, the largest and the smallest numbers, as float and as double.
EXTREME_FLOATS = tuple(bytes.fromhex(text) for text in (
    "00000000", "00000080", "0000807f", "000080ff", "0000c07f", "ffff7f7f", "01000000"))
EXTREME_DOUBLES = tuple(bytes.fromhex(text) for text in (
    "0000000000000000", "0000000000000080", "000000000000f07f", "000000000000f0ff",
    "000000000000f87f", "ffffffffffffef7f", "0100000000000000", "0000000000002e40"))


def systematic(request):
    """Every simple change of one request, smallest first: empty, one byte, each field alone, without
    it, twice, twenty times, emptied, and the message cut short at up to 40 places."""
    yield b""
    for byte in (0x00, 0x01, 0x08, 0x0a, 0x7f, 0x80, 0xff):
        yield bytes((byte,))
    for path in paths(request):
        for fields in ([path[-1]], [path[-1]] * 2, [path[-1]] * 20, [emptied(path[-1])]):
            yield wrapped(path[:-1], protobuf.encode(fields))
        yield without(request, path)
    for i in range(1, 41):
        yield request[:len(request) * i // 41]
    yield request * 2
    yield request


def paths(request, above=(), depth=3):
    """Each field of a message and of the messages in it, with those that it is in, outermost first. Of
    repeated fields only the first."""
    seen = set()
    for field in protobuf.parse(request) or ():
        if field.number in seen:
            continue
        seen.add(field.number)
        yield (*above, field)
        if field.kind == protobuf.LENGTH_DELIMITED and field.value and depth > 1:
            yield from paths(field.value, (*above, field), depth - 1)


def wrapped(above, data):
    """A message inside those that `above` names, each of which holds nothing else."""
    for field in reversed(above):
        data = Field(field.number, field.kind, data).encoded()
    return data


def emptied(field):
    if field.kind == protobuf.VARINT:
        return Field(field.number, field.kind, 0)
    size = {protobuf.FIXED32: 4, protobuf.FIXED64: 8}.get(field.kind, 0)
    return Field(field.number, field.kind, bytes(size))


def without(request, path):
    """A message less the field that a path leads to."""
    kept = []
    for field in protobuf.parse(request):
        if field.number != path[0].number:
            kept.append(field)
        elif len(path) > 1:
            kept.append(Field(field.number, field.kind, without(field.value, path[1:])))
    return protobuf.encode(kept)


def mutated(request, other, random):
    """A request with one to four things changed. The same for the same state of `random`."""
    for _ in range(random.randint(1, MOST_CHANGES)):
        change = random.choice((change_bytes, change_bytes, change_field, change_field, nest))
        request = change(request, other, random)[:LONGEST_REQUEST]
    return request


def change_bytes(data, other, random):
    data = bytearray(data)
    at = random.randrange(len(data) + 1)
    change = random.randrange(6)
    if change == 0 and at < len(data):
        data[at] ^= 1 << random.randrange(8)
    elif change == 1 and at < len(data):
        data[at] = random.randrange(256)
    elif change == 2:
        del data[at:at + 1 + random.randrange(LONGEST_STRETCH)]
    elif change == 3:
        data[at:at] = stretch(data, random)
    elif change == 4:
        data[at:at] = stretch(other, random)
    else:
        del data[at:]
    return bytes(data)


def stretch(data, random):
    at = random.randrange(len(data) + 1)
    return bytes(data[at:at + 1 + random.randrange(LONGEST_STRETCH)])


def change_field(data, other, random):
    """Changes a field of the message, or of one in it: its value, number, kind, place or count."""
    fields = protobuf.parse(data)
    if not fields:
        return change_bytes(data, other, random)
    i = random.randrange(len(fields))
    field = fields[i]
    change = random.randrange(7)
    if change == 0:
        del fields[i]
    elif change == 1:
        fields[i:i] = [field] * random.choice((1, 2, 100))
    elif change == 2:
        random.shuffle(fields)
    elif change == 3:
        fields[i] = Field(random.choice((1, 2, 3, 15, 16, 1000, 2**29 - 1)), field.kind, field.value)
    elif change == 4:
        fields += protobuf.parse(other) or []
    elif field.kind == protobuf.LENGTH_DELIMITED:
        fields[i] = Field(field.number, field.kind, change_field(field.value, other, random))
    else:
        choices = {protobuf.VARINT: EXTREME_INTEGERS, protobuf.FIXED32: EXTREME_FLOATS,
                   protobuf.FIXED64: EXTREME_DOUBLES}
        fields[i] = Field(field.number, field.kind, random.choice(choices[field.kind]))
    return protobuf.encode(fields)


def nest(data, _, random):
    """Puts the message into itself, up to deeper than a parser follows."""
    if len(data) > 1024:
        return data
    number = random.choice((1, 2, 3, 4, 5))
    for _ in range(random.choice((1, 2, 10, 150))):
        data = Field(number, protobuf.LENGTH_DELIMITED, data).encoded()
    return data
