"""The image's health check, as the Dockerfile states it, on servers that no plain client can call."""

import json
import os
import re
import shutil
import unittest

import proxies
import tools

DOCKERFILE = tools.SOURCE / "Dockerfile"


def health_command():
    """The words of HEALTHCHECK ... CMD [...]."""
    text = DOCKERFILE.read_text(encoding="utf-8").replace("\\\n", " ")
    return json.loads(re.search(r"^HEALTHCHECK .*?CMD (\[.*\])$", text, re.MULTILINE)[1])


class HealthCheckTest(tools.FolderTest):
    def check(self, metrics_listen):
        """Runs the check as the container does: with its variables."""
        program, *words = health_command()
        return tools.run(tools.PROGRAMS / program, *words, env={
            **os.environ, "DUET_SERVER_METRICS_LISTEN": metrics_listen})

    def check_server(self, *flags):
        with tools.running_server(*flags, metrics="127.0.0.1:0") as server:
            address = f"127.0.0.1:{server.metrics_port}"
            healthy = self.check(address)
            self.assertEqual((healthy.returncode, healthy.stderr), (0, ""))
        gone = self.check(address)
        self.assertEqual(gone.returncode, 1)
        self.assertIn("cannot connect", gone.stderr)

    def test_server_in_the_clear(self):
        self.check_server()

    @unittest.skipUnless(shutil.which("openssl"), "needs openssl")
    def test_server_with_tls_and_an_access_file(self):
        proxies.certificate(self.folder)
        access = self.folder / "access"
        access.write_text(f"ada synthesise sha256:{'0' * 64}\n", encoding="utf-8")
        access.chmod(0o600)
        self.check_server("--tls-certificate-file", self.folder / "cert.pem", "--tls-key-file",
                          self.folder / "key.pem", "--access-file", access)


if __name__ == "__main__":
    tools.main()
