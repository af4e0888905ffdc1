"""Receives request bodies with limits on each body, on their sum, and on time."""

import asyncio
import contextlib
import tempfile

from serving import Rejected, Refused

MAX_BODY_BYTES = 32 * 2**20  # a request's limit at the server
BODY_SECONDS = 120
MAX_SPOOLED_BYTES = 2**30    # on disk, all bodies that are being received or used
IN_MEMORY_BYTES = 2**16      # per body of a forwarded message; larger bodies are on disk
MAX_HELD_BYTES = 64 * 2**20  # in memory, all messages that are being forwarded
HELD_SECONDS = 30            # timeout of a message that waits for memory


class Uploads:
    """The bodies that are being received or used."""

    def __init__(self):
        self._spooled = 0
        self._held = 0
        self._released = asyncio.Condition()

    @contextlib.asynccontextmanager
    async def body(self, request, file):
        """Receives a request's body into `file`, which counts towards the limit on disk inside.

        Raises:
            Rejected: the body has no length, is too long or too slow, or all bodies exceed the
            limit.
        """
        await check_length(request)
        received = 0
        try:
            try:
                async with asyncio.timeout(BODY_SECONDS):
                    async for data in request.content.iter_any():
                        if self._spooled + len(data) > MAX_SPOOLED_BYTES:
                            raise Rejected(503, "body: too many bodies are being received; "
                                                "try again later")
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
        """Yields a request's body as a file, to be read into memory inside. Waits until the sum of
        all messages in memory is below its limit.

        Raises:
            Rejected: see body().
            Refused: the wait for memory timed out.
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
            raise Refused(503, "body: too many large messages are being forwarded; try "
                               "again later") from None


async def check_length(request):
    """Rejects a body by its length before it is read."""
    length = request.headers.get("Content-Length")
    if length is None:
        raise Rejected(411, "Content-Length: expected the body's, got none")
    # Count the digits first: Python does not convert thousands of digits.
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
