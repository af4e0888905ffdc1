"""Plays a round against a server: each connection in a thread of its own."""

import concurrent.futures
import socket
import time

import http2_client as http2

HOSTILE = "127.0.0.2"  # another client than the one whose good calls are compared


class Unanswered(Exception):
    """The server neither ended a call nor closed the connection."""


class Player:
    """`ports` maps "service", "admin" and "metrics" to numbers. A connection on which no call goes on for
    `patience` seconds counts as unanswered."""

    def __init__(self, ports, patience):
        self._ports = ports
        self._patience = patience

    def play(self, connections):
        """Plays all connections of a round at the same time. Raises Unanswered, or OSError if nobody
        listens."""
        with concurrent.futures.ThreadPoolExecutor(len(connections)) as threads:
            for done in [threads.submit(self._play_connection, each) for each in connections]:
                done.result()

    def _play_connection(self, script):
        connection = http2.Connection(self._ports[script["port"]], source=HOSTILE, greeting=b"",
                                      patience=self._patience)
        with connection.socket:
            Conversation(connection, self._patience).run(script["steps"])


class Conversation:
    """What has come on one connection so far."""

    def __init__(self, connection, patience):
        self._connection = connection
        self._patience = patience
        self._frames = connection.frames()
        self._begun, self._ended = set(), set()
        self._closed = False

    def run(self, steps):
        for kind, *argument in steps:
            if self._closed or kind == "close":
                return
            if kind == "send":
                self._send(*argument)
            elif kind == "half-close":
                self._half_close()
            else:
                self._wait(kind, *argument)

    def _send(self, data):
        try:
            self._connection.socket.sendall(data)
        except TimeoutError as error:
            raise Unanswered("the server stopped reading a connection") from error
        except OSError:
            self._closed = True  # it hung up, as it may

    def _half_close(self):
        try:
            self._connection.socket.shutdown(socket.SHUT_WR)
        except OSError:
            return
        end = time.monotonic() + self._patience
        try:
            while self._connection.socket.recv(65536):
                if time.monotonic() > end:
                    raise Unanswered("the server goes on sending to a client that left")
        except TimeoutError as error:
            raise Unanswered("the server kept a connection that its client had closed") from error
        except OSError:
            pass

    def _wait(self, kind, stream):
        end = time.monotonic() + self._patience
        over = self._ended if kind == "ended" else self._begun
        while stream not in over and not self._closed:
            frame = self._next_frame()
            if self._connection.silent or time.monotonic() > end:
                raise Unanswered(f"stream {stream} has not {kind}")
            if frame is None:
                self._closed = True
            elif self._take(*frame):
                end = time.monotonic() + self._patience

    def _next_frame(self):
        """None if the server has closed the connection, or says nothing any more."""
        try:
            return next(self._frames, None)
        except OSError:  # its reader answers settings and pings
            return None

    def _take(self, kind, flags, stream, _):
        """Returns whether a call goes on by this frame."""
        if kind == http2.GOAWAY:
            # Streams that began after what it names get no answer; the rest is of no interest.
            self._closed = True
        if kind not in (http2.HEADERS, http2.DATA, http2.RST_STREAM):
            return False
        self._begun.add(stream)
        if kind == http2.RST_STREAM or flags & http2.END_STREAM:
            self._ended.add(stream)
        return True
