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
    spelled.__doc__ = _document(method, make)
    fields = inspect.signature(make).parameters.values()
    myself = inspect.Parameter("self", inspect.Parameter.POSITIONAL_ONLY)
    spelled.__signature__ = inspect.signature(method).replace(  # type: ignore[attr-defined]
        parameters=[myself, *fields])
    return spelled


def _document(method: Callable[..., object], make: Callable[..., object]) -> str:
    """The method's first paragraph, then what `make` says of its arguments."""
    summary = (inspect.getdoc(method) or "").partition("\n\n")[0]
    arguments = (inspect.getdoc(make) or "").partition("\nArgs:\n")[2]
    return (f"{summary}\n\nArgs:\n{arguments.rstrip()}\n"
            "    DuetError: the call failed, here or while the result is awaited.\n")
