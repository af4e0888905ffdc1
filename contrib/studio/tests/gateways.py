"""A running gateway of contrib/studio, and raw requests to it."""

import contextlib
import importlib.metadata
import importlib.util
import json
import os
import pathlib
import re
import socket
import ssl
import subprocess
import sys

import tools

WEB = tools.SOURCE / "contrib" / "studio"
NEEDED = (("grpc", "python3-grpcio"), ("numpy", "python3-numpy"), ("aiohttp", "python3-aiohttp"))
GRPC_WEB = "application/grpc-web+proto"


def prepare():
    """Makes the Python package and the program duet available; without a module, skips the test."""
    for module, package in NEEDED:
        if importlib.util.find_spec(module) is None:
            tools.skip(f"no Python module {module}; install the package {package}")
    sys.path.insert(0, str(tools.SOURCE / "client" / "python"))
    os.environ["DUET_PROGRAM"] = str(tools.PROGRAMS / "duet")


def has_new_aiohttp():
    """Whether aiohttp is newer than Debian 12's 3.8: more tolerant of requests, and it checks the length of a
    WebSocket frame only when it has all of it."""
    return tuple(int(part) for part in importlib.metadata.version("aiohttp").split(".")[:2]) > (3, 8)


# AddressSanitizer reserves address space for the whole range.
SANITIZED_BOUNDS = "conversions.PROGRAM_BYTES = 2**47" if tools.SANITIZED else ""


class Gateway:
    """gateway.py on a free port. `bounds` are assignments to its modules, such as
    "serving.HEADER_SECONDS = 0.2"."""

    def __init__(self, server, *flags, bounds=""):
        program = (f"import sys; sys.path.insert(0, {str(WEB)!r})\n"
                   f"import gateway, grpc_web, serving, uploads, conversions, live_socket\n"
                   f"{SANITIZED_BOUNDS}\n{bounds}\n"
                   "sys.exit(gateway.main(sys.argv[1:]))")
        self.log = []
        self._process = subprocess.Popen(
            [sys.executable, "-B", "-c", program, "--server", server, "--listen", "127.0.0.1:0",
             *flags], stdout=subprocess.PIPE, text=True,
            env={**os.environ, "DUET_PROGRAM": str(tools.PROGRAMS / "duet")})
        self.url = self._process.stdout.readline().strip()
        self.port = int(self.url.rpartition(":")[2])

    @property
    def pid(self):
        return self._process.pid

    def send(self, number):
        self._process.send_signal(number)

    def peak_mebibytes(self):
        """Its peak memory."""
        status = pathlib.Path(f"/proc/{self.pid}/status").read_text(encoding="ascii")
        return int(re.search(r"VmHWM:\s*(\d+) kB", status)[1]) / 1024

    def stop(self):
        self._process.terminate()
        try:
            return self._process.wait(tools.STOP_SECONDS)
        finally:
            self._process.kill()
            self._process.wait(tools.STOP_SECONDS)
            self._process.stdout.close()


class GatewayTest(tools.ServedTest):
    """Tests that share a server and a gateway in front of it."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.gateway = Gateway(cls.server.address)
        cls.addClassCleanup(cls.gateway.stop)

    def started(self, *flags, bounds=""):
        """Another gateway in front of the server."""
        gateway = Gateway(self.server.address, *flags, bounds=bounds)
        self.addCleanup(gateway.stop)
        return gateway


def connect(port):
    return socket.create_connection(("127.0.0.1", port), tools.RUN_SECONDS)


def answers(data):
    """The answers in what a connection gave until it was closed: [(status, headers, body), ...]."""
    found = []
    while data:
        head, _, data = data.partition(b"\r\n\r\n")
        lines = head.decode("latin-1").split("\r\n")
        status = int(lines[0].split(" ")[1])
        headers = {name.lower(): value for name, value in
                   (line.split(": ", 1) for line in lines[1:])}
        body, data = split_body(headers, data)
        if status != 100:
            found.append((status, headers, body))
    return found


def split_body(headers, data):
    """The body at the beginning of `data`, and what follows it."""
    if headers.get("transfer-encoding") != "chunked":
        length = int(headers.get("content-length", 0))
        return data[:length], data[length:]
    body = b""
    while True:
        size, _, data = data.partition(b"\r\n")
        body += data[:int(size, 16)]
        data = data[int(size, 16) + 2:]
        if size == b"0":
            return body, data


def read_all(connection):
    """What comes until the other side closes the connection. Where it closes it on bytes that it
    has not read, the system reports a reset behind them."""
    found = b""
    with contextlib.suppress(ConnectionError, ssl.SSLError):
        while more := connection.recv(65536):
            found += more
    return found


def ask_raw(port, data):
    """The answers to raw bytes, until the gateway closes the connection."""
    with connect(port) as connection:
        with contextlib.suppress(ConnectionError):
            connection.sendall(data)
        return answers(read_all(connection))


def message_of(body):
    """The message of a rejection, which must be JSON."""
    return json.loads(body)["error"]["message"]


def post(path, body=b"", **headers):
    """A request as bytes; the connection is closed after its answer."""
    lines = {"Host": "localhost", "Content-Length": len(body), "Connection": "close",
             **{name.replace("_", "-"): value for name, value in headers.items()}}
    head = "".join(f"{name}: {value}\r\n" for name, value in lines.items() if value is not None)
    return f"POST {path} HTTP/1.1\r\n{head}\r\n".encode("latin-1") + body


def framed(message):
    return b"\0" + len(message).to_bytes(4, "big") + message
