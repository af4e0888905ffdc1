"""Certificates, tokens and roles as a client sees them that shares no code with ours: Python's grpcio
and openssl's own client."""

import hashlib
import os
import pathlib
import shutil
import ssl
import subprocess
import tempfile
import threading
import unittest

import stubs
import tools
from stubs import grpc, synthesis_pb2, synthesis_pb2_grpc

if shutil.which("openssl") is None:
    tools.skip("no openssl; install the package openssl")


def openssl(*arguments, **options):
    return tools.run("openssl", *arguments, **options)


class Authority:
    """Signs certificates, in a folder of its own."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        self.folder.mkdir()
        self.certificate = self.folder / "ca.pem"
        self._key = self.folder / "ca.key"
        openssl("req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256", "-nodes",
                "-keyout", self._key, "-out", self.certificate, "-days", "2", "-subj",
                "/CN=authority").check_returncode()

    def issue(self, name, key="ec", folder=None):
        """A folder with cert.pem and key.pem for a host name (and this machine)."""
        folder = pathlib.Path(folder or tempfile.mkdtemp(dir=self.folder))
        folder.mkdir(exist_ok=True)
        kind = ("ec", "-pkeyopt", "ec_paramgen_curve:P-256") if key == "ec" else ("rsa:2048",)
        openssl("req", "-newkey", *kind, "-nodes", "-keyout", folder / "key.pem", "-out",
                folder / "request.pem", "-subj", f"/CN={name}").check_returncode()
        (folder / "names").write_text(f"subjectAltName=DNS:{name},IP:127.0.0.1\n")
        openssl("x509", "-req", "-in", folder / "request.pem", "-CA", self.certificate, "-CAkey",
                self._key, "-CAcreateserial", "-days", "1", "-extfile", folder / "names", "-out",
                folder / "cert.pem").check_returncode()
        return folder


def known(token):
    return "sha256:" + hashlib.sha256(token.encode()).hexdigest()


def bearer(token):
    return (("authorization", f"Bearer {token}"),)


class SecurityTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.authority = Authority(self.folder / "authority")

    def start(self, *flags):
        server = tools.Server(*flags)
        self.addCleanup(server.stop)
        return server

    def tls_flags(self, folder):
        return ("--tls-certificate-file", folder / "cert.pem", "--tls-key-file", folder / "key.pem")

    def channel(self, server, authority=None, client=None):
        """A connection of its own, encrypted."""
        credentials = grpc.ssl_channel_credentials(
            (authority or self.authority).certificate.read_bytes(),
            (client / "key.pem").read_bytes() if client else None,
            (client / "cert.pem").read_bytes() if client else None)
        channel = grpc.secure_channel(server.address, credentials,
                                      [("grpc.use_local_subchannel_pool", 1)])
        self.addCleanup(channel.close)
        return channel

    def list_models(self, channel, metadata=None):
        """The code of a call, and the reason in its details."""
        stub = synthesis_pb2_grpc.MotionSynthesisStub(channel)
        try:
            stub.ListModels(synthesis_pb2.ListModelsRequest(), timeout=tools.RUN_SECONDS,
                            metadata=metadata)
        except grpc.RpcError as error:
            info = stubs.details_of(error).get("ErrorInfo")
            return error.code().name, info.reason if info else None
        return "OK", None

    def shake(self, server, *flags):
        """What openssl's client says of a handshake."""
        return openssl("s_client", "-connect", server.address, "-alpn", "h2", "-brief", *flags,
                       stdin=subprocess.DEVNULL, errors="replace").stderr

    def test_handshakes_are_of_tls_1_2_and_1_3_with_forward_secrecy(self):
        server = self.start(*self.tls_flags(self.authority.issue("localhost", key="rsa")))
        low = ("-cipher", "ALL:@SECLEVEL=0")
        for version, flags in (("TLSv1.2", ("-tls1_2",)), ("TLSv1.3", ("-tls1_3",))):
            self.assertIn(f"Protocol version: {version}", self.shake(server, *flags))
        for old in ("-tls1", "-tls1_1"):
            self.assertNotIn("CONNECTION ESTABLISHED", self.shake(server, old, *low), old)
        for cipher in ("ECDHE-RSA-AES128-GCM-SHA256", "ECDHE-RSA-AES256-GCM-SHA384"):
            self.assertIn("CONNECTION ESTABLISHED",
                          self.shake(server, "-tls1_2", "-cipher", cipher), cipher)
        # Without forward secrecy, or without authenticated encryption.
        for weak in ("AES128-GCM-SHA256", "AES256-SHA", "ECDHE-RSA-AES128-SHA256",
                     "DHE-RSA-AES128-GCM-SHA256"):
            self.assertNotIn("CONNECTION ESTABLISHED",
                             self.shake(server, "-tls1_2", "-cipher", weak + ":@SECLEVEL=0"), weak)

    def test_both_sides_need_valid_certificates(self):
        stranger = Authority(self.folder / "stranger")
        server = self.start(*self.tls_flags(self.authority.issue("localhost")),
                            "--tls-client-ca-file", self.authority.certificate)
        client = self.authority.issue("client.example")
        self.assertEqual(self.list_models(self.channel(server, client=client))[0], "OK")
        for refused in (self.channel(server),
                        self.channel(server, client=stranger.issue("client.example")),
                        self.channel(server, authority=stranger, client=client)):
            self.assertEqual(self.list_models(refused)[0], "UNAVAILABLE")
        with grpc.insecure_channel(server.address) as plain:
            self.assertEqual(self.list_models(plain)[0], "UNAVAILABLE")

    def test_valid_tokens_are_required(self):
        access = self.folder / "access"
        access.write_text(f"studio synthesise {known('good')}\nops admin {known('admin')}\n"
                          f"slow synthesise {known('slow')} calls_per_second=0.001\n")
        server = self.start(*self.tls_flags(self.authority.issue("localhost")),
                            "--access-file", access)
        channel = self.channel(server)
        for metadata, answer in (
                (bearer("good"), ("OK", None)),
                (None, ("UNAUTHENTICATED", "CREDENTIALS_MISSING")),
                (bearer("bad"), ("UNAUTHENTICATED", "CREDENTIALS_INVALID")),
                (bearer("good") * 2, ("UNAUTHENTICATED", "CREDENTIALS_INVALID")),
                ((("authorization", "Basic Z29vZA=="),),
                 ("UNAUTHENTICATED", "CREDENTIALS_INVALID")),
                (bearer("admin"), ("PERMISSION_DENIED", "ROLE_MISSING")),
                (bearer("slow"), ("OK", None)),
                (bearer("slow"), ("RESOURCE_EXHAUSTED", "CALL_RATE_EXCEEDED")),
                (bearer("good"), ("OK", None))):
            self.assertEqual(self.list_models(channel, metadata), answer, metadata)
        # The way grpcio has for it.
        with grpc.secure_channel(server.address, grpc.composite_channel_credentials(
                grpc.ssl_channel_credentials(self.authority.certificate.read_bytes()),
                grpc.access_token_call_credentials("good"))) as composite:
            self.assertEqual(self.list_models(composite)[0], "OK")

    def test_client_sends_its_token_and_certificate(self):
        access = self.folder / "access"
        access.write_text(f"studio synthesise {known('good')}\n")
        server = self.start(*self.tls_flags(self.authority.issue("localhost")),
                            "--tls-client-ca-file", self.authority.certificate,
                            "--access-file", access)
        token = self.folder / "token"
        client = self.authority.issue("client.example")
        flags = ("models", "--server", server.address, "--tls-ca", self.authority.certificate,
                 "--tls-cert", client / "cert.pem", "--tls-key", client / "key.pem",
                 "--token-file", token)
        token.write_text("good\n")
        self.assertEqual(tools.duet(*flags).returncode, 0)
        token.write_text("bad\n")
        refused = tools.duet(*flags)
        self.assertEqual(refused.returncode, 42)
        self.assertIn("authorization", refused.stderr)
        self.assertNotIn("bad", refused.stderr)
        plain = tools.duet("models", "--server", "duet.example:50051", "--token-file", token)
        self.assertEqual(plain.returncode, 42)
        self.assertIn("token: expected TLS to duet.example:50051", plain.stderr)

    def test_certificates_and_tokens_rotate_under_load_without_a_failed_call(self):
        # A folder as Kubernetes mounts a secret: its files are links through a link that moves.
        secret = self.folder / "secret"
        secret.mkdir()
        for name in ("cert.pem", "key.pem", "access"):
            (secret / name).symlink_to(pathlib.Path("..data") / name)

        def mount(version, *tokens):
            folder = self.authority.issue("localhost", folder=secret / version)
            (folder / "access").write_text(
                "studio synthesise " + " ".join(map(known, tokens)) + "\n")
            (secret / "..next").symlink_to(version)
            os.rename(secret / "..next", secret / "..data")
            return ssl.PEM_cert_to_DER_cert((folder / "cert.pem").read_text())

        def shown():
            pem = ssl.get_server_certificate(("127.0.0.1", server.port))
            return ssl.PEM_cert_to_DER_cert(pem)

        first = mount("v0", "token-0", "token-1")
        server = self.start(*self.tls_flags(secret), "--access-file", secret / "access")
        self.assertEqual(shown(), first)
        failures, calls, stop = [], [], threading.Event()
        current = ["token-0"]

        def load(fresh):
            channel = self.channel(server)
            while not stop.is_set():
                if fresh:
                    channel = self.channel(server)
                answer = self.list_models(channel, bearer(current[0]))
                calls.append(answer)
                if answer[0] != "OK":
                    failures.append(answer)
                if fresh:
                    channel.close()

        threads = [threading.Thread(target=load, args=(fresh,)) for fresh in (False, True)]
        for thread in threads:
            thread.start()
        try:
            for i in range(1, 4):
                # The token to come is listed before it is used, and the last one while it is.
                certificate = mount(f"v{i}", f"token-{i - 1}", f"token-{i}", f"token-{i + 1}")
                tools.wait_until(lambda: shown() == certificate, "the new certificate")
                tools.wait_until(
                    lambda: self.list_models(self.channel(server), bearer(f"token-{i + 1}"))[0]
                    == "OK", "the new token")
                current[0] = f"token-{i}"
        finally:
            stop.set()
            for thread in threads:
                thread.join()
        self.assertEqual(failures, [])
        self.assertGreater(len(calls), 10)
        self.assertEqual(self.list_models(self.channel(server), bearer("token-0"))[0],
                         "UNAUTHENTICATED")
        self.assertEqual(server.events("secrets_refused"), [])


if __name__ == "__main__":
    tools.main()
