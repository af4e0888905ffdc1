"""What every request to the gateway must keep to, whatever it asks for: whose page sent it, how
long it may take, how it is refused. HTTP itself is aiohttp's."""

import asyncio
import json
import logging
import signal

from aiohttp import http_exceptions, web

MAX_CONNECTIONS = 512
# Bounds in seconds. A whole request includes its answer: the longest call of gRPC and its reader.
HEADER_SECONDS = 10
IDLE_SECONDS = 30
REQUEST_SECONDS = 660
SHUTDOWN_SECONDS = 5
HEADERS = {
    # Nothing from elsewhere, and no page of others around this one.
    "Content-Security-Policy": "default-src 'self'; img-src 'self' data: blob:; "
                               "frame-ancestors 'none'; base-uri 'none'; form-action 'none'",
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cache-Control": "no-cache",
    "Server": "duet-gateway",
}
THIS_MACHINE = ("localhost", "127.0.0.1", "[::1]")

LOG = logging.getLogger("duet.gateway")


class Refused(Exception):
    """A request that is not answered: its HTTP status, and a message for whoever sent it."""

    def __init__(self, status, message, **headers):
        super().__init__(message)
        self.status, self.message, self.headers = status, message, headers


class Rejected(Refused):
    """Refused with its body unread or its framing in doubt: the connection is closed."""


def refusal(status, message, headers=()):
    """A refusal as JSON."""
    response = web.json_response({"error": {"status": status, "message": message}}, status=status,
                                 headers={**HEADERS, **dict(headers)})
    if status == 503:
        response.headers["Retry-After"] = "5"
    return response


class Connection(web.RequestHandler):
    """One connection: closed unless a request's header has come in time, and its request is
    cancelled when it is lost."""

    def __init__(self, *arguments, **options):
        super().__init__(*arguments, **options)
        self.answering = None  # the task that answers a request
        self._waiting_for_header = None

    def connection_made(self, transport):
        super().connection_made(transport)
        # Later headers on this connection must come within aiohttp's own bound for idle ones.
        self._waiting_for_header = self._loop.call_later(HEADER_SECONDS,
                                                         self._close_unless_answering)
        self._manager.make_room()

    def connection_lost(self, exc):
        self._waiting_for_header.cancel()
        if self.answering:
            self.answering.cancel()
        super().connection_lost(exc)

    def data_received(self, data):
        try:
            super().data_received(data)
        except ValueError:
            # Not caught by aiohttp: a target that is no URL. Its parser refuses whatever follows.
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
        """Answers what aiohttp could not read, and what nothing else has caught."""
        if isinstance(exc, ConnectionError):
            raise exc
        if isinstance(exc, http_exceptions.LineTooLong):
            response = refusal(431, "header: expected lines of at most 8190 bytes, got longer ones")
        elif isinstance(exc, http_exceptions.HttpProcessingError):
            response = refusal(400, f"request: expected HTTP/1.1, got a malformed one: {message}")
        else:
            LOG.error("%s %s failed", request.method, request.path, exc_info=exc)
            if request.writer.output_size > 0:
                raise ConnectionError("the answer has begun")
            response = refusal(500, "the gateway failed; its log says how")
        response.force_close()
        return response


class Server(web.Server):
    """Answers requests by `routes`, {path: {method: handler}}. `hosts` are the names that a request
    may be addressed to."""

    def __init__(self, routes, hosts):
        super().__init__(self._handle, keepalive_timeout=IDLE_SECONDS, access_log=None,
                         lingering_time=2, logger=LOG)
        self._routes = routes
        self._hosts = {name.lower() for name in hosts}

    def __call__(self):
        return Connection(self, loop=self._loop, **self._kwargs)

    def make_room(self):
        """Closes the connection that has waited longest for a request, where there are too many."""
        if len(self._connections) <= MAX_CONNECTIONS:
            return
        idle = (connection for connection in self._connections if not connection.answering)
        next(idle, self.connections[-1]).force_close()

    async def _handle(self, request):
        request.protocol.begin()
        try:
            async with asyncio.timeout(REQUEST_SECONDS):
                return await self._answer(request)
        except TimeoutError:
            if request.transport:
                request.transport.abort()  # what is left to send is not waited for
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
        # Here, so that a reader that stands still counts towards the request's time.
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
            # A name that somebody made point here: its page would pass for this one's own.
            raise Rejected(421, f"Host: expected one of {', '.join(sorted(self._hosts))}, got "
                                f"{shown(host)}; start the gateway with --host NAME to allow it")
        # A page of another origin may not post anything here in its visitor's name.
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
            raise Rejected(400, "header: expected names without blanks, got one with them")
    if "Transfer-Encoding" in request.headers:
        raise Rejected(411, "Transfer-Encoding: expected none but a Content-Length, got one")
    if request.method != "POST" and request.headers.get("Content-Length", "0").strip("0"):
        raise Rejected(400, f"body: expected none with {request.method}, got one")
    if "Upgrade" in request.headers:
        raise Rejected(400, "Upgrade: expected none, got one")


def host_name(host):
    """The name in a Host header, without its port."""
    name, colon, port = host.rpartition(":")
    return (name if colon and port.isdecimal() else host).lower()


def shown(text):
    """Text of a request as a message repeats it."""
    return json.dumps(text if len(text) <= 80 else f"{text[:77]}...")


def allowed_hosts(listen, names):
    """The names that requests may be addressed to: this machine's own, the one that is listened on,
    and those that the operator adds."""
    name = listen.rpartition(":")[0]
    own = [name] if name and name not in ("0.0.0.0", "[::]") else []
    return [*THIS_MACHINE, *own, *names]


async def serve(server, listen, started):
    """Serves until SIGINT or SIGTERM; calls `started` with the address when it listens."""
    host, _, port = listen.rpartition(":")
    if not port.isdecimal():
        raise ValueError(f"--listen: expected HOST:PORT, got {listen!r}")
    stop = asyncio.Event()
    for number in (signal.SIGINT, signal.SIGTERM):
        asyncio.get_running_loop().add_signal_handler(number, stop.set)
    runner = web.ServerRunner(server, shutdown_timeout=SHUTDOWN_SECONDS)
    await runner.setup()
    try:
        await web.TCPSite(runner, host.strip("[]") or None, int(port),
                          shutdown_timeout=SHUTDOWN_SECONDS, backlog=128).start()
        started(runner.addresses[0])
        await stop.wait()
    finally:
        await runner.cleanup()
