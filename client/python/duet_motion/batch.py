"""Runs many requests with a limited number at a time."""

from __future__ import annotations

import collections
import concurrent.futures
import dataclasses
import itertools
from typing import Callable, Deque, Iterable, Iterator, Mapping, Optional

from duet_motion._channel import check_concurrency
from duet_motion.errors import DuetError
from duet_motion.request import SynthesisRequest, check_kind
from duet_motion.result import SynthesisResult


@dataclasses.dataclass(frozen=True, eq=False)
class Outcome:
    """The outcome of one of many requests: a result or an error."""

    request: SynthesisRequest
    result: Optional[SynthesisResult] = None
    error: Optional[DuetError] = None

    def unwrap(self) -> SynthesisResult:
        """Returns the result, or raises the error."""
        if self.result is None:
            assert self.error is not None
            raise self.error
        return self.result


def ahead(concurrency: int) -> int:
    """Maximum number of unfinished requests. The surplus keeps threads busy beside a slow call."""
    return 2 * concurrency


def checked(requests: Iterable[SynthesisRequest]) -> Iterator[SynthesisRequest]:
    """The requests. Raises TypeError, with its position, for anything else among them."""
    if isinstance(requests, (SynthesisRequest, Mapping, str)):
        raise TypeError("requests: expected several duet_motion.SynthesisRequest, got one "
                        f"{type(requests).__name__}")
    return _checked(requests)


def _checked(requests: Iterable[SynthesisRequest]) -> Iterator[SynthesisRequest]:
    for index, request in enumerate(requests):
        check_kind(request, SynthesisRequest, f"requests[{index}]")
        yield request


def run(answer: Callable[[SynthesisRequest], SynthesisResult],
        requests: Iterable[SynthesisRequest], concurrency: int) -> Iterator[Outcome]:
    """Runs requests in threads and yields their outcomes in order. At most ``concurrency`` calls
    run at a time, and at most :func:`ahead` requests are taken but not yet yielded."""
    check_concurrency("concurrency", concurrency)
    return _run(answer, checked(requests), concurrency)


def _run(answer: Callable[[SynthesisRequest], SynthesisResult],
         requests: Iterable[SynthesisRequest], concurrency: int) -> Iterator[Outcome]:
    def outcome(request: SynthesisRequest) -> Outcome:
        try:
            return Outcome(request, result=answer(request))
        except DuetError as error:
            return Outcome(request, error=error)

    waiting: Deque[concurrent.futures.Future[Outcome]] = collections.deque()
    rest = iter(requests)
    pool = concurrent.futures.ThreadPoolExecutor(concurrency, thread_name_prefix="duet-batch")
    try:
        waiting.extend(pool.submit(outcome, request)
                       for request in itertools.islice(rest, ahead(concurrency)))
        while waiting:
            done = waiting.popleft().result()
            waiting.extend(pool.submit(outcome, request) for request in itertools.islice(rest, 1))
            yield done
    finally:
        pool.shutdown(cancel_futures=True)
