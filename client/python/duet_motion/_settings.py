"""Reads the environment and the configuration file of the program `duet` for this package.

Names and precedence are those of client/cli/settings.h: an argument overrides ``DUET_SERVER``,
which overrides the configuration file, which overrides the default. ``DUET_CONFIG`` names the file
(empty: no file). Without it, the file is ``duet/config`` below ``XDG_CONFIG_HOME`` or
``~/.config``, and may be missing.
"""

from __future__ import annotations

import dataclasses
import os
import pathlib
import re
from typing import Dict, Mapping, Optional

from duet_motion.options import TlsOptions

_LONGEST_FILE = 1 << 20
_LONGEST_TOKEN = 4096
_FLAG = re.compile(r"[a-z0-9][a-z0-9-]*")
_SWITCH = {"true": True, "on": True, "yes": True, "1": True,
           "false": False, "off": False, "no": False, "0": False}


@dataclasses.dataclass(frozen=True)
class _Setting:
    value: str
    source: str
    """For error messages: ``DUET_SERVER``, or the file and the line."""


class Settings:
    """Values for omitted arguments; ``None`` for settings that are not set.

    Raises:
        ValueError: the configuration file is malformed or a value is invalid. The message names the
            file and the line.
        OSError: the file that ``DUET_CONFIG`` names cannot be read.
    """

    def __init__(self, environment: Optional[Mapping[str, str]] = None) -> None:
        variables = os.environ if environment is None else environment
        self._settings = _read_file(variables)
        if variables.get("DUET_SERVER"):
            self._settings["server"] = _Setting(variables["DUET_SERVER"], "DUET_SERVER")

    def text(self, flag: str) -> Optional[str]:
        setting = self._settings.get(flag)
        return setting.value if setting and setting.value else None

    def seconds(self, flag: str) -> Optional[float]:
        setting = self._settings.get(flag)
        if setting is None:
            return None
        try:
            return float(setting.value)
        except ValueError:
            raise self._refuse(flag, "a number of seconds") from None

    def token(self) -> Optional[str]:
        path = self.text("token-file")
        if path is None:
            return None
        token = pathlib.Path(path).read_text(encoding="utf-8").strip()
        if not 0 < len(token) <= _LONGEST_TOKEN:
            raise self._refuse("token-file", f"a file with a token of at most {_LONGEST_TOKEN} "
                               "characters")
        return token

    def tls(self) -> Optional[TlsOptions]:
        files = {name: self.text(f"tls-{name}") or "" for name in ("ca", "cert", "key")}
        server_name = self.text("tls-server-name") or ""
        if not (self._switch("tls") or any(files.values()) or server_name):
            return None
        return TlsOptions.from_files(**files, server_name=server_name)

    def _switch(self, flag: str) -> bool:
        setting = self._settings.get(flag)
        if setting is None:
            return False
        if setting.value.lower() not in _SWITCH:
            raise self._refuse(flag, "true or false")
        return _SWITCH[setting.value.lower()]

    def _refuse(self, flag: str, wanted: str) -> ValueError:
        setting = self._settings[flag]
        return ValueError(f"{setting.source}: {flag}: expected {wanted}, got {setting.value!r}")


def _read_file(variables: Mapping[str, str]) -> Dict[str, _Setting]:
    named = variables.get("DUET_CONFIG")
    path = _default_file(variables) if named is None else named
    if not path:
        return {}
    try:
        with open(path, encoding="utf-8-sig") as file:
            return _parse(file.read(_LONGEST_FILE), path)
    except FileNotFoundError:
        if named is None:
            return {}
        raise


def _default_file(variables: Mapping[str, str]) -> str:
    if variables.get("XDG_CONFIG_HOME"):
        return os.path.join(variables["XDG_CONFIG_HOME"], "duet", "config")
    if variables.get("HOME"):
        return os.path.join(variables["HOME"], ".config", "duet", "config")
    return ""


def _parse(text: str, path: str) -> Dict[str, _Setting]:
    """The last value of each flag. Flags that this package does not use are kept unread."""
    settings = {}
    for number, line in enumerate(text.splitlines(), 1):
        line = line.strip()
        if not line or line.startswith("#"):
            continue
        flag, equals, value = (part.strip() for part in line.partition("="))
        if not equals or not _FLAG.fullmatch(flag):
            raise ValueError(f"{path}:{number}: expected a flag without its dashes and its value, "
                             f"such as server = lab:50051, got {line!r}")
        settings[flag] = _Setting(value, f"{path}:{number}")
    return settings
