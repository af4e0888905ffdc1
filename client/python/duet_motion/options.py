"""How a client reaches its server."""

from __future__ import annotations

import dataclasses
import pathlib
from typing import Union

Path = Union[str, pathlib.Path]


@dataclasses.dataclass(frozen=True)
class TlsOptions:
    """An encrypted connection. Certificates and keys are PEM, not paths (:meth:`from_files`).

    Args:
        root_certificates: the authorities that may sign the server's certificate. Empty: gRPC's
            own.
        certificate_chain: this client's own certificate, for servers that ask for one.
        private_key: the key of that certificate; both or neither.
        server_name: the name that the server's certificate must carry, if that is not the address.

    Raises:
        ValueError: a certificate without its key, or the other way round.
    """

    root_certificates: bytes = b""
    certificate_chain: bytes = b""
    private_key: bytes = b""
    server_name: str = ""

    def __post_init__(self) -> None:
        if bool(self.certificate_chain) != bool(self.private_key):
            has, lacks = (("private_key", "certificate_chain") if self.private_key
                          else ("certificate_chain", "private_key"))
            raise ValueError(f"tls.{lacks}: expected one beside {has}, got none")

    @classmethod
    def from_files(cls, ca: Path = "", cert: Path = "", key: Path = "",
                   server_name: str = "") -> TlsOptions:
        """Reads the PEM files that `duet` takes as --tls-ca, --tls-cert and --tls-key.

        Args:
            ca: the file with the authorities' certificates. Empty: gRPC's own.
            cert: the file with this client's certificate.
            key: the file with that certificate's key.
            server_name: as of the constructor.

        Raises:
            OSError: a file cannot be read.
        """
        def read(path: Path) -> bytes:
            return pathlib.Path(path).read_bytes() if path else b""
        return cls(read(ca), read(cert), read(key), server_name)
