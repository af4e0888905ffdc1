"""Values of omitted arguments from the environment, which the program `duet` reads too.

``DUET_SERVER``, ``DUET_TIMEOUT``, ``DUET_WAIT``, ``DUET_TLS``, ``DUET_TLS_CA``, ``DUET_TLS_CERT``,
``DUET_TLS_KEY``, ``DUET_TLS_SERVER_NAME``, ``DUET_TOKEN_FILE`` and ``DUET_AUTHORITY`` stand for the
program's flags of these names.
"""

from __future__ import annotations

import os
import pathlib
from typing import Optional

from duet_motion.options import TlsOptions

_LONGEST_TOKEN = 4096
_SWITCH = {"true": True, "on": True, "yes": True, "1": True,
           "false": False, "off": False, "no": False, "0": False}


def text(name: str) -> Optional[str]:
    """The variable ``DUET_<name>``; None if it is empty or not set."""
    return os.environ.get(f"DUET_{name}") or None


def seconds(name: str) -> Optional[float]:
    value = text(name)
    try:
        return None if value is None else float(value)
    except ValueError:
        raise _refusal(name, "a number of seconds") from None


def token() -> Optional[str]:
    path = text("TOKEN_FILE")
    if path is None:
        return None
    value = pathlib.Path(path).read_text(encoding="utf-8").strip()
    if not 0 < len(value) <= _LONGEST_TOKEN:
        raise _refusal("TOKEN_FILE", f"a file with a token of at most {_LONGEST_TOKEN} characters")
    return value


def tls() -> Optional[TlsOptions]:
    """Encryption, if one of its variables asks for it."""
    switch = (text("TLS") or "false").lower()
    if switch not in _SWITCH:
        raise _refusal("TLS", "true or false")
    files = {name: text(f"TLS_{name.upper()}") or "" for name in ("ca", "cert", "key")}
    server_name = text("TLS_SERVER_NAME") or ""
    if not (_SWITCH[switch] or any(files.values()) or server_name):
        return None
    return TlsOptions.from_files(**files, server_name=server_name)


def _refusal(name: str, wanted: str) -> ValueError:
    return ValueError(f"DUET_{name}: expected {wanted}, got {text(name)!r}")
