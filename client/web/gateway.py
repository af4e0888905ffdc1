#!/usr/bin/env python3
"""A page in the browser that talks with a Duet server, and what stands between the two.

    client/web/gateway.py --server localhost:50051 --listen 127.0.0.1:8080

Browsers speak gRPC-web, which gRPC's own servers do not. This translates the calls of
duet.v1.MotionSynthesis, reads and writes motion files by the program `duet`, and serves the page.
It has one user's rights and no passwords: other machines reach it through a proxy that has.
"""

import argparse
import http.server
import json
import pathlib
import re
import sys
import tempfile
import threading
import urllib.parse
import zipfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parent / "python"), str(HERE.parent / "viewer")]

import duet_motion as duet  # noqa: E402
import element  # noqa: E402
import grpc_web  # noqa: E402

MAX_BODY_BYTES = 32 * 2**20  # a request's limit at the server
FOLDERS = {
    "/": HERE / "page",
    "/samples/": HERE.parents[1] / "samples",
}
TYPES = {".html": "text/html; charset=utf-8", ".js": "text/javascript; charset=utf-8",
         ".css": "text/css; charset=utf-8", ".bvh": "text/plain; charset=utf-8"}
# Nothing from elsewhere, and no page of others around this one.
POLICY = ("default-src 'self'; img-src 'self' data: blob:; frame-ancestors 'none'; "
          "base-uri 'none'; form-action 'none'")
FILE_NAME = re.compile(r"[\w.-]+")
WRITTEN = ("glb", "bvh", "csv", "json", "html")  # of these, those that `duet` can write


class Refused(Exception):
    """A request that makes no sense: an HTTP status and what to tell."""

    def __init__(self, status, message):
        super().__init__(message)
        self.status, self.message = status, message


def read_leader(name, body):
    """The first person of an uploaded file as "duet-motion" JSON; `name` gives the format."""
    if not FILE_NAME.fullmatch(name) or name.startswith("."):
        raise Refused(400, f"name: {name!r}, wanted a file's name of letters, digits, - . _")
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / name
        path.write_bytes(body)
        try:
            motion = duet.read_motion(path)
        except duet.MotionFileError as error:
            # The file's place on this machine is nobody's business.
            raise Refused(422, str(error).replace(f"{folder}/", "")) from error
    return {"joint_names": motion.joint_names, "frame_rate_hz": motion.frame_rate_hz,
            "leader": motion.positions.tolist()}


def write_pair(kind, body):
    """The bytes of a pair, given as "duet-motion" JSON, in another format, and its file's name."""
    if kind not in WRITTEN:
        raise Refused(400, f"format: {kind!r}, wanted one of {', '.join(WRITTEN)}")
    try:
        given = json.loads(body)
        leader, follower = (duet.Motion(given[role], given["joint_names"], given["frame_rate_hz"])
                            for role in ("leader", "follower"))
    except (KeyError, TypeError, ValueError) as error:
        raise Refused(400, f"body: {error!r}, wanted a pair as duet-motion JSON") from error
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / f"reaction.{kind}"
        try:
            if kind == "html":
                duet.write_page(path, {"reaction": (leader, follower)})
            else:
                duet.write_motion(path, leader, follower)
        except ValueError as error:
            raise Refused(422, str(error).replace(f"{folder}/", "")) from error
        files = sorted(pathlib.Path(folder).iterdir())
        if len(files) == 1:
            return path.name, files[0].read_bytes()
        archive = pathlib.Path(folder) / "reaction.zip"
        with zipfile.ZipFile(archive, "w", zipfile.ZIP_DEFLATED) as out:
            for file in files:
                out.write(file, file.name)
        return archive.name, archive.read_bytes()


def writable():
    """The formats that the program `duet` at hand writes, found by trying."""
    pair = {"joint_names": [], "frame_rate_hz": 30}
    sample = duet.read_motion(HERE.parents[1] / "samples" / "kick.bvh").frames(0, 2)
    pair.update(joint_names=sample.joint_names, leader=sample.positions.tolist(),
                follower=sample.positions.tolist())
    body = json.dumps(pair)

    def works(kind):
        try:
            return bool(write_pair(kind, body))
        except Refused:
            return False
    return [kind for kind in WRITTEN if works(kind)]


class Handler(http.server.BaseHTTPRequestHandler):
    """One connection of a browser."""

    protocol_version = "HTTP/1.1"
    timeout = 60  # for a browser that says nothing

    def do_GET(self):
        self._answer(self._get)

    def do_POST(self):
        self._answer(self._post)

    def _answer(self, method):
        try:
            method(urllib.parse.urlsplit(self.path))
        except Refused as refused:
            self.close_connection = True  # what is left of its body is not read
            self._reply(refused.status, "text/plain; charset=utf-8", refused.message.encode())
        except (BrokenPipeError, ConnectionResetError):
            self.close_connection = True  # the browser went away

    def _get(self, url):
        if url.path == "/about.json":
            about = {"formats": self.server.formats,
                     "samples": sorted(file.stem for file in FOLDERS["/samples/"].glob("*.bvh"))}
            self._reply(200, "application/json", json.dumps(about).encode())
            return
        if url.path == "/duet-motion.js":
            self._reply(200, TYPES[".js"], self.server.element)
            return
        folder, name = url.path.rsplit("/", 1)
        file = FOLDERS.get(f"{folder}/", HERE / "nowhere") / (name or "index.html")
        if file.suffix not in TYPES or not file.is_file():
            raise Refused(404, f"{url.path}: not here")
        self._reply(200, TYPES[file.suffix], file.read_bytes())

    def _post(self, url):
        if url.path in grpc_web.METHODS:
            grpc_web.forward(self, self.server.channel, url.path, self._body())
            return
        query = dict(urllib.parse.parse_qsl(url.query))
        if url.path == "/read":
            with self.server.conversions:
                leader = read_leader(query.get("name", ""), self._body())
            self._reply(200, "application/json", json.dumps(leader).encode())
        elif url.path == "/write":
            with self.server.conversions:
                name, data = write_pair(query.get("format", ""), self._body())
            self._reply(200, "application/octet-stream", data,
                        {"Content-Disposition": f'attachment; filename="{name}"'})
        else:
            raise Refused(404, f"{url.path}: not here")

    def _body(self):
        # A page of another origin may not post JSON or files here in its visitor's name.
        origin = self.headers.get("Origin")
        if origin is not None and urllib.parse.urlsplit(origin).netloc != self.headers.get("Host"):
            raise Refused(403, f"Origin: {origin}, wanted this page's own")
        length = self.headers.get("Content-Length", "")
        if not length.isdecimal():
            raise Refused(411, "Content-Length: absent, wanted the body's")
        if int(length) > MAX_BODY_BYTES:
            raise Refused(413, f"body: {length} bytes, wanted at most {MAX_BODY_BYTES}")
        return self.rfile.read(int(length))

    def _reply(self, status, kind, data, headers=()):
        self.send_response(status)
        self.send_header("Content-Type", kind)
        self.send_header("Content-Length", str(len(data)))
        self.send_header("Content-Security-Policy", POLICY)
        self.send_header("X-Content-Type-Options", "nosniff")
        self.send_header("Cache-Control", "no-cache")
        for name, value in dict(headers).items():
            self.send_header(name, value)
        self.end_headers()
        self.wfile.write(data)

    def log_message(self, template, *values):
        """Requests are the server's to log."""


class Gateway(http.server.ThreadingHTTPServer):
    daemon_threads = True
    request_queue_size = 128  # that wait to be accepted; of more, some are cut off

    def __init__(self, listen, server, tls=None):
        host, _, port = listen.rpartition(":")
        self.channel = grpc_web.connect(server, tls)
        self.formats = writable()
        self.element = element.script().encode()
        self.conversions = threading.BoundedSemaphore(4)  # programs that run at a time
        super().__init__((host, int(port)), Handler)


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--server", default="localhost:50051", help="the Duet server, HOST:PORT")
    parser.add_argument("--listen", default="127.0.0.1:8080", help="for browsers, HOST:PORT")
    parser.add_argument("--tls-ca", help="encrypt to the server; trust the authorities in this file")
    options = parser.parse_args(arguments)
    tls = duet.TlsOptions.from_files(ca=options.tls_ca) if options.tls_ca else None
    gateway = Gateway(options.listen, options.server, tls)
    print(f"http://{gateway.server_address[0]}:{gateway.server_address[1]}", flush=True)
    try:
        gateway.serve_forever()
    except KeyboardInterrupt:
        gateway.server_close()
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
