"""Many requests, so many at a time."""

from __future__ import annotations

import collections
import concurrent.futures
import dataclasses
import itertools
from typing import Callable, Deque, Iterable, Iterator, Optional, Tuple

from duet_motion._channel import check_concurrency
from duet_motion.errors import DuetError
from duet_motion.request import SynthesisRequest
from duet_motion.result import SynthesisResult


@dataclasses.dataclass(frozen=True, eq=False)
class Outcome:
    """What came of one request of several: a result, or what it failed with."""

    request: SynthesisRequest
    result: Optional[SynthesisResult] = None
    error: Optional[DuetError] = None

    def unwrap(self) -> SynthesisResult:
        """The result; raises the error where there is one."""
        if self.result is None:
            assert self.error is not None
            raise self.error
        return self.result


def ahead(concurrency: int) -> int:
    """How many requests may be under way: one slow call leaves the others something to do."""
    return 2 * concurrency


def run(answer: Callable[[SynthesisRequest], SynthesisResult],
        requests: Iterable[SynthesisRequest], concurrency: int) -> Iterator[Outcome]:
    """Answers requests in threads; their outcomes in order. At most ``concurrency`` calls are made at
    a time, and at most :func:`ahead` requests are taken and not yet given back."""
    check_concurrency("concurrency", concurrency)
    return _run(answer, requests, concurrency)


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
