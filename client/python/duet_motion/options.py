"""Options of the connection to a server."""

from __future__ import annotations

import dataclasses
import pathlib
import re
import ssl
from typing import Union

Path = Union[str, pathlib.Path]
_PRIVATE_KEY = re.compile(rb"-----BEGIN [A-Z ]*PRIVATE KEY-----")


def _has_certificate(pem: bytes) -> bool:
    try:
        ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT).load_verify_locations(cadata=pem.decode("ascii", "ignore"))
    except ssl.SSLError:
        return False
    return True


@dataclasses.dataclass(frozen=True)
class TlsOptions:
    """Options of a TLS connection. Certificates and keys are PEM data; :meth:`from_files` takes
    paths.

    Args:
        root_certificates: the authorities that may sign the server's certificate. Empty: gRPC's
            default.
        certificate_chain: this client's certificate, for servers that require one.
        private_key: the key of that certificate; set both or neither.
        server_name: the name in the server's certificate, if it differs from the address.

    Raises:
        ValueError: there is a certificate without a key or a key without a certificate, or what
            should be PEM is not.
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
        # With text that is no PEM, gRPC calls no address, as if there were no server.
        for field in ("root_certificates", "certificate_chain"):
            if getattr(self, field) and not _has_certificate(getattr(self, field)):
                raise ValueError(f"tls.{field}: expected PEM certificates, got none")
        if self.private_key and not _PRIVATE_KEY.search(self.private_key):
            raise ValueError("tls.private_key: expected a private key in PEM, got none")

    @classmethod
    def from_files(cls, ca: Path = "", cert: Path = "", key: Path = "",
                   server_name: str = "") -> TlsOptions:
        """Reads the PEM files of the flags --tls-ca, --tls-cert and --tls-key of `duet`.

        Args:
            ca: the file with the authorities' certificates. Empty: gRPC's default.
            cert: the file with this client's certificate.
            key: the file with that certificate's key.
            server_name: see the constructor.

        Raises:
            OSError: a file cannot be read.
            ValueError: see the constructor.
        """
        def read(path: Path) -> bytes:
            return pathlib.Path(path).read_bytes() if path else b""
        return cls(read(ca), read(cert), read(key), server_name)
