"""One call as steps: what is sent of it, piece by piece, and where the sender waits.

A step is a list, ["send", bytes] or [wait, stream]; `wait` is "begun" (until the server sends the first
frame of the stream) or "ended" (until it closes the stream, or the connection)."""

import http2_client as http2
from wire import corpus

CANCEL = 8
PADDED = 0x8
WRONG_LENGTHS = (0, 1, 4, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF)


def plain(stream, method, *messages):
    """A call as a library would send it, and what is waited for: its end, or its beginning if it has
    none."""
    body = b"".join(map(http2.message, messages))
    yield ["send", headers(stream, "/" + method) + data(stream, body, end=True)]
    if method in corpus.ENDLESS:
        yield ["begun", stream]
        yield ["send", reset(stream)]
    else:
        yield ["ended", stream]


def odd(stream, method, messages, random, reading=True):
    """A call whose headers, ending or framing of the last message may be anything. It is waited for where the server ends it
    by itself: those of MotionSynthesis give up a request that never comes, Synthesize also an answer
    that is never read (unless `reading`); those of the admin port and gRPC's own give up neither."""
    path = "/" + method
    gives_up = method.startswith(corpus.SYNTHESIS) if reading else method == corpus.SYNTHESIZE
    block = http2.request_headers(path)
    if random.random() < 0.15:
        block = odd_headers(path, random)
    flags = http2.END_HEADERS | (http2.END_STREAM if random.random() < 0.03 else 0)
    yield ["send", http2.frame(http2.HEADERS, flags, stream, block)]
    *before, message = messages
    body = b"".join(map(http2.message, before))
    body += http2.message(message) if random.random() < 0.6 else odd_message(message, random)
    end = random.choice(("with it", "with it", "with it", "after it", "trailers", "reset", "reset",
                         "reset once begun", "never"))
    ends = gives_up or (reading and end in ("with it", "after it", "trailers"))
    if method in corpus.ENDLESS or end == "reset once begun" and not gives_up:
        end = "reset"
    for piece, last in pieces(body, random):
        yield ["send", data(stream, piece, end=last and end == "with it",
                            padding=random.choice((0, 0, 0, 1, 255)))]
    if end == "after it":
        yield ["send", data(stream, b"", end=True)]
    elif end == "trailers":
        yield ["send", http2.frame(http2.HEADERS, http2.END_HEADERS | http2.END_STREAM, stream,
                                   http2.literal("x-trailer", "1"))]
    elif end == "reset once begun":
        yield ["begun", stream]
    if end.startswith("reset"):
        yield ["send", reset(stream, random.choice((CANCEL, CANCEL, 0, 2, 0xFFFFFFFF)))]
    elif ends and random.random() < 0.7:
        yield ["ended", stream]


def headers(stream, path, extra=()):
    return http2.frame(http2.HEADERS, http2.END_HEADERS, stream, http2.request_headers(path, extra))


def data(stream, piece, end, padding=0):
    flags = (http2.END_STREAM if end else 0) | (PADDED if padding else 0)
    if padding:
        piece = bytes((padding,)) + piece + bytes(padding)
    return http2.frame(http2.DATA, flags, stream, piece)


def reset(stream, code=CANCEL):
    return http2.frame(http2.RST_STREAM, 0, stream, code.to_bytes(4, "big"))


def odd_message(message, random):
    """gRPC's framing of a message with a wrong length, a flag, parts missing or too much after it."""
    kind = random.randrange(7)
    if kind == 0:
        return random.choice((1, 1, 2, 128, 255)).to_bytes(1, "big") + http2.message(message)[1:]
    if kind == 1:
        length = random.choice((*WRONG_LENGTHS, len(message) + 1, max(0, len(message) - 1)))
        return b"\0" + length.to_bytes(4, "big") + message
    if kind == 2:
        return http2.message(message)[:random.randrange(5)]
    if kind == 3:
        return http2.message(message) * random.choice((2, 2, 20))
    if kind == 4:
        return http2.message(message) + http2.message(b"")
    if kind == 5:
        return http2.message(message) + random.randbytes(random.randrange(1, 9))
    return b""


def odd_headers(path, random):
    """A header block that no library would send."""
    junk = "".join(chr(random.randrange(33, 127)) for _ in range(random.randrange(1, 40)))
    extra = random.choice((
        ("grpc-encoding", "gzip"), ("grpc-encoding", junk), ("grpc-accept-encoding", junk),
        ("grpc-timeout", "1n"), ("grpc-timeout", "0S"), ("grpc-timeout", "1m"),
        ("grpc-timeout", "99999999H"), ("grpc-timeout", junk), ("x-request-id", junk * 3),
        ("traceparent", junk), ("authorization", junk), ("authorization", "Bearer "),
        ("x-junk-bin", junk), ("content-type", "text/plain"), ("content-length", junk),
        ("Upper-Case", "1"), (":path", path), (":status", "200"), ("x-late\n", "1"), ("", "")))
    block = http2.request_headers(path, [extra])
    kind = random.randrange(4)
    if kind == 0:
        return block[:random.randrange(len(block))]
    if kind == 1:
        return http2.request_headers(random.choice(("", "/", path + "x", path[1:], "/" + junk)))
    if kind == 2:
        at = random.randrange(len(block))
        return block[:at] + random.randbytes(1) + block[at + 1:]
    return block


def pieces(body, random):
    """A body cut into DATA frames, as (bytes, whether it is the last)."""
    kind = random.randrange(5)
    if kind == 0 and len(body) < 40:
        cuts = range(1, len(body))
    elif kind < 3:
        cuts = sorted(random.randrange(len(body) + 1) for _ in range(kind))
    else:
        cuts = []
    cuts = [0, *cuts, len(body)]
    # A frame holds at most 16 KiB unless the receiver says otherwise.
    spans = [(begin, min(begin + 16384 - 256, b)) for a, b in zip(cuts, cuts[1:])
             for begin in (range(a, b, 16384 - 256) or (a,))]
    for i, (begin, end) in enumerate(spans):
        yield body[begin:end], i == len(spans) - 1
