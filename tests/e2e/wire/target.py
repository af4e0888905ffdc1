"""The server that is fuzzed: its models, its flags, and what it offers by its own account."""

import contextlib
import json
import pathlib
import shutil
import subprocess
import tempfile

import tools
from fuzzing import Finding
from wire import corpus, judge, protobuf, rounds
from wire.protobuf import message

KEPT_LINES = 2000
FLAGS = ("--admin-listen", "127.0.0.1:0", "--default-model", "sbu", "--self-check-seconds", "1")
# What never comes, or is never read, is given up soon, so that rounds follow quickly.
IMPATIENT = ("--receive-timeout-seconds", "1", "--write-timeout-seconds", "2", "--live-idle-seconds", "1")
REPORTS = ("Sanitizer", "runtime error:", "Assertion", "terminate called", "buffer overflow",
           "stack smashing")


class Target:
    """A running server. Without `flags`, it has no patience and a repository of two models, "sbu" and one to play
    with."""

    def __init__(self, program=None, flags=None):
        self._resources = contextlib.ExitStack()
        with contextlib.ExitStack() as on_failure:
            on_failure.callback(self._resources.close)
            if flags is None:
                folder = self._resources.enter_context(tempfile.TemporaryDirectory())
                copy_model("sbu/3", pathlib.Path(folder, "sbu/3"), "sbu")
                copy_model("sbu/1", pathlib.Path(folder, corpus.SPARE, "1"), corpus.SPARE)
                flags = (*IMPATIENT, "--model-repository", folder)
            options = {} if program is None else {"program": program}
            self.server = tools.Server(*FLAGS, *flags, metrics="127.0.0.1:0", kept_lines=KEPT_LINES, **options)
            on_failure.pop_all()
        self.ports = {rounds.SERVICE: self.server.port, rounds.METRICS: self.server.metrics_port,
                      rounds.ADMIN: self.server.events("serving")[0]["admin_port"]}

    def methods(self, patience):
        """[(port, "service/method", real requests of it)] of everything it serves."""
        requests = corpus.requests_of_methods(tools.SOURCE)
        offered = [(port, method) for port in (rounds.SERVICE, rounds.ADMIN)
                   for method in methods_of(self.ports[port], patience)]
        unknown = sorted({method for _, method in offered} - set(requests))
        if unknown:
            raise Finding(f"{', '.join(unknown)}: give it real requests in "
                                "tests/e2e/wire/corpus.py")
        return [(port, method, requests[method]) for port, method in offered]

    def stop(self):
        """Ends it with SIGTERM; raises Finding unless it stops cleanly, having reported nothing."""
        try:
            code = self.server.stop()
        except subprocess.TimeoutExpired as error:
            raise Finding("SIGTERM: the server goes on") from error
        finally:
            self._resources.close()
        if self.complaints():
            raise Finding("the server reported an error")
        if code != 0:
            raise Finding(f"SIGTERM: the server ended with {code}, not 0")

    def kill(self):
        self.server.kill()
        self._resources.close()

    def complaints(self):
        """The lines of its log that the log did not write, from the first that reports an error."""
        lines = [entry["text"] for entry in list(self.server.log) if set(entry) == {"text"}]
        for i, line in enumerate(lines):
            if any(word in line for word in REPORTS):
                return lines[i:]
        return []


def copy_model(name, folder, new_name):
    """A built-in checkpoint under another name."""
    shutil.copytree(tools.SOURCE / "model/embedded" / name, folder)
    manifest = json.loads((folder / "manifest.json").read_text(encoding="utf-8"))
    manifest["name"] = new_name
    (folder / "manifest.json").write_text(json.dumps(manifest), encoding="utf-8")


def methods_of(port, patience):
    """What a port serves, as "service/method", by its reflection service."""
    methods = []
    for answer in reflect(port, message(f7=""), patience):
        for service in protobuf.values(protobuf.values(answer, 6)[0], 1):
            name = protobuf.values(service, 1)[0].decode()
            methods += [f"{name}/{method}" for method in methods_of_service(port, name, patience)]
    return methods


def methods_of_service(port, service, patience):
    """The names in the descriptor (google/protobuf/descriptor.proto) of a service; those of the corpus
    for one that reflection only names, as it does gRPC's own health service."""
    for answer in reflect(port, message(f4=service), patience):
        for files in protobuf.values(answer, 4):
            for file in protobuf.values(files, 1):
                package = b"".join(protobuf.values(file, 2)).decode()
                for descriptor in protobuf.values(file, 6):
                    if f"{package}.{protobuf.values(descriptor, 1)[0].decode()}" == service:
                        return [protobuf.values(method, 1)[0].decode()
                                for method in protobuf.values(descriptor, 2)]
    known = [method.split("/")[1] for method in corpus.requests_of_methods(tools.SOURCE)
             if method.startswith(f"{service}/")]
    if not known:
        raise Finding(f"{service}: give it real requests in tests/e2e/wire/corpus.py")
    return known


def reflect(port, request, patience):
    status, answers = judge.call(port, f"{corpus.REFLECTION}/ServerReflectionInfo", request,
                                 patience)
    if status != "0":
        raise Finding(f"reflection: status {status}")
    return answers
