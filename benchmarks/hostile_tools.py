"""A server and calls for benchmarks that play hostile or changing clients."""

import contextlib
import http.client
import json
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import threading
import time

import grpc

SOURCE = pathlib.Path(__file__).resolve().parent.parent

SYNTHESIZE = "/duet.v1.MotionSynthesis/Synthesize"
LIST_MODELS = "/duet.v1.MotionSynthesis/ListModels"
MIB = 1 << 20


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
    """Makes a call with bytes, reads every message, and returns how it ended."""
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
    """A serialized request for a standing leader with the default model's joints."""
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
                    "duet/v1/model.proto", "duet/v1/motion.proto", "duet/v1/reaction.proto",
                    "duet/v1/live.proto", "duet/v1/synthesis.proto"],
                   check=True)
    sys.path.insert(0, folder)
    from duet.v1 import motion_pb2, synthesis_pb2  # pylint: disable=import-outside-toplevel
    return motion_pb2, synthesis_pb2


def together(count, work):
    """Runs `work(i)` on `count` threads and returns the results."""
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
    """Repeats a call from a separate process while something else is measured."""

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
