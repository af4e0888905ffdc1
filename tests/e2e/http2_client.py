"""HTTP/2 and gRPC by hand (RFC 9113, RFC 7541 without its tables), for clients that do what no
library would: read nothing, send a byte a second, reset at once."""

import socket
import struct

DATA, HEADERS, RST_STREAM, SETTINGS, PING, GOAWAY, WINDOW_UPDATE = 0, 1, 3, 4, 6, 7, 8
END_STREAM, ACK, END_HEADERS = 1, 1, 4
PREFACE = b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n"
SETTING_INITIAL_WINDOW = 4
SILENCE_SECONDS = 120  # a server that says nothing for so long, on a busy machine, has hung up


def frame(kind, flags, stream, payload=b""):
    return struct.pack(">I", len(payload))[1:] + bytes((kind, flags)) + struct.pack(
        ">I", stream) + payload


def literal(name, value):
    """A header field that enters no table."""
    text = b"\x00"
    for part in (name.encode(), value.encode()):
        assert len(part) < 127
        text += bytes((len(part),)) + part
    return text


def request_headers(path, extra=(), scheme="http"):
    fields = [(":method", "POST"), (":scheme", scheme), (":path", path), (":authority", "test"),
              ("content-type", "application/grpc"), ("te", "trailers"), *extra]
    return b"".join(literal(*field) for field in fields)


def message(payload):
    """A gRPC message as it travels."""
    return b"\x00" + struct.pack(">I", len(payload)) + payload


def initial_window(settings):
    """How many bytes a stream may begin with."""
    values = dict(struct.iter_unpack(">HI", settings))
    return values.get(SETTING_INITIAL_WINDOW, 65535)


class Connection:
    """One connection, blocking. With `window` the server may send so many bytes of each stream;
    `greeting` replaces the preface and the settings that a client must begin with."""

    def __init__(self, port, source="127.0.0.1", window=None, host="127.0.0.1", greeting=None,
                 patience=SILENCE_SECONDS):
        self.socket = socket.create_connection((host, port), patience, source_address=(source, 0))
        settings = b"" if window is None else struct.pack(">HI", SETTING_INITIAL_WINDOW, window)
        if greeting is None:
            greeting = PREFACE + frame(SETTINGS, 0, 0, settings)
        self.socket.sendall(greeting)
        self.silent = False  # whether frames() ended because nothing came for `patience` seconds
        self.next_stream = 1
        self.credit = 65535  # bytes of all streams that the server takes now

    def close(self):
        self.socket.close()

    def open(self, path, payload=None, extra=(), end=True):
        """Begins a call, with a message of a few kilobytes unless that is None; its stream."""
        stream = self.next_stream
        self.next_stream += 2
        data = frame(HEADERS, END_HEADERS, stream, request_headers(path, extra))
        if payload is not None:
            body = message(payload)
            while self.credit < len(body):
                next(self.frames())
            self.credit -= len(body)
            pieces = [body[at:at + 16384] for at in range(0, len(body), 16384)]
            for i, piece in enumerate(pieces):
                last = end and i == len(pieces) - 1
                data += frame(DATA, END_STREAM if last else 0, stream, piece)
        self.socket.sendall(data)
        return stream

    def upload(self, path, payload, end=True):
        """Sends a message as fast as the server takes it, all but its last byte unless `end`; then reads until the call
        or the connection is over."""
        stream, body = self.open(path), message(payload)
        sent, stop, room_of_stream = 0, len(body) - (not end), 65535
        frames = self.frames()
        while True:
            while (room := min(16384, stop - sent, self.credit, room_of_stream)) > 0:
                piece, sent = body[sent:sent + room], sent + room
                self.credit -= room
                room_of_stream -= room
                self.socket.sendall(frame(DATA, END_STREAM if sent == len(body) else 0, stream, piece))
            kind, flags, number, payload = next(frames, (RST_STREAM, 0, stream, b""))
            if kind == SETTINGS and not flags & ACK:
                room_of_stream += initial_window(payload) - 65535
            if number == stream and kind == WINDOW_UPDATE:
                room_of_stream += int.from_bytes(payload, "big")
            if number == stream and (kind == RST_STREAM or kind == HEADERS and flags & END_STREAM):
                return

    def frames(self):
        """What the server sends, as (kind, flags, stream, payload), until it ends or a time-out."""
        while True:
            head = self._read(9)
            if head is None:
                return
            length = int.from_bytes(head[:3], "big")
            payload = self._read(length)
            if payload is None:
                return
            kind, flags = head[3], head[4]
            if kind == SETTINGS and not flags & ACK:
                self.socket.sendall(frame(SETTINGS, ACK, 0))
            if kind == PING and not flags & ACK:
                self.socket.sendall(frame(PING, ACK, 0, payload))
            if kind == WINDOW_UPDATE and int.from_bytes(head[5:], "big") == 0:
                self.credit += int.from_bytes(payload, "big")
            yield kind, flags, int.from_bytes(head[5:], "big") & 0x7FFFFFFF, payload

    def _read(self, count):
        data = b""
        while len(data) < count:
            try:
                piece = self.socket.recv(count - len(data))
            except TimeoutError:
                self.silent = True
                return None
            except OSError:
                return None
            if not piece:
                return None
            data += piece
        return data
