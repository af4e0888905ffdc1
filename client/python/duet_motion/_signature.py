"""Derives methods that take a request's fields from methods that take a request."""

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
    """``method`` with the arguments of ``make`` in place of the object that ``make`` returns."""

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
    """The method's first paragraph, followed by the arguments' documentation from `make`."""
    summary = (inspect.getdoc(method) or "").partition("\n\n")[0]
    arguments = (inspect.getdoc(make) or "").partition("\nArgs:\n")[2]
    return (f"{summary}\n\nArgs:\n{arguments.rstrip()}\n"
            "    DuetError: the call failed, now or while the result is awaited.\n")
