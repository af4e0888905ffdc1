#!/usr/bin/env python3
"""Soak test: every kind of caller against a server while an operator changes everything that can be
changed. Checks calls, memory, descriptors and threads.

    benchmarks/soak.py BUILD [--seconds 1200] [--rounds 20] [--callers 6] [--rate 20] [--out FOLDER]

Callers request short and long clips, cancel, set tight deadlines, send invalid requests, disconnect;
duet-load sends calls at a steady rate. Meanwhile models are reloaded (SIGHUP and `duet admin`),
loaded, unloaded and rejected, labels move, certificates and tokens are rotated. The server has TLS,
an access file and a repository of its own.

After each round all callers pause. One large request makes the server return its free memory, and
resident memory is read when no call is left. Growth is the median of the last quarter of the rounds
over that of the first quarter after the warm-up (the first fifth).

Exits with 1 if a call was lost (it ended without a status, or with part of its answer), ended in a
way that its kind may not, or was begun and never finished by the server's own count; if an action
failed, memory grew by more than --max-growth, descriptors are left over, or the server did not exit
cleanly. Writes soak.md, soak.svg and soak.json to FOLDER. Needs python3-grpcio,
python3-matplotlib, protobuf-compiler and openssl. docs/soak.md is such a report.
"""

import argparse
import collections
import contextlib
import hashlib
import json
import pathlib
import random
import re
import secrets
import shutil
import signal
import statistics
import subprocess
import sys
import tempfile
import threading
import time
import traceback
import urllib.request

import grpc

import measure_hostile as hostile

sys.path.insert(0, str(hostile.SOURCE / "scripts"))
from report import palette, plots  # noqa: E402

CHECKPOINT = hostile.SOURCE / "model/embedded/sbu/1"
LONG_DEADLINE = 600.0  # whoever waits so long was forgotten, however busy the machine is


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
        """Puts cert.pem and key.pem into a folder, each at a stroke."""
        self._openssl("req", *self._KEY, "-keyout", target / "key.new", "-out",
                      self.folder / "request", "-subj", "/CN=localhost")
        self._openssl("x509", "-req", "-in", self.folder / "request", "-CA", self.certificate,
                      "-CAkey", self.folder / "ca.key", "-CAcreateserial", "-days", "1", "-extfile",
                      self.folder / "names", "-out", target / "cert.new")
        for name in ("key", "cert"):
            (target / f"{name}.new").rename(target / f"{name}.pem")


def write_checkpoint(folder, version, spoil=False):
    """The embedded checkpoint as another version; `spoil`: with weights that do not match."""
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
    """A duet-server with all that can be changed while it runs."""

    def __init__(self, program, folder):
        self.folder, self.models = folder, folder / "models"
        self.authority = Authority(folder / "authority")
        self.authority.issue(folder)
        self.tokens = {name: secrets.token_hex(32) for name in ("farm", "load", "ops")}
        self.write_access()
        (folder / "ops.token").write_text(self.tokens["ops"])
        (folder / "load.token").write_text(self.tokens["load"])
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
        """Who may call; with `old_farm` the caller farm has two tokens."""
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
        """Every figure, by its name with its labels."""
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


class Gate:
    """Open while there is load; closing it waits until everybody has come out."""

    def __init__(self):
        self._changed, self._open, self._inside, self.over = threading.Condition(), False, 0, False

    def set(self, is_open):
        with self._changed:
            self._open = is_open
            self._changed.notify_all()
            self._changed.wait_for(lambda: is_open or self._inside == 0)

    def end(self):
        with self._changed:
            self.over = True
            self._changed.notify_all()

    @contextlib.contextmanager
    def inside(self):
        """Whether there is still anything to do."""
        with self._changed:
            self._changed.wait_for(lambda: self._open or self.over)
            self._inside += 1
        try:
            yield not self.over
        finally:
            with self._changed:
                self._inside -= 1
                self._changed.notify_all()


class Callers:
    """Callers of every kind, each in a thread of its own."""

    # How often each kind is played, and how its calls may end. Cancelled and expired calls may also
    # be done before that happens.
    KINDS = {
        "short clip": (40, {"OK", "RESOURCE_EXHAUSTED"}),
        "long clip": (8, {"OK", "RESOURCE_EXHAUSTED"}),
        "bulk clip": (8, {"OK", "RESOURCE_EXHAUSTED"}),
        "labelled version": (8, {"OK", "RESOURCE_EXHAUSTED"}),
        "version that comes and goes": (8, {"OK", "NOT_FOUND", "RESOURCE_EXHAUSTED"}),
        "large request": (1, {"OK", "RESOURCE_EXHAUSTED", "INVALID_ARGUMENT"}),
        "cancelled at once": (8, {"CANCELLED"}),
        "cancelled in the middle": (8, {"CANCELLED", "OK", "RESOURCE_EXHAUSTED"}),
        "connection closed in the middle": (4, {"CANCELLED", "OK", "RESOURCE_EXHAUSTED"}),
        "deadline of 5 ms": (8, {"DEADLINE_EXCEEDED", "OK", "RESOURCE_EXHAUSTED"}),
        "deadline of 50 ms": (8, {"DEADLINE_EXCEEDED", "OK", "RESOURCE_EXHAUSTED"}),
        "bytes that are no request": (6, {"INVALID_ARGUMENT"}),
        "unknown class": (6, {"INVALID_ARGUMENT"}),
        "joint that is no number": (6, {"INVALID_ARGUMENT"}),
        "unknown model": (6, {"NOT_FOUND"}),
        "wrong token": (6, {"UNAUTHENTICATED"}),
        "no token": (6, {"UNAUTHENTICATED"}),
        "list of models": (10, {"OK"}),
        "new connection": (6, {"OK", "RESOURCE_EXHAUSTED"}),
    }

    def __init__(self, server, protos, callers, seed):
        self.server, self.protos = server, protos
        self.gate = Gate()
        self.token = server.tokens["farm"]
        self.ended = collections.Counter()  # (kind, code)
        self.lost, self.unexpected = [], collections.Counter()
        self._lock = threading.Lock()
        self._requests = self._make_requests()
        self._threads = [threading.Thread(target=self._run, args=(random.Random(f"{seed} {i}"),))
                         for i in range(callers)]
        for thread in self._threads:
            thread.start()

    def end(self):
        self.gate.end()
        for thread in self._threads:
            thread.join()

    def _make_requests(self):
        def request(frames=46, change=None):
            message = self.protos[1].SynthesizeRequest.FromString(
                hostile.sample_request(self.protos, frames))
            if change:
                change(message)
            return message.SerializeToString()

        def select(**selector):
            return lambda message: message.model.MergeFrom(type(message.model)(**selector))

        def spoil(message):
            message.leader.positions[7] = float("nan")
        bulk = self.protos[1].PRIORITY_BULK
        return {
            "short": request(), "long": request(900),
            "bulk": request(200, lambda message: setattr(message, "priority", bulk)),
            "labelled": request(46, select(name="sbu", version_label="stable")),
            "version": request(46, select(name="sbu", version=2)),
            "model": request(46, select(name="nobody")),
            "large": hostile.sample_request(self.protos, 36000, rate=240.0),
            "class": request(46, lambda message: setattr(
                message.label_vector.weights[0], "interaction_class", "levitate")),
            "nan": request(46, spoil),
        }

    def _run(self, chance):
        channel = self.server.channel()
        kinds, weights = zip(*((kind, weight) for kind, (weight, _) in self.KINDS.items()))
        while True:
            with self.gate.inside() as goes_on:
                if not goes_on:
                    break
                kind = chance.choices(kinds, weights)[0]
                try:
                    self._count(kind, self._play(kind, channel, chance))
                except Exception:  # pylint: disable=broad-except
                    self._lose(kind, traceback.format_exc())
            time.sleep(chance.expovariate(1 / 0.02))
        channel.close()

    def _count(self, kind, code):
        with self._lock:
            self.ended[kind, code] += 1
            if code not in self.KINDS[kind][1]:
                self.unexpected[kind, code] += 1

    def _lose(self, kind, why):
        with self._lock:
            self.lost.append(f"{kind}: {why}")

    def _metadata(self, token=None):
        return (("authorization", f"Bearer {token or self.token}"),)

    def _play(self, kind, channel, chance):
        """Makes a call of a kind; the status that it ended with."""
        sent = {"long clip": "long", "bulk clip": "bulk", "labelled version": "labelled",
                "version that comes and goes": "version", "large request": "large",
                "unknown class": "class", "joint that is no number": "nan",
                "unknown model": "model"}.get(kind, "short")
        request = self._requests[sent]
        if kind == "bytes that are no request":
            request = chance.randbytes(chance.randrange(1, 2000))
            request = b"\x0a\xff\xff" + request  # a field longer than the message
        if kind == "list of models":
            return self._end_of(kind, channel.unary_stream(hostile.LIST_MODELS)(
                b"", timeout=LONG_DEADLINE, metadata=self._metadata()), whole=False)
        if kind in ("new connection", "connection closed in the middle"):
            with self.server.channel() as own:
                stream = own.unary_stream(hostile.SYNTHESIZE)(
                    request if kind == "new connection" else self._requests["long"],
                    timeout=LONG_DEADLINE, metadata=self._metadata())
                if kind == "new connection":
                    return self._end_of(kind, stream)
                with contextlib.suppress(grpc.RpcError, StopIteration):
                    next(stream)
            return self._end_of(kind, stream, whole=False)
        metadata = {"wrong token": self._metadata(secrets.token_hex(32)),
                    "no token": None}.get(kind, self._metadata())
        timeout = {"deadline of 5 ms": 0.005, "deadline of 50 ms": 0.05}.get(kind, LONG_DEADLINE)
        if kind == "cancelled in the middle":
            request = self._requests["long"]
        stream = channel.unary_stream(hostile.SYNTHESIZE)(request, timeout=timeout,
                                                          metadata=metadata)
        if kind == "cancelled at once":
            stream.cancel()
        if kind == "cancelled in the middle":
            with contextlib.suppress(grpc.RpcError, StopIteration):
                next(stream)
            stream.cancel()
        return self._end_of(kind, stream, whole=not kind.startswith("cancelled"))

    def _end_of(self, kind, stream, whole=True):
        """Reads an answer to its end. A call of patience that expires was forgotten by the server,
        and an answer that says OK has all its frames."""
        wanted = came = 0
        try:
            for message in stream:
                if whole:
                    response = self.protos[1].SynthesizeResponse.FromString(message)
                    wanted = wanted or response.header.frame_count
                    came += response.chunk.frame_count
        except grpc.RpcError as error:
            code = error.code().name
            if code == "DEADLINE_EXCEEDED" and not kind.startswith("deadline"):
                self._lose(kind, f"no end within {LONG_DEADLINE} s")
            return code
        if whole and (came == 0 or came != wanted):
            self._lose(kind, f"{came} frames of {wanted}")
        return "OK"


class Operator:
    """Changes what can be changed, one thing after the other."""

    def __init__(self, server, callers, client, seed):
        self.server, self.callers, self.client = server, callers, client
        self.done, self.failed = collections.Counter(), []
        self._chance = random.Random(f"{seed} operator")
        self._over = threading.Event()
        self._thread = None

    def begin(self):
        self._over.clear()
        self._thread = threading.Thread(target=self._run)
        self._thread.start()

    def pause(self):
        self._over.set()
        self._thread.join()

    def _run(self):
        actions = (self._hang_up, self._reload, self._load_again, self._move_label,
                   self._unload_and_load, self._bad_checkpoint, self._rotate_certificate,
                   self._rotate_token)
        while not self._over.wait(self._chance.uniform(0.2, 1.0)):
            action = self._chance.choice(actions)
            name = action.__name__.strip("_").replace("_", " ")
            try:
                action()
                self.done[name] += 1
            except Exception as error:  # pylint: disable=broad-except
                self.failed.append(f"{name}: {error}")

    def _admin(self, *arguments, code=0):
        done = run(self.client, "admin", "--admin-server", f"localhost:{self.server.admin_port}",
                   "--tls-ca", self.server.authority.certificate, "--token-file",
                   self.server.folder / "ops.token", *arguments)
        if done.returncode != code:
            raise RuntimeError(f"exit code {done.returncode}: {done.stdout}{done.stderr}")

    def _await(self, what, happened):
        end = time.monotonic() + 60
        while not happened():
            if time.monotonic() > end:
                raise RuntimeError(f"waited in vain: {what}")
            time.sleep(0.1)

    def _hang_up(self):
        before = self.server.total("duet_reloads_total")
        self.server.process.send_signal(signal.SIGHUP)
        self._await("a reload", lambda: self.server.total("duet_reloads_total") > before)

    def _reload(self):
        write_checkpoint(self.server.models / "sbu" / "2", 2)
        self._admin("reload")

    def _load_again(self):
        self._admin("load", "sbu", str(self._chance.choice((1, 2))))

    def _move_label(self):
        self._admin("label", "sbu", "canary", str(self._chance.choice((1, 2))))
        self._admin("label", "sbu", "canary", "--delete")

    def _unload_and_load(self):
        self._admin("unload", "sbu", "2")
        self._admin("load", "sbu", "2")

    def _bad_checkpoint(self):
        write_checkpoint(self.server.models / "sbu" / "3", 3, spoil=True)
        self._admin("load", "sbu", "3", code=42)
        shutil.rmtree(self.server.models / "sbu" / "3")
        self._admin("reload")

    def _rotate_certificate(self):
        taken = 'duet_secrets_reloads_total{kind="tls",outcome="taken"}'
        before = self.server.metrics().get(taken, 0)
        self.server.authority.issue(self.server.folder)
        self._await("the certificate", lambda: self.server.metrics().get(taken, 0) > before)

    def _rotate_token(self):
        taken = 'duet_secrets_reloads_total{kind="access",outcome="taken"}'
        old = self.server.tokens["farm"]
        for old_farm in (old, None):
            before = self.server.metrics().get(taken, 0)
            if old_farm:
                self.server.tokens["farm"] = secrets.token_hex(32)
            else:
                # Calls with the old token are all over before it goes.
                self.callers.token = self.server.tokens["farm"]
                self.callers.gate.set(False)
                self.callers.gate.set(True)
            self.server.write_access(old_farm)
            self._await("the access file", lambda: self.server.metrics().get(taken, 0) > before)


class Sampler:
    """Memory, descriptors and threads, ten times a second of a short run and more seldom of a long
    one."""

    def __init__(self, server, seconds):
        self.server, self.samples = server, []
        self._begin, self._over = time.monotonic(), threading.Event()
        self._thread = threading.Thread(target=self._run, args=(max(0.1, seconds / 600),))
        self._thread.start()

    def now(self):
        return time.monotonic() - self._begin

    def _run(self, pause):
        while not self._over.wait(pause):
            self.samples.append((self.now(), self.server.resident(), self.server.descriptors(),
                                 self.server.status("Threads")))

    def end(self):
        self._over.set()
        self._thread.join()


def settle(server, callers):
    """Waits until nothing is going on and the server has given back what it does not need."""
    with server.channel() as channel:
        stream = channel.unary_stream(hostile.SYNTHESIZE)(
            hostile.sample_request(callers.protos, 36000, rate=240.0), timeout=LONG_DEADLINE,
            metadata=(("authorization", f"Bearer {server.tokens['load']}"),))
        with contextlib.suppress(grpc.RpcError):
            next(stream)
        stream.cancel()
    end = time.monotonic() + LONG_DEADLINE
    while server.in_flight() > 0 and time.monotonic() < end:
        time.sleep(0.05)
    time.sleep(3)  # the server looks at its heap every second, and twice after large requests


def play(args, server, callers, operator, sampler):
    """All rounds; what was resident after each, and how duet-load's calls ended."""
    settled, steady = [], collections.Counter()
    for number in range(args.rounds):
        callers.gate.set(True)
        operator.begin()
        load = run(args.build / "bin/duet-load", "--server", server.address, "--tls-ca",
                   server.authority.certificate, "--token-file", server.folder / "load.token",
                   "--rate", args.rate, "--frames", "46=8,460=1", "--seconds",
                   max(0.5, args.seconds / args.rounds - 1), "--warm-up", "0", "--deadline",
                   LONG_DEADLINE, "--connections", "2", "--seed", number, "--json", "-", "--quiet")
        operator.pause()
        callers.gate.set(False)
        if not load.stdout:  # where none of few calls was answered its status says so, too
            raise SystemExit(f"duet-load ended with {load.returncode}: {load.stderr}")
        steady.update(json.loads(load.stdout)["steps"][0]["ended"])
        settle(server, callers)
        settled.append((sampler.now(), server.resident(), server.descriptors(),
                        server.status("Threads")))
        print(f"round {number + 1} of {args.rounds}: {settled[-1][1] / 1e6:.1f} MB, "
              f"{sum(callers.ended.values())} calls, {len(callers.lost)} lost", file=sys.stderr,
              flush=True)
    return settled, steady


def growth_of(settled):
    """By how much resident memory grew after the warm-up, as a part of it."""
    values = [sample[1] for sample in settled]
    rest = values[len(values) // 5:]
    quarter = max(1, len(rest) // 4)
    return statistics.median(rest[-quarter:]) / statistics.median(rest[:quarter]) - 1


def draw(samples, settled, file):
    """Draws resident memory over time: a line under load, dots settled after each round."""
    plots.use_matplotlib()
    from matplotlib import pyplot
    unit, name = (60, "minutes") if max(sample[0] for sample in samples + settled) > 180 else (
        1, "seconds")
    figure, axes = pyplot.subplots(figsize=(8.2, 3.8))
    for index, (readings, style, label) in enumerate((
            (samples, {"linewidth": 1.2}, "under load"),
            (settled, {"linestyle": "", "marker": "o"}, "settled after each round"))):
        axes.plot([time / unit for time, *_ in readings], [rss / 1e6 for _, rss, *_ in readings],
                  color=palette.colour(index), label=label, **style)
    axes.set_title("Resident memory, MB")
    axes.set_xlabel(name)
    axes.set_ylim(bottom=0)
    axes.grid(axis="y", color=palette.GRID)
    axes.legend(loc="lower right")
    figure.savefig(file, bbox_inches="tight", metadata={"Date": None})
    pyplot.close(figure)


def spread(values):
    return f"{min(values)} to {max(values)}"


def describe(args, figures, callers, steady, operator, sampler, settled):
    """The report as Markdown."""
    rest = settled[len(settled) // 5:]
    lines = [
        "| | |", "|---|---|",
        f"| seconds under load | {args.seconds:g}, in {args.rounds} rounds |",
        f"| calls | {figures['calls']} |",
        f"| **lost calls** | **{figures['lost']}** |",
        f"| calls with an unexpected status | {figures['unexpected']} |",
        f"| started but not finished, by the server's count | {figures['unfinished']} |",
        f"| operator changes, of these failed | {sum(operator.done.values())}, "
        f"{len(operator.failed)} |",
        f"| settled resident memory after the warm-up: first, last | {rest[0][1] / 1e6:.1f} MB, "
        f"{rest[-1][1] / 1e6:.1f} MB |",
        f"| **growth after the warm-up** | **{100 * figures['growth']:.2f} %** |",
        f"| maximum resident memory under load | {max(s[1] for s in sampler.samples) / 1e6:.0f} MB |",
        f"| descriptors, settled; under load | {spread([s[2] for s in settled])}; "
        f"{spread([s[2] for s in sampler.samples])} |",
        f"| threads, settled; under load | {spread([s[3] for s in settled])}; "
        f"{spread([s[3] for s in sampler.samples])} |",
        f"| exit code after SIGTERM | {figures['exit_code']} |",
        "", "![Resident memory over time](images/soak.svg)", "", "Status codes by kind of call:", "",
        "| kind | " + " | ".join(codes := sorted({code for _, code in callers.ended} |
                                                  set(steady))) + " |",
        "|---|" + "---|" * len(codes)]
    rows = [(kind, {code: callers.ended[kind, code] for code in codes})
            for kind in Callers.KINDS] + [("duet-load's", steady)]
    for kind, counts in rows:
        lines.append(f"| {kind} | " + " | ".join(str(counts.get(code) or "") for code in codes) +
                     " |")
    lines += ["", "Operator changes:", "", "| change | times |", "|---|---|"]
    lines += [f"| {name} | {count} |" for name, count in sorted(operator.done.items())]
    return "\n".join(lines) + "\n"


def soak(args, folder, protos):
    server = Server(args.server, folder)
    try:
        sampler = Sampler(server, args.seconds)
        callers = Callers(server, protos, args.callers, args.seed)
        operator = Operator(server, callers, args.build / "bin/duet", args.seed)
        try:
            settled, steady = play(args, server, callers, operator, sampler)
        finally:
            callers.end()
            sampler.end()
        metrics = server.metrics()
    finally:
        exit_code = server.stop()

    def total(family):
        return sum(value for name, value in metrics.items() if name.startswith(family + "{"))
    figures = {
        "calls": sum(callers.ended.values()) + sum(steady.values()),
        "lost": len(callers.lost) + steady["INTERNAL"] + steady["DEADLINE_EXCEEDED"],
        "unexpected": sum(callers.unexpected.values()) + sum(
            count for code, count in steady.items() if code not in ("OK", "RESOURCE_EXHAUSTED")),
        "unfinished": int(total("grpc_server_started_total") - total("grpc_server_handled_total")),
        "failed_actions": len(operator.failed),
        "growth": growth_of(settled),
        "descriptors_left": settled[-1][2] - settled[0][2],
        "exit_code": exit_code,
    }
    report = describe(args, figures, callers, steady, operator, sampler, settled)
    print(report)
    for line in callers.lost[:10] + operator.failed[:10]:
        print(line, file=sys.stderr)
    for (kind, code), count in callers.unexpected.items():
        print(f"{kind}: {count} {code}", file=sys.stderr)
    if args.out:
        args.out.mkdir(parents=True, exist_ok=True)
        (args.out / "soak.md").write_text(report, encoding="utf-8")
        draw(sampler.samples, settled, args.out / "soak.svg")
        figures["samples"], figures["settled"] = sampler.samples, settled
        (args.out / "soak.json").write_text(json.dumps(figures), encoding="utf-8")
        shutil.copy(server.log_path, args.out / "server.log")
    return figures


def passes(figures, max_growth):
    nothing = ("lost", "unexpected", "unfinished", "failed_actions", "exit_code")
    return (not any(figures[name] for name in nothing) and figures["growth"] <= max_growth
            and figures["descriptors_left"] <= 2)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--seconds", type=float, default=1200, help="under load, all rounds")
    parser.add_argument("--rounds", type=int, default=20)
    parser.add_argument("--callers", type=int, default=6)
    parser.add_argument("--rate", type=float, default=20, help="duet-load's calls a second")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--max-growth", type=float, default=0.02)
    parser.add_argument("--server", type=pathlib.Path)
    parser.add_argument("--out", type=pathlib.Path)
    args = parser.parse_args()
    args.server = args.server or args.build / "bin/duet-server"
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "protos").mkdir()
        figures = soak(args, folder, hostile.load_protos(str(folder / "protos")))
    sys.exit(0 if passes(figures, args.max_growth) else 1)


if __name__ == "__main__":
    main()
