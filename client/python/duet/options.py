"""How a client reaches its server."""

from __future__ import annotations

import dataclasses
import pathlib
from typing import Union

Path = Union[str, pathlib.Path]


@dataclasses.dataclass(frozen=True)
class TlsOptions:
    """An encrypted connection. Certificates and keys are PEM, not paths (:meth:`from_files`)."""

    root_certificates: bytes = b""
    """Who may sign the server's certificate. Empty: gRPC's own authorities."""
    certificate_chain: bytes = b""
    """This client's own certificate, for servers that ask for one."""
    private_key: bytes = b""
    """Of that certificate; both or neither."""
    server_name: str = ""
    """The name that the server's certificate must carry, where it is not the address."""

    def __post_init__(self) -> None:
        if bool(self.certificate_chain) != bool(self.private_key):
            raise ValueError("tls: certificate_chain and private_key, wanted both or neither")

    @classmethod
    def from_files(cls, ca: Path = "", cert: Path = "", key: Path = "",
                   server_name: str = "") -> TlsOptions:
        """Reads the PEM files that `duet` takes as --tls-ca, --tls-cert and --tls-key."""
        def read(path: Path) -> bytes:
            return pathlib.Path(path).read_bytes() if path else b""
        return cls(read(ca), read(cert), read(key), server_name)
