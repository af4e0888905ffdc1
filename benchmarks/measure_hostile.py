#!/usr/bin/env python3
"""Plays hostile clients that obey the protocol against a real server and measures the effects.

    benchmarks/measure_hostile.py BUILD [SCENARIO ...] [--server PROGRAM] [--client PROGRAM]

PROGRAMs default to BUILD/bin/duet-server and BUILD/bin/duet: an older server can be measured with the
same clients. Prints a table row for each figure. Needs python3-grpcio and protobuf-compiler. Hostile
clients use 127.0.0.2, so that the server distinguishes them from the regular callers.
docs/hostile_clients.md has the findings behind the scenarios, and figures.
"""

import argparse
import contextlib
import http.client
import json
import pathlib
import re
import signal
import socket
import statistics
import subprocess
import sys
import tempfile
import threading
import time

import grpc

SOURCE = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(SOURCE / "tests/e2e"))
import http2_client as http2  # pylint: disable=wrong-import-position
from free_ports import free_port  # pylint: disable=wrong-import-position
from load_tool import run_load  # pylint: disable=wrong-import-position

HOSTILE = "127.0.0.2"
SYNTHESIZE = "/duet.v1.MotionSynthesis/Synthesize"
LIST_MODELS = "/duet.v1.MotionSynthesis/ListModels"
MIB = 1 << 20


def say(scenario, figure, value):
    print(f"| {scenario} | {figure} | {value} |", flush=True)


class Server:
    """A server of its own for each scenario."""

    def __init__(self, program, *flags, port=0, descriptors=None):
        self.log = tempfile.NamedTemporaryFile("w+", suffix=".log")
        limit = [] if descriptors is None else ["prlimit", f"--nofile={descriptors}"]
        self.process = subprocess.Popen(
            [*limit, program, "--listen", f"127.0.0.1:{port}", "--metrics-listen", "127.0.0.1:0",
             *flags], stdout=self.log, stderr=self.log)
        while not (found := re.search(r'"serving".*?"port":(\d+),"metrics_port":(\d+)',
                                      self.text())):
            if self.process.poll() is not None:
                raise SystemExit(f"{program} did not start:\n{self.text()}")
            time.sleep(0.02)
        self.port, self.metrics_port = int(found[1]), int(found[2])

    def text(self):
        return pathlib.Path(self.log.name).read_text(encoding="utf-8")

    def memory(self, key="VmRSS"):
        status = pathlib.Path(f"/proc/{self.process.pid}/status").read_text(encoding="utf-8")
        return int(re.search(rf"{key}:\s+(\d+)", status)[1]) * 1024 // 1_000_000

    def forget_peak(self):
        pathlib.Path(f"/proc/{self.process.pid}/clear_refs").write_text("5", encoding="utf-8")

    def get(self, path, timeout=5):
        """Status and text of a page of the metrics port, and the seconds it took."""
        begin = time.monotonic()
        connection = http.client.HTTPConnection("127.0.0.1", self.metrics_port, timeout=timeout)
        try:
            connection.request("GET", path)
            response = connection.getresponse()
            return response.status, response.read().decode(), time.monotonic() - begin
        except OSError:
            return None, "", time.monotonic() - begin
        finally:
            connection.close()

    def in_flight(self):
        found = re.search(r'duet_calls_in_flight\{method="Synthesize"\} (\d+)',
                          self.get("/metrics")[1])
        return int(found[1]) if found else 0

    @property
    def address(self):
        return f"127.0.0.1:{self.port}"

    def channel(self):
        return grpc.insecure_channel(self.address, options=[
            ("grpc.use_local_subchannel_pool", 1), ("grpc.max_send_message_length", -1),
            ("grpc.max_receive_message_length", -1)])

    def stop(self, with_signal=signal.SIGTERM):
        self.process.send_signal(with_signal)
        self.process.wait(timeout=90)


@contextlib.contextmanager
def running(program, *flags, **options):
    server = Server(program, *flags, **options)
    try:
        yield server
    finally:
        if server.process.poll() is None:
            server.process.kill()
            server.process.wait()


class Outcome:
    """How a call ended."""

    def __init__(self, code, details="", retry_info=False, messages=0, seconds=0.0):
        self.code, self.details, self.retry_info = code, details, retry_info
        self.messages, self.seconds = messages, seconds


def call(channel, path, request, timeout=60.0):
    """Makes a call with bytes, reads everything, and tells how it ended."""
    begin = time.monotonic()
    messages = 0
    stream = channel.unary_stream(path)(request, timeout=timeout)
    try:
        for _ in stream:
            messages += 1
        return Outcome("OK", messages=messages, seconds=time.monotonic() - begin)
    except grpc.RpcError as error:
        trailers = dict(error.trailing_metadata() or ())
        return Outcome(error.code().name, error.details(),
                       b"google.rpc.RetryInfo" in trailers.get("grpc-status-details-bin", b""),
                       messages, time.monotonic() - begin)


def sample_request(protos, frames, rate=15.0):
    """A person who stands, in the default model's joints."""
    motion, synthesis = protos
    joints = ("head neck torso left_shoulder left_elbow left_hand right_shoulder right_elbow "
              "right_hand left_hip left_knee left_foot right_hip right_knee right_foot").split()
    leader = motion.Motion(joint_names=joints, frame_rate_hz=rate, frame_count=frames,
                           unit=motion.LENGTH_UNIT_METRES, up_axis=motion.UP_AXIS_Y_UP)
    heights = {"head": 1.6, "neck": 1.4, "torso": 1.15, "shoulder": 1.38, "elbow": 1.1,
               "hand": 0.85, "hip": 0.92, "knee": 0.5, "foot": 0.08}
    one = []
    for joint in joints:
        side = 0.15 if joint.startswith("left") else -0.15 if joint.startswith("right") else 0.0
        one += [side, heights[joint.split("_")[-1]], 0.0]
    leader.positions.extend(one * frames)
    request = synthesis.SynthesizeRequest(leader=leader)
    request.label_vector.weights.add(interaction_class="punch", weight=1)
    return request.SerializeToString()


def load_protos(folder):
    subprocess.run(["protoc", f"-I{SOURCE / 'proto'}", f"--python_out={folder}",
                    "duet/v1/model.proto", "duet/v1/motion.proto", "duet/v1/synthesis.proto"],
                   check=True)
    sys.path.insert(0, folder)
    from duet.v1 import motion_pb2, synthesis_pb2  # pylint: disable=import-outside-toplevel
    return motion_pb2, synthesis_pb2


def together(count, work):
    """Runs `work(i)` on threads; what they gave."""
    results = [None] * count

    def run(i):
        results[i] = work(i)
    threads = [threading.Thread(target=run, args=(i,)) for i in range(count)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return results


def counted(outcomes):
    counts = {}
    for outcome in outcomes:
        key = outcome.code + (" with RetryInfo" if outcome.retry_info else "")
        counts[key] = counts.get(key, 0) + 1
    return ", ".join(f"{count} {code}" for code, count in sorted(counts.items()))


class Beside:
    """Makes a call again and again beside what is measured, from a process of its own."""

    def __init__(self, server, path, request=b"", pause=0.02):
        self.outcomes, self.request = [], request
        self.process = subprocess.Popen(
            [sys.executable, "-B", pathlib.Path(__file__).with_name("ask_beside.py"), server.address,
             path, str(pause)], stdin=subprocess.PIPE, stdout=subprocess.PIPE)

    def __enter__(self):
        self.process.stdin.write(b"%d\n" % len(self.request) + self.request)
        self.process.stdin.flush()
        self.process.stdout.readline()  # connected
        return self

    def __exit__(self, *_):
        out, _ = self.process.communicate()
        self.outcomes = [Outcome(code, seconds=seconds) for code, seconds in json.loads(out)]

    def slowest(self):
        return max(outcome.seconds for outcome in self.outcomes)


def memory(args, protos):
    bomb = b"\x22\x02\x12\x00" * int(31.9 * MIB / 4)
    with running(args.server) as server:
        say("memory", "resident when idle, MB", server.memory())
        for senders in (1, 2):
            server.forget_peak()
            with Beside(server, LIST_MODELS) as beside:
                channels = [server.channel() for _ in range(senders)]
                outcomes = together(senders, lambda i: call(channels[i], SYNTHESIZE, bomb))
                time.sleep(1)
            say("memory", f"{senders} x 31.9 MiB of tiny messages: answers", counted(outcomes))
            say("memory", f"{senders} x: peak, MB", server.memory("VmHWM"))
            say("memory", f"{senders} x: slowest ListModels beside, s", f"{beside.slowest():.3f}")
            time.sleep(9)
            say("memory", f"{senders} x: resident 10 s later, MB", server.memory())


def readers(args, protos):
    short = sample_request(protos, 46)
    with running(args.server) as server:
        connection = http2.Connection(server.port, source=HOSTILE, window=0)
        for _ in range(200):
            connection.open(SYNTHESIZE, short)
        drain = threading.Thread(target=lambda: list(connection.frames()), daemon=True)
        drain.start()
        time.sleep(3)
        say("readers", "places held by 200 that never read", server.in_flight())
        with Beside(server, SYNTHESIZE, short) as beside:
            time.sleep(10)
        good = [outcome.seconds for outcome in beside.outcomes if outcome.code == "OK"]
        say("readers", "short calls of another client meanwhile", counted(beside.outcomes))
        if good:
            say("readers", "their p50, ms", f"{1000 * statistics.median(good):.0f}")
        begin = time.monotonic()
        while server.in_flight() > 0 and time.monotonic() - begin < 60:
            time.sleep(0.5)
        say("readers", "places held a minute later", server.in_flight())
        connection.close()


def metrics(args, protos):
    with running(args.server) as server:
        sockets = [socket.create_connection(("127.0.0.1", server.metrics_port)) for _ in range(52)]
        over = threading.Event()

        def drip():
            for byte in b"GET /metrics HTTP/1.1\r\nX: " + b"x" * 4000:
                for slow in sockets[:2]:
                    with contextlib.suppress(OSError):
                        slow.send(bytes((byte,)))
                if over.wait(1):
                    return
        thread = threading.Thread(target=drip)
        thread.start()
        for path in ("/healthz", "/readyz", "/metrics"):
            answers = [server.get(path) for _ in range(4)]
            seconds = max(answer[2] for answer in answers)
            codes = sorted({str(answer[0]) for answer in answers})
            say("metrics", f"{path} beside 2 slow and 50 silent sockets: slowest of 4",
                f"{seconds:.3f} s ({', '.join(codes)})")
        over.set()
        thread.join()


def large(args, protos):
    request = sample_request(protos, 144000, rate=240.0)
    with running(args.server) as server:
        server.forget_peak()
        channels = [server.channel() for _ in range(40)]
        with Beside(server, LIST_MODELS) as beside:
            outcomes = together(40, lambda i: call(channels[i], SYNTHESIZE, request, timeout=280))
        say("large", f"40 calls of {len(request) / MIB:.1f} MiB at once", counted(outcomes))
        cut = [outcome for outcome in outcomes if outcome.messages > 0 and outcome.code != "OK"]
        say("large", "cut after replies had begun", len(cut))
        say("large", "peak, MB", server.memory("VmHWM"))
        say("large", "slowest ListModels beside, s", f"{beside.slowest():.3f}")


def deadlines(args, protos):
    best = None
    for deadline in (10, 1, 0.3, 0.15):
        with running(args.server) as server:
            run_load(args.build, server.address, "--callers", 8, "--seconds", 2)  # its costs are known
            seen = run_load(args.build, server.address, "--rate", 400, "--max-in-flight", 256,
                            "--deadline", deadline, "--warm-up", 2, "--seconds", 8)
            good = seen["clips_per_second"]
            best = best or good
            say("deadlines", f"400 calls/s, deadline {deadline} s: clips/s in time",
                f"{good:.0f} ({100 * good / best:.0f} %), {seen['failed']}")


def long_clips(args, protos):
    with running(args.server) as server:
        idle = run_load(args.build, server.address, "--callers", 1, "--seconds", 5)
        beside = run_load(args.build, server.address, "--callers", 1, "--seconds", 5,
                          "--background-callers", 66, "--background-frames", 9000, "--warm-up", 5)
        say("long_clips", "a short call on an idle server: p50, ms", f"{idle['p50_ms']:.1f}")
        say("long_clips", "beside 66 of ten minutes: p50, ms, refused",
            f"{beside['p50_ms']:.1f} ({beside['p50_ms'] / idle['p50_ms']:.1f} x), "
            f"{beside['failed']}")


def restarts(args, protos):
    port = free_port()
    leader = SOURCE / "samples/punch.bvh"
    over, failed, runs = threading.Event(), [], [0]

    def ask(i):
        with tempfile.TemporaryDirectory() as folder:
            while not over.is_set():
                done = subprocess.run(
                    [args.client, "synthesize", "--leader", leader, "--label", "punch=1", "--out",
                     f"{folder}/{i}-{runs[0]}.bvh", "--server", f"127.0.0.1:{port}", "--wait",
                     "120"], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                    check=False, text=True)
                runs[0] += 1
                if done.returncode != 0:
                    failed.append(done.stderr.strip())
    server = Server(args.server, port=port)
    callers = [threading.Thread(target=ask, args=(i,)) for i in range(4)]
    for caller in callers:
        caller.start()
    for i in range(6):
        time.sleep(3)
        server.stop(signal.SIGTERM if i % 2 == 0 else signal.SIGKILL)
        time.sleep(2)
        server = Server(args.server, port=port)
    time.sleep(3)
    over.set()
    for caller in callers:
        caller.join()
    server.stop()
    say("restarts", "runs of duet over six restarts, failed", f"{runs[0]}, {len(failed)}")
    for text in sorted(set(failed))[:5]:
        say("restarts", "a failure", text.splitlines()[-1] if text else "")


def descriptors(args, protos):
    flags = ["--self-check-seconds", "1"] if "--self-check-seconds" in subprocess.run(
        [args.server, "--help"], stdout=subprocess.PIPE, check=True, text=True).stdout else []
    with running(args.server, *flags, descriptors=64) as server:
        sockets = []
        with contextlib.suppress(OSError):
            for _ in range(80):
                sockets.append(socket.create_connection(("127.0.0.1", server.port), 1))
        time.sleep(1)
        for held in sockets:
            held.close()
        time.sleep(1)
        outcome = call(server.channel(), LIST_MODELS, b"", timeout=2)
        say("descriptors", "a call after 80 connections on 64 descriptors", outcome.code)
        begin = time.monotonic()
        while server.get("/healthz")[0] == 200 and time.monotonic() - begin < 40:
            time.sleep(0.5)
        say("descriptors", "/healthz, then, after s",
            f"{server.get('/healthz')[0]}, {time.monotonic() - begin:.0f}")


def details(args, protos):
    short = sample_request(protos, 46)
    with running(args.server) as server:
        connection = http2.Connection(server.port)
        connection.open(SYNTHESIZE)
        time.sleep(0.3)
        connection.close()
        time.sleep(0.5)
        codes = re.findall(r'"method":"Synthesize".*?"code":"(\w+)"', server.text())
        say("details", "a call cancelled before its message counts as", codes or "nothing")
        connection = http2.Connection(server.port)
        connection.open(SYNTHESIZE, short, extra=[("grpc-timeout", "99999999H")])
        ended = b""
        for kind, flags, _, payload in connection.frames():
            ended += payload if kind == http2.HEADERS else b""
            if kind == http2.HEADERS and flags & http2.END_STREAM:
                break
        time.sleep(0.2)
        codes = re.findall(r'"method":"Synthesize".*?"code":"(\w+)"', server.text())
        say("details", "grpc-timeout: 99999999H", codes[-1])
        outcome = call(server.channel(), SYNTHESIZE, bytes(65 * MIB))
        say("details", "a request of 65 MiB", f"{outcome.code}: {outcome.details}")


SCENARIOS = (memory, readers, metrics, large, deadlines, long_clips, restarts, descriptors, details)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("scenarios", nargs="*", metavar="SCENARIO",
                        help=", ".join(scenario.__name__ for scenario in SCENARIOS))
    parser.add_argument("--server", type=pathlib.Path)
    parser.add_argument("--client", type=pathlib.Path)
    args = parser.parse_args()
    args.server = args.server or args.build / "bin/duet-server"
    args.client = args.client or args.build / "bin/duet"
    with tempfile.TemporaryDirectory() as folder:
        protos = load_protos(folder)
        for scenario in SCENARIOS:
            if not args.scenarios or scenario.__name__ in args.scenarios:
                scenario(args, protos)


if __name__ == "__main__":
    main()
