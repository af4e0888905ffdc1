"""Bodies of requests, received with bounds: on each, on all of them together, and in time."""

import asyncio
import contextlib
import tempfile

from serving import Rejected, Refused

MAX_BODY_BYTES = 32 * 2**20  # a request's limit at the server
BODY_SECONDS = 120
MAX_SPOOLED_BYTES = 2**30    # on disk, of all bodies that are being received or used
IN_MEMORY_BYTES = 2**16      # of each body whose message is sent on; the rest of it is on disk
MAX_HELD_BYTES = 64 * 2**20  # in memory, of all messages that are being sent on
HELD_SECONDS = 30            # that a message waits for its place in memory


class Uploads:
    """All bodies that are being received or used."""

    def __init__(self):
        self._spooled = 0
        self._held = 0
        self._released = asyncio.Condition()

    @contextlib.asynccontextmanager
    async def body(self, request, file):
        """Receives a request's body into `file`, which counts towards the disk's bound inside.

        Raises:
            Rejected: the body has no length, is too long or too slow, or there are too many bodies.
        """
        await check_length(request)
        received = 0
        try:
            try:
                async with asyncio.timeout(BODY_SECONDS):
                    async for data in request.content.iter_any():
                        if self._spooled + len(data) > MAX_SPOOLED_BYTES:
                            raise Rejected(503, "body: too many are being received; try again "
                                                "later")
                        received += len(data)
                        self._spooled += len(data)
                        file.write(data)
            except TimeoutError:
                raise Rejected(408, f"body: expected all of it within {BODY_SECONDS} s, got "
                                    f"{received} bytes") from None
            file.flush()
            yield
        finally:
            self._spooled -= received

    @contextlib.asynccontextmanager
    async def message(self, request):
        """A request's body as a file, to be read into memory inside. Messages together stay within
        a bound: one waits until its bytes fit.

        Raises:
            Rejected: as body() does.
            Refused: the messages before this one stayed too long.
        """
        with tempfile.SpooledTemporaryFile(IN_MEMORY_BYTES, prefix="duet-gateway-") as file:
            async with self.body(request, file):
                size = file.tell()
                await self._hold(size)
                try:
                    file.seek(0)
                    yield file
                finally:
                    async with self._released:
                        self._held -= size
                        self._released.notify_all()

    async def _hold(self, size):
        try:
            async with asyncio.timeout(HELD_SECONDS), self._released:
                await self._released.wait_for(lambda: self._held + size <= MAX_HELD_BYTES)
                self._held += size
        except TimeoutError:
            raise Refused(503, "body: too many large ones are being sent on; try again "
                               "later") from None


async def check_length(request):
    """Refuses a body before it is read, by its length."""
    length = request.headers.get("Content-Length")
    if length is None:
        raise Rejected(411, "Content-Length: expected the body's, got none")
    # Digits are counted first: Python refuses to read thousands of them.
    digits = length.lstrip("0")
    if len(digits) > 12 or int(digits or "0") > MAX_BODY_BYTES:
        raise Rejected(413, f"body: expected at most {MAX_BODY_BYTES} bytes, got "
                            f"{digits if len(digits) <= 12 else 'far more'}")
    expected = request.headers.get("Expect")
    if expected is not None:
        if expected.lower() != "100-continue":
            raise Rejected(417, "Expect: expected 100-continue, got something else")
        await request.writer.write(b"HTTP/1.1 100 Continue\r\n\r\n")
        request.writer.output_size = 0
