"""The server of soak.py: with TLS, an access file and a repository of its own."""

import hashlib
import json
import pathlib
import re
import secrets
import shutil
import subprocess
import time
import urllib.request

import grpc

import soak_requests

CHECKPOINT = soak_requests.SOURCE / "model/embedded/sbu/1"


def run(*command, **options):
    return subprocess.run([str(word) for word in command], capture_output=True, text=True,
                          check=False, **options)


class Authority:
    """Signs certificates for this machine."""

    def __init__(self, folder):
        folder.mkdir()
        self.folder, self.certificate = folder, folder / "ca.pem"
        self._openssl("req", "-x509", *self._KEY, "-keyout", folder / "ca.key", "-out",
                      self.certificate, "-days", "2", "-subj", "/CN=authority")
        (folder / "names").write_text("subjectAltName=DNS:localhost,IP:127.0.0.1\n")

    _KEY = ("-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256", "-nodes")

    @staticmethod
    def _openssl(*arguments):
        run("openssl", *arguments).check_returncode()

    def issue(self, target):
        """Writes cert.pem and key.pem to a folder, each atomically."""
        self._openssl("req", *self._KEY, "-keyout", target / "key.new", "-out",
                      self.folder / "request", "-subj", "/CN=localhost")
        self._openssl("x509", "-req", "-in", self.folder / "request", "-CA", self.certificate,
                      "-CAkey", self.folder / "ca.key", "-CAcreateserial", "-days", "1", "-extfile",
                      self.folder / "names", "-out", target / "cert.new")
        for name in ("key", "cert"):
            (target / f"{name}.new").rename(target / f"{name}.pem")


def write_checkpoint(folder, version, spoil=False):
    """Writes the embedded checkpoint as another version; with `spoil`, its checksum is wrong."""
    manifest = json.loads((CHECKPOINT / "manifest.json").read_text(encoding="utf-8"))
    manifest["version"] = version
    if spoil:
        manifest["weights"]["sha256"] = "0" * 64
    partial = folder.parent / f".{folder.name}.partial"
    shutil.rmtree(partial, ignore_errors=True)
    partial.mkdir(parents=True)
    shutil.copy(CHECKPOINT / manifest["weights"]["file"], partial)
    (partial / "manifest.json").write_text(json.dumps(manifest), encoding="utf-8")
    shutil.rmtree(folder, ignore_errors=True)
    partial.rename(folder)


class Server:
    """A duet-server whose models, certificates and tokens can change while it runs."""

    def __init__(self, program, folder):
        self.folder, self.models = folder, folder / "models"
        self.authority = Authority(folder / "authority")
        self.authority.issue(folder)
        self.tokens = {name: secrets.token_hex(32) for name in ("farm", "load", "ops")}
        self.write_access()
        (folder / "ops.token").write_text(self.tokens["ops"])
        for version in (1, 2):
            write_checkpoint(self.models / "sbu" / str(version), version)
        self.log_path = folder / "log"
        self.log = self.log_path.open("w", encoding="utf-8")
        self.process = subprocess.Popen(
            [program, "--listen", "127.0.0.1:0", "--metrics-listen", "127.0.0.1:0",
             "--admin-listen", "127.0.0.1:0", "--model-repository", self.models,
             "--version-label", "sbu:stable=1", "--tls-certificate-file", folder / "cert.pem",
             "--tls-key-file", folder / "key.pem", "--access-file", folder / "access",
             "--log-success-ratio", "0.001"], stdout=self.log, stderr=self.log)
        pattern = r'"event":"serving".*?"port":(\d+),"metrics_port":(\d+),"admin_port":(\d+)'
        while not (found := re.search(pattern, self.log_path.read_text(encoding="utf-8"))):
            if self.process.poll() is not None:
                raise SystemExit(self.log_path.read_text(encoding="utf-8"))
            time.sleep(0.02)
        self.port, self.metrics_port, self.admin_port = map(int, found.groups())

    @property
    def address(self):
        return f"localhost:{self.port}"

    def write_access(self, old_farm=None):
        """Writes the access file. With `old_farm`, the caller farm has two tokens."""
        known = {name: ["sha256:" + hashlib.sha256(token.encode()).hexdigest()]
                 for name, token in self.tokens.items()}
        if old_farm:
            known["farm"].append("sha256:" + hashlib.sha256(old_farm.encode()).hexdigest())
        text = (f"farm synthesise {' '.join(known['farm'])}\n"
                f"load synthesise {known['load'][0]}\nops admin {known['ops'][0]}\n")
        (self.folder / "access.new").write_text(text)
        (self.folder / "access.new").rename(self.folder / "access")

    def channel(self):
        credentials = grpc.ssl_channel_credentials(self.authority.certificate.read_bytes())
        return grpc.secure_channel(self.address, credentials, options=[
            ("grpc.use_local_subchannel_pool", 1), ("grpc.max_send_message_length", -1)])

    def status(self, key):
        text = pathlib.Path(f"/proc/{self.process.pid}/status").read_text(encoding="utf-8")
        return int(re.search(rf"{key}:\s+(\d+)", text)[1])

    def resident(self):
        """Bytes in memory."""
        return 1024 * self.status("VmRSS")

    def descriptors(self):
        return len(list(pathlib.Path(f"/proc/{self.process.pid}/fd").iterdir()))

    def metrics(self):
        """Metric name with labels -> value."""
        with urllib.request.urlopen(f"http://127.0.0.1:{self.metrics_port}/metrics") as page:
            lines = page.read().decode().splitlines()
        return {name: float(value) for name, _, value in
                (line.rpartition(" ") for line in lines if line and not line.startswith("#"))}

    def total(self, family):
        return sum(value for name, value in self.metrics().items() if name.startswith(family + "{"))

    def in_flight(self):
        return self.total("duet_calls_in_flight")

    def stop(self):
        self.process.terminate()
        try:
            return self.process.wait(timeout=120)
        finally:
            self.process.kill()
            self.process.wait()
