#!/usr/bin/env python3
"""The gateway between the studio, a browser page, and a Duet server.

    contrib/studio/gateway.py --server localhost:50051 --listen 127.0.0.1:8080

Browsers use gRPC-web, which gRPC servers do not support. The gateway translates the calls of
duet.v1.MotionSynthesis, reads and writes motion files with the program `duet`, and serves the page.
It has no user accounts and no passwords: give other machines access only through a proxy that has.
"""

import argparse
import asyncio
import contextlib
import functools
import json
import logging
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
CLIENT = HERE.parents[1] / "client"
sys.path[:0] = [str(CLIENT / "python"), str(CLIENT / "viewer")]

import conversions  # noqa: E402
import duet_motion as duet  # noqa: E402
import element  # noqa: E402
import grpc_web  # noqa: E402
import live_socket  # noqa: E402
import serving  # noqa: E402
import uploads  # noqa: E402
from aiohttp import web  # noqa: E402

SAMPLES = HERE.parents[1] / "samples"
MOVES = HERE / "moves"  # more leaders, for Spar
TYPES = {".html": "text/html", ".js": "text/javascript", ".css": "text/css", ".bvh": "text/plain"}


class Gateway:
    """The handlers of the gateway."""

    def __init__(self, program, backend, live):
        self._program = program
        self._backend = backend
        self.live = live
        self._uploads = uploads.Uploads()

    def routes(self):
        """Returns {path: {method: handler}}. Only this method reads the page's files, once."""
        about = {"formats": list(conversions.FORMATS),
                 "samples": sorted(file.stem for file in SAMPLES.glob("*.bvh")),
                 "moves": sorted(file.stem for file in MOVES.glob("*.bvh"))}
        files = {"/about.json": ("application/json", json.dumps(about)),
                 "/duet-motion.js": (TYPES[".js"], element.script())}
        for folder, prefix in ((HERE / "page", "/"), (SAMPLES, "/samples/"), (MOVES, "/samples/")):
            for file in folder.iterdir():
                if file.suffix in TYPES:
                    files[prefix + file.name] = (TYPES[file.suffix],
                                                 file.read_text(encoding="utf-8"))
        files["/"] = files["/index.html"]
        files["/spar"] = files["/spar.html"]
        routes = {path: {"GET": functools.partial(send_text, kind, text)}
                  for path, (kind, text) in files.items()}
        for path in grpc_web.METHODS:
            routes[path] = {"POST": self.call}
        routes["/live"] = {"GET": self.live.answer}
        routes["/read"] = {"POST": self.read}
        routes["/write"] = {"POST": self.write}
        routes["/write_on_rig"] = {"POST": self.write_on_rig}
        return routes

    async def call(self, request):
        return await grpc_web.forward(request, self._backend, self._uploads)

    async def read(self, request):
        """Converts a motion file to {"notes": [...], "motion": its leader as "duet-motion" JSON}.
        The query has the file's name and the settings for reading it."""
        settings = {name: request.query.getall(name) for name in request.query}
        name = conversions.file_name(settings.pop("name", [""])[0])
        async with self._received(request, name) as folder:
            motion, notes = await self._program.read(folder, name, settings)
            return await conversions.send_file(
                request, motion, "application/json",
                f'{{"notes": {json.dumps(notes)}, "motion": '.encode(), b"}")

    async def write(self, request):
        """Converts a pair in "duet-motion" JSON to a file. The query has its name, format, rate and
        skeleton."""
        query = request.query
        stem = conversions.file_name(query.get("name", "reaction"))
        kind = conversions.format_of(query.get("format", ""))
        resample = query.get("resample", "")
        joints = conversions.own_joints(query.get("skeleton", ""), "pair.json")
        async with self._received(request, "pair.json") as folder:
            file = await self._program.write(folder, "pair.json", kind, stem, resample, joints)
            return await send_download(request, file)

    async def write_on_rig(self, request):
        """Writes the follower of a pair on a rig. The body is a line with the pair in "duet-motion"
        JSON, and the rig's file. The query has the names, the format and settings for the rig's
        file."""
        settings = {name: request.query.getall(name) for name in request.query}
        stem, rig = (conversions.file_name(settings.pop(name, [""])[0]) for name in ("name", "rig"))
        kind = conversions.format_of(settings.pop("format", [""])[0])
        async with self._received(request, "body") as folder:
            (folder / "rig").mkdir()
            await asyncio.to_thread(conversions.take_apart, folder / "body", folder / "pair.json",
                                    folder / "rig" / rig)
            file = await self._program.write_on_rig(folder, "pair.json", f"rig/{rig}", kind, stem,
                                                    settings)
            return await send_download(request, file)

    @contextlib.asynccontextmanager
    async def _received(self, request, name):
        """Yields a folder with the request's body in a file of that name, and removes it
        afterwards."""
        with conversions.workplace() as folder:
            with open(folder / name, "wb") as file:
                async with self._uploads.body(request, file):
                    yield folder


async def send_text(kind, text, request):
    headers = serving.page_headers(request) if kind == TYPES[".html"] else serving.HEADERS
    return web.Response(text=text, content_type=kind, charset="utf-8", headers=headers)


async def send_download(request, file):
    kind = conversions.FORMATS.get(file.suffix[1:], "application/zip")
    return await conversions.send_file(
        request, file, kind,
        headers={"Content-Disposition": f'attachment; filename="{file.name}"'})


async def run(options):
    tls = duet.TlsOptions.from_files(ca=options.tls_ca) if options.tls_ca else None
    program = conversions.Duet()

    def started(address):
        host = f"[{address[0]}]" if ":" in address[0] else address[0]
        print(f"http://{host}:{address[1]}", flush=True)

    # An open channel can prevent the process from ending.
    backend = grpc_web.connect(options.server, tls)
    try:
        gateway = Gateway(program, backend, live_socket.LiveSockets(backend))
        server = serving.Server(gateway.routes(),
                                serving.allowed_hosts(options.listen, options.host))
        await serving.serve(server, options.listen, started, gateway.live.close)
    finally:
        await backend.channel.close()


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--server", default="localhost:50051",
                        help="address of the Duet server, HOST:PORT (default: %(default)s)")
    parser.add_argument("--listen", default="127.0.0.1:8080",
                        help="address to listen on, HOST:PORT (default: %(default)s)")
    parser.add_argument("--host", action="append", default=[], metavar="NAME",
                        help="additional host name of the gateway in URLs, beside localhost, "
                             "127.0.0.1, [::1] and the host of --listen; repeatable")
    parser.add_argument("--tls-ca",
                        help="use TLS to the server and trust the authorities in this file")
    options = parser.parse_args(arguments)
    logging.basicConfig(format="%(name)s: %(message)s", level=logging.WARNING)
    try:
        asyncio.run(run(options))
    except (OSError, ValueError) as error:
        print(f"gateway.py: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
