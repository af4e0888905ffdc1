"""Methods that take a request, and the same methods taking what a request is made of."""

from __future__ import annotations

import functools
import inspect
from typing import Callable, Concatenate, ParamSpec, TypeVar

Self = TypeVar("Self")
Request = TypeVar("Request")
Answer = TypeVar("Answer")
Fields = ParamSpec("Fields")


def spelled_out(method: Callable[[Self, Request], Answer], make: Callable[Fields, Request],
                name: str) -> Callable[Concatenate[Self, Fields], Answer]:
    """``method``, called with the arguments of ``make`` instead of what ``make`` returns."""

    @functools.wraps(method)
    def spelled(self: Self, /, *args: Fields.args, **kwargs: Fields.kwargs) -> Answer:
        return method(self, make(*args, **kwargs))

    spelled.__name__ = name
    spelled.__qualname__ = method.__qualname__.rpartition(".")[0] + f".{name}"
    spelled.__doc__ = (f"{method.__doc__}\n\n        The arguments are the fields of "
                       ":class:`duet.SynthesisRequest`.")
    fields = inspect.signature(make).parameters.values()
    myself = inspect.Parameter("self", inspect.Parameter.POSITIONAL_ONLY)
    spelled.__signature__ = inspect.signature(method).replace(  # type: ignore[attr-defined]
        parameters=[myself, *fields])
    return spelled
