"""Rules for every request to the gateway: permitted hosts and origins, framing, timeouts, and
errors as JSON. aiohttp implements HTTP."""

import asyncio
import json
import logging
import signal

from aiohttp import http_exceptions, web

BACKLOG = 128  # connections that wait to be accepted
# Timeouts in seconds. A whole request includes its answer: the longest gRPC call and its reader.
HEADER_SECONDS = 10
IDLE_SECONDS = 30
REQUEST_SECONDS = 660
SHUTDOWN_SECONDS = 5
# No content from other origins, and no framing by other pages.
POLICY = ("default-src 'self'; img-src 'self' data: blob:; frame-ancestors 'none'; "
          "base-uri 'none'; form-action 'none'")
HEADERS = {
    "Content-Security-Policy": POLICY,
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cache-Control": "no-cache",
    "Server": "duet-gateway",
}
WEB_SOCKETS = ("/live",)  # the paths at which a connection may become a WebSocket
TIME_LIMIT = "duet.time_limit"  # key of a request
THIS_MACHINE = ("localhost", "127.0.0.1", "[::1]")

LOG = logging.getLogger("duet.gateway")


class Refused(Exception):
    """A request fails with an HTTP status and a message for its sender."""

    def __init__(self, status, message, **headers):
        super().__init__(message)
        self.status, self.message, self.headers = status, message, headers


class Rejected(Refused):
    """As Refused, with an unread body or doubtful framing, so the connection is closed."""


def refusal(status, message, headers=()):
    """Creates an error response as JSON."""
    response = web.json_response({"error": {"status": status, "message": message}}, status=status,
                                 headers={**HEADERS, **dict(headers)})
    if status == 503:
        response.headers["Retry-After"] = "5"
    return response


class Connection(web.RequestHandler):
    """A connection. It is closed if no request's header arrives in time, and its request is
    cancelled when the connection is lost."""

    def __init__(self, *arguments, **options):
        super().__init__(*arguments, **options)
        self.answering = None  # the task that answers a request
        self._waiting_for_header = None

    def connection_made(self, transport):
        super().connection_made(transport)
        # aiohttp's timeout for idle connections applies to later headers.
        self._waiting_for_header = self._loop.call_later(HEADER_SECONDS,
                                                         self._close_unless_answering)

    def connection_lost(self, exc):
        self._waiting_for_header.cancel()
        if self.answering:
            self.answering.cancel()
        super().connection_lost(exc)

    def data_received(self, data):
        try:
            super().data_received(data)
        except ValueError:
            # aiohttp does not catch a target that is not a URL. Its parser rejects this byte.
            super().data_received(b"\0")

    def begin(self):
        self.answering = asyncio.current_task()
        self._waiting_for_header.cancel()

    def end(self):
        self.answering = None

    def _close_unless_answering(self):
        if not self.answering:
            self.force_close()

    def handle_error(self, request, status=500, exc=None, message=None):
        """Answers requests that aiohttp cannot read, and unexpected exceptions."""
        if isinstance(exc, ConnectionError):
            raise exc
        if isinstance(exc, http_exceptions.LineTooLong):
            response = refusal(431, "header: expected lines of at most 8190 bytes, got more")
        elif isinstance(exc, http_exceptions.HttpProcessingError):
            response = refusal(400, f"request: expected valid HTTP/1.1, got an error: {message}")
        else:
            LOG.error("%s %s failed", request.method, request.path, exc_info=exc)
            if request.writer.output_size > 0:
                raise ConnectionError("the response has already started")
            response = refusal(500, "the gateway failed; see its log")
        response.force_close()
        return response


class Server(web.Server):
    """Answers requests with `routes`, {path: {method: handler}}. `hosts` are the permitted names in
    the Host header."""

    def __init__(self, routes, hosts):
        super().__init__(self._handle, keepalive_timeout=IDLE_SECONDS, access_log=None,
                         lingering_time=2, logger=LOG)
        self._routes = routes
        self._hosts = {name.lower() for name in hosts}

    def __call__(self):
        return Connection(self, loop=self._loop, **self._kwargs)

    async def _handle(self, request):
        request.protocol.begin()
        try:
            async with asyncio.timeout(REQUEST_SECONDS) as limit:
                request[TIME_LIMIT] = limit
                return await self._answer(request)
        except TimeoutError:
            if request.transport:
                request.transport.abort()  # drop unsent data
            raise ConnectionError("the request took too long") from None
        finally:
            request.protocol.end()

    async def _answer(self, request):
        try:
            self._check(request)
            response = await self._handler_of(request)(request)
        except Refused as refused:
            response = refusal(refused.status, refused.message, refused.headers)
            if isinstance(refused, Rejected):
                response.force_close()
        # Sent here, so that a stalled reader counts towards the request's timeout.
        await response.prepare(request)
        await response.write_eof()
        return response

    def _handler_of(self, request):
        methods = self._routes.get(request.path)
        if methods is None:
            raise Rejected(404, f"path: expected one of the gateway's, got {shown(request.path)}")
        method = "GET" if request.method == "HEAD" else request.method
        if method not in methods:
            allowed = ", ".join(methods)
            raise Rejected(405, f"method: expected {allowed}, got {request.method}", Allow=allowed)
        return methods[method]

    def _check(self, request):
        check_framing(request)
        host = request.headers["Host"]
        if host_name(host) not in self._hosts:
            # DNS rebinding: a page of that name would have the gateway's origin.
            raise Rejected(421, f"Host: expected one of {', '.join(sorted(self._hosts))}, got "
                                f"{shown(host)}; start the gateway with --host NAME to allow it")
        # A page of another origin must not post on behalf of its visitor.
        origin = request.headers.get("Origin")
        if origin is not None and origin.lower() not in (f"http://{host}".lower(),
                                                         f"https://{host}".lower()):
            raise Rejected(403, f"Origin: expected this page's own, got {shown(origin)}")


def check_framing(request):
    """Refuses requests that two readers could take for different ones, and bodies of unknown
    length. aiohttp has refused several lengths, and a length beside a transfer coding."""
    if request.version not in ((1, 0), (1, 1)):
        raise Rejected(505, "version: expected HTTP/1.1, got another")
    if not request.raw_path.startswith("/"):
        raise Rejected(400, f"path: expected one from / on, got {shown(request.raw_path)}")
    if len(request.headers.getall("Host", ())) != 1:
        raise Rejected(400, "Host: expected one, got "
                            f"{len(request.headers.getall('Host', ()))}")
    for name, _ in request.raw_headers:
        if not all(0x21 <= byte <= 0x7e for byte in name):
            raise Rejected(400, "header: expected names without blanks, got one with a blank")
    if "Transfer-Encoding" in request.headers:
        raise Rejected(411, "Transfer-Encoding: expected none, got one; send a Content-Length")
    if request.method != "POST" and request.headers.get("Content-Length", "0").strip("0"):
        raise Rejected(400, f"body: expected none with {request.method}, got one")
    if "Upgrade" in request.headers and request.path not in WEB_SOCKETS:
        raise Rejected(400, "Upgrade: expected none, got one")


def check_upgrade(request):
    """Refuses a request for a WebSocket that is not one. aiohttp checks the key and version."""
    names = {part.strip().lower() for part in request.headers.get("Connection", "").split(",")}
    if (request.method != "GET" or "upgrade" not in names
            or request.headers.get("Upgrade", "").lower() != "websocket"):
        raise Rejected(426, "Upgrade: expected websocket, got something else",
                       Upgrade="websocket", Connection="Upgrade")


def without_time_limit(request):
    """Lifts the time limit of a request that lasts as long as its visitor stays."""
    request[TIME_LIMIT].reschedule(None)


def page_headers(request):
    """The headers of a page. Not every browser takes a WebSocket of the page's own host as
    'self'."""
    host = request.headers["Host"]  # Server._check has accepted it
    return {**HEADERS, "Content-Security-Policy":
            f"{POLICY}; connect-src 'self' ws://{host} wss://{host}"}


def host_name(host):
    """The name in a Host header, without its port."""
    name, colon, port = host.rpartition(":")
    return (name if colon and port.isdecimal() else host).lower()


def shown(text):
    """Quotes text from a request for a message."""
    return json.dumps(text if len(text) <= 80 else f"{text[:77]}...")


def allowed_hosts(listen, names):
    """The permitted names in the Host header: this machine's, the host of --listen, and the
    operator's."""
    name = listen.rpartition(":")[0]
    own = [name] if name and name not in ("0.0.0.0", "[::]") else []
    return [*THIS_MACHINE, *own, *names]


async def serve(server, listen, started, stopping):
    """Serves until SIGINT or SIGTERM. Calls `started` with the address once it listens, and awaits
    `stopping` before it waits for the requests being answered."""
    host, _, port = listen.rpartition(":")
    if not port.isdecimal():
        raise ValueError(f"--listen: expected HOST:PORT, got {listen!r}")
    stop = asyncio.Event()
    for number in (signal.SIGINT, signal.SIGTERM):
        asyncio.get_running_loop().add_signal_handler(number, stop.set)
    listening = await asyncio.get_running_loop().create_server(
        server, host.strip("[]") or None, int(port), backlog=BACKLOG)
    started(listening.sockets[0].getsockname())
    await stop.wait()
    listening.close()
    await stopping()
    await server.shutdown(SHUTDOWN_SECONDS)
