"""Environment and configuration file, as for the program (tests/client/cli/settings_test.cc)."""

import os
import pathlib
import tempfile
import unittest
from unittest import mock

import support
import duet_motion as duet
from duet_motion._settings import Settings
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

    def write(self, text, path="config"):
        file = self.folder / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")
        return str(file)

    def settings(self, text):
        return Settings({"DUET_CONFIG": self.write(text)})

    def test_environment_overrides_the_file(self):
        config = self.write("# the lab's server\nserver = lab:50051\n\n timeout=300 \n")
        settings = Settings({"DUET_SERVER": "other:1", "DUET_CONFIG": config})
        self.assertEqual((settings.text("server"), settings.seconds("timeout")), ("other:1", 300))
        for variables in ({"DUET_CONFIG": config}, {"DUET_CONFIG": config, "DUET_SERVER": ""}):
            self.assertEqual(Settings(variables).text("server"), "lab:50051")

    def test_file_is_found_where_the_program_finds_it(self):
        self.write("server = xdg:1\n", "x/duet/config")
        self.write("server = home:1\n", "h/.config/duet/config")
        home, xdg = str(self.folder / "h"), str(self.folder / "x")
        for variables, server in (({"HOME": home}, "home:1"),
                                  ({"HOME": home, "XDG_CONFIG_HOME": xdg}, "xdg:1"),
                                  ({"HOME": home, "XDG_CONFIG_HOME": ""}, "home:1"),
                                  ({"HOME": home, "DUET_CONFIG": ""}, None),
                                  ({"HOME": str(self.folder / "none")}, None), ({}, None)):
            with self.subTest(variables=variables):
                self.assertEqual(Settings(variables).text("server"), server)
        with self.assertRaises(FileNotFoundError):
            Settings({"DUET_CONFIG": str(self.folder / "none")})

    def test_malformed_file_is_rejected_with_its_line(self):
        for text, message in (("server\n", r"config:1: expected a flag .* got 'server'"),
                              ("\n--server = x\n", r"config:2: expected a flag"),
                              ("timeout = soon\n", r"config:1: timeout: expected a number of sec"),
                              ("tls = perhaps\n", "config:1: tls: expected true or false, got 'per"),
                              ("token-file = /dev/null\n", "config:1: token-file: expected a file")):
            with self.subTest(text=text), self.assertRaisesRegex(ValueError, message):
                settings = self.settings(text)
                settings.seconds("timeout"), settings.tls(), settings.token()

    def test_credentials_are_read_from_files(self):
        ca = self.write(CERTIFICATE, "ca.pem")
        token = self.write(" secret\n", "token")
        settings = self.settings(f"tls-ca = {ca}\ntls-server-name = x\ntoken-file = {token}\nout = y")
        self.assertEqual(settings.tls(), duet.TlsOptions(CERTIFICATE.encode(), server_name="x"))
        self.assertEqual(settings.token(), "secret")
        self.assertEqual(self.settings("tls = true").tls(), duet.TlsOptions())
        self.assertIsNone(self.settings("tls = false").tls())

    def test_client_without_arguments_uses_the_settings(self):
        config = self.write("wait = 0\ntimeout = 50\n")
        with support.serving(support.Script(LISTING)) as address, mock.patch.dict(
                os.environ, {"DUET_SERVER": address, "DUET_CONFIG": config}):
            with duet.Client() as client:
                self.assertEqual(client.list_models()[0].name, "m")
                self.assertEqual((client._settings.timeout, client._settings.wait), (50, 0))
            with duet.Client(timeout=7, wait=3) as client:
                self.assertEqual((client._settings.timeout, client._settings.wait), (7, 3))

    def test_argument_overrides_the_environment(self):
        with support.serving(support.Script(LISTING)) as address, mock.patch.dict(
                os.environ, {"DUET_SERVER": "nobody:1",
                             "DUET_CONFIG": self.write("tls = true\nauthority = x\n")}):
            with duet.Client(address, tls=False, authority="") as client:
                self.assertEqual(client.list_models()[0].name, "m")


if __name__ == "__main__":
    unittest.main()
