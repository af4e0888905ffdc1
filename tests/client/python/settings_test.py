"""Values of omitted arguments from the environment."""

import os
import pathlib
import tempfile
import unittest
from unittest import mock

import support
import duet_motion as duet
from duet_motion import _settings
from duet_motion.v1 import synthesis_pb2

LISTING = synthesis_pb2.ListModelsResponse(models=[{"name": "m"}])

# Of the name "x", with a key that nobody has.
CERTIFICATE = """-----BEGIN CERTIFICATE-----
MIIBLjCB4aADAgECAhQJBM6A1Vg3Y8+tSRMjCH7XOnYqhzAFBgMrZXAwDDEKMAgG
A1UEAwwBeDAgFw0yNjExMjcwMDM4MDZaGA8yMTI2MTEwMzAwMzgwNlowDDEKMAgG
A1UEAwwBeDAqMAUGAytlcAMhAAOhhtO3t0TZ8XVHD8XcQt0uvle26W4bzdWzoho7
XSQ0o1MwUTAdBgNVHQ4EFgQUF2HqBzpDdPS4f8QntG90E0xPz38wHwYDVR0jBBgw
FoAUF2HqBzpDdPS4f8QntG90E0xPz38wDwYDVR0TAQH/BAUwAwEB/zAFBgMrZXAD
QQBmiIoKiE3eHJgEIYbU/LSfTqmzxkWSvQ9P74c7BAv9LTJ6yYyO4/38kKdVzXqJ
rsO0bo5ZeaWeO2MT/+PYXJQF
-----END CERTIFICATE-----
"""


class SettingsTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def write(self, text, name):
        file = self.folder / name
        file.write_text(text, encoding="utf-8")
        return str(file)

    def test_invalid_value_is_rejected_with_its_variable(self):
        for name, value, read, message in (
                ("TIMEOUT", "soon", lambda: _settings.seconds("TIMEOUT"),
                 "DUET_TIMEOUT: expected a number of seconds, got 'soon'"),
                ("TLS", "perhaps", _settings.tls, "DUET_TLS: expected true or false, got 'perhaps'"),
                ("TOKEN_FILE", "/dev/null", _settings.token, "DUET_TOKEN_FILE: expected a file with")):
            with self.subTest(name), mock.patch.dict(os.environ, {f"DUET_{name}": value}):
                with self.assertRaisesRegex(ValueError, message):
                    read()

    def test_credentials_are_read_from_files(self):
        variables = {"DUET_TLS_CA": self.write(CERTIFICATE, "ca.pem"), "DUET_TLS_SERVER_NAME": "x",
                     "DUET_TOKEN_FILE": self.write(" secret\n", "token")}
        with mock.patch.dict(os.environ, variables):
            self.assertEqual(_settings.tls(), duet.TlsOptions(CERTIFICATE.encode(), server_name="x"))
            self.assertEqual(_settings.token(), "secret")
        with mock.patch.dict(os.environ, {"DUET_TLS": "on"}):
            self.assertEqual(_settings.tls(), duet.TlsOptions())

    def test_client_without_arguments_uses_the_environment(self):
        with support.serving(support.Script(LISTING)) as address, mock.patch.dict(
                os.environ, {"DUET_SERVER": address, "DUET_WAIT": "0", "DUET_TIMEOUT": "50"}):
            with duet.Client() as client:
                self.assertEqual(client.list_models()[0].name, "m")
                self.assertEqual((client._settings.timeout, client._settings.wait), (50, 0))
            with duet.Client(timeout=7, wait=3) as client:
                self.assertEqual((client._settings.timeout, client._settings.wait), (7, 3))


if __name__ == "__main__":
    unittest.main()
