"""The client over TLS: valid and invalid certificates."""

import pathlib
import shutil
import subprocess
import tempfile
import unittest

import support
import duet_motion as duet
import grpc
from duet_motion.v1 import synthesis_pb2

LISTING = synthesis_pb2.ListModelsResponse(models=[{"name": "m"}])


@unittest.skipIf(shutil.which("openssl") is None, "no openssl; install the package openssl")
class TlsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        for name in ("server", "client"):
            subprocess.run(
                ["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt",
                 "ec_paramgen_curve:prime256v1", "-nodes", "-days", "2", "-subj", f"/CN={name}.test",
                 "-addext", f"subjectAltName=DNS:{name}.test", "-keyout", cls.folder / f"{name}.key",
                 "-out", cls.folder / f"{name}.crt"], check=True, capture_output=True)

    def list_models(self, tls, asks_for_certificates=False):
        files = {path.name: path.read_bytes() for path in self.folder.iterdir()}
        credentials = grpc.ssl_server_credentials(
            [(files["server.key"], files["server.crt"])], files["client.crt"],
            require_client_auth=asks_for_certificates)
        retry = duet.RetryOptions(max_attempts=1)
        with support.serving(support.Script(LISTING), credentials) as address:
            with duet.Client(address, tls=tls, retry=retry, timeout=support.LONGEST_CALL) as client:
                return [model.name for model in client.list_models()]

    def options(self, **files):
        paths = {flag: self.folder / name for flag, name in files.items()}
        return duet.TlsOptions.from_files(**paths, server_name="server.test")

    def test_trusted_certificate_is_accepted(self):
        self.assertEqual(self.list_models(self.options(ca="server.crt")), ["m"])

    def test_wrong_name_or_authority_is_rejected(self):
        stranger = duet.TlsOptions.from_files(ca=self.folder / "server.crt", server_name="x.test")
        for tls in (stranger, self.options(ca="client.crt"), None):
            with self.subTest(tls=tls), self.assertRaises(duet.UnavailableError):
                self.list_models(tls)

    def test_client_certificate_is_sent(self):
        mine = self.options(ca="server.crt", cert="client.crt", key="client.key")
        self.assertEqual(self.list_models(mine, asks_for_certificates=True), ["m"])
        with self.assertRaises(duet.UnavailableError):
            self.list_models(self.options(ca="server.crt"), asks_for_certificates=True)

    def test_certificate_without_key_is_rejected(self):
        with self.assertRaisesRegex(ValueError, "tls.private_key: expected one beside certificate_chain"):
            self.options(ca="server.crt", cert="client.crt")

    def test_text_that_is_no_pem_is_rejected_before_a_call(self):
        junk = self.folder / "junk.pem"
        junk.write_text("certificate", encoding="utf-8")
        self.addCleanup(junk.unlink)
        for files, message in (
                ({"ca": "junk.pem"}, "tls.root_certificates: expected PEM certificates, got none"),
                ({"cert": "junk.pem", "key": "client.key"},
                 "tls.certificate_chain: expected PEM certificates, got none"),
                ({"cert": "client.crt", "key": "junk.pem"},
                 "tls.private_key: expected a private key in PEM, got none")):
            with self.subTest(files=files), self.assertRaisesRegex(ValueError, message):
                self.options(**files)


if __name__ == "__main__":
    unittest.main()
