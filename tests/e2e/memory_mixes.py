"""Mixes of legal calls that use as much of a server's memory as they can, and control groups to hold
the server to a limit. tests/e2e/memory_limit_test.py uses both."""

import array
import contextlib
import os
import pathlib
import re
import subprocess
import threading
import time
import uuid

import grpc
import http2_client as http2

SYNTHESIZE = "/duet.v1.MotionSynthesis/Synthesize"
MIB = 1 << 20
JOINTS = ("head neck torso left_shoulder left_elbow left_hand right_shoulder right_elbow right_hand "
          "left_hip left_knee left_foot right_hip right_knee right_foot").split()
HEIGHTS = {"head": 1.6, "neck": 1.4, "torso": 1.15, "shoulder": 1.38, "elbow": 1.1, "hand": 0.85,
           "hip": 0.92, "knee": 0.5, "foot": 0.08}


def varint(number):
    """A number as protobuf writes it."""
    data = bytearray()
    while number > 127:
        data.append(number & 127 | 128)
        number >>= 7
    return bytes(data + bytes((number,)))


def field(number, payload):
    """A length-delimited field."""
    return varint(number << 3 | 2) + varint(len(payload)) + payload


def request(frames, rate=15, chunk_frames=30, keyframes=0):
    """SynthesizeRequest: a person who stands, in the default model's joints. Encoded by hand, because
    generated Python code takes seconds for the longest leaders."""
    pose = []
    for joint in JOINTS:
        side = 0.15 if joint.startswith("left") else -0.15 if joint.startswith("right") else 0.0
        pose += [side, HEIGHTS[joint.split("_")[-1]], 0.0]
    leader = b"".join(field(1, joint.encode()) for joint in JOINTS)
    leader += b"\x11" + array.array("d", [rate]).tobytes()  # frame_rate_hz
    leader += b"\x18\x01\x20\x01\x28" + varint(frames)  # metres, y up, frame_count
    leader += field(6, array.array("f", pose).tobytes() * frames)
    weight = field(1, field(1, b"punch") + b"\x15" + array.array("f", [1.0]).tobytes())
    labels = b"".join(field(4, b"\x08" + varint(i) + field(2, weight)) for i in range(keyframes))
    return field(2, leader) + (labels or field(3, weight)) + b"\x30" + varint(chunk_frames)


class Cgroup:
    """A control group with a memory limit, below this process's own or beside it."""

    def __init__(self, folder, files):
        self.folder, self.limit_file, self.peak_file, self.kills_file = folder, *files

    @staticmethod
    def create(limit):
        """A new group, or the reason why there is none."""
        lines = pathlib.Path("/proc/self/cgroup").read_text(encoding="utf-8").splitlines()
        paths = {line.split(":")[1]: line.split(":", 2)[2].lstrip("/") for line in lines}
        top = pathlib.Path("/sys/fs/cgroup")
        version_1 = ("memory.limit_in_bytes", "memory.max_usage_in_bytes", "memory.oom_control")
        version_2 = ("memory.max", "memory.peak", "memory.events")
        tried = [(top / "memory" / paths.get("memory", ""), version_1),
                 (top / "memory", version_1)]
        own = top / paths.get("", "")
        tried += [(parent, version_2) for parent in (own, *own.parents) if top in (parent, *parent.parents)]
        why = "no memory controller"
        for parent, files in tried:
            folder = parent / f"duet-test-{uuid.uuid4().hex[:12]}"
            try:
                folder.mkdir()
            except OSError as error:
                why = str(error)
                continue
            group = Cgroup(folder, [folder / name for name in files])
            try:
                group.limit_file.write_text(str(limit), encoding="utf-8")
                probe = subprocess.run(group.command(["true"]), check=False, capture_output=True)
                if probe.returncode == 0:
                    return group, ""
                why = probe.stderr.decode()
            except OSError as error:
                why = str(error)
            folder.rmdir()
        return None, why

    def command(self, words):
        """The command that runs another within the group."""
        return ["sh", "-c", f'echo $$ >{self.folder}/cgroup.procs && exec "$@"', "sh", *map(str, words)]

    def peak(self):
        """The most bytes that the group has held, its page cache included."""
        return int(self.peak_file.read_text(encoding="utf-8"))

    def kills(self):
        """How many processes the kernel has killed for want of memory."""
        text = self.kills_file.read_text(encoding="utf-8")
        return int(re.search(r"oom_kill (\d+)", text)[1])

    def remove(self):
        """Removes the group, whose processes have ended."""
        for _ in range(100):
            with contextlib.suppress(OSError):
                self.folder.rmdir()
                return
            time.sleep(0.05)  # the kernel takes a moment to forget a process


def resident_peak(pid):
    """The most bytes that a process has had resident."""
    status = pathlib.Path(f"/proc/{pid}/status").read_text(encoding="utf-8")
    return int(re.search(r"VmHWM:\s+(\d+)", status)[1]) * 1024


def channel(port):
    """A connection of its own."""
    return grpc.insecure_channel(f"127.0.0.1:{port}", options=[
        ("grpc.use_local_subchannel_pool", 1), ("grpc.max_send_message_length", -1),
        ("grpc.max_receive_message_length", -1)])


class Tally:
    """What became of the attempts of a mix."""

    def __init__(self):
        self._lock = threading.Lock()
        self.codes = {}
        self.unexplained = []  # refusals without a time to come back

    def add(self, code, details="", explained=True):
        with self._lock:
            self.codes[code] = self.codes.get(code, 0) + 1
            if not explained:
                self.unexplained.append(f"{code}: {details}")

    def __str__(self):
        return ", ".join(f"{count} {code}" for code, count in sorted(self.codes.items()))


def ask(stub, payload, tally, timeout):
    """One attempt, read to its end. True unless it may be made again."""
    try:
        for _ in stub(payload, timeout=timeout):
            pass
    except grpc.RpcError as error:
        trailers = dict(error.trailing_metadata() or ())
        retry = b"google.rpc.RetryInfo" in trailers.get("grpc-status-details-bin", b"")
        code = error.code().name
        tally.add(code, error.details(), retry)
        return code not in ("RESOURCE_EXHAUSTED", "UNAVAILABLE")
    tally.add("OK")
    return True


def until_answered(port, payload, callers, seconds, each=1, alive=lambda: True):
    """`callers` connections that make `each` calls, all at once, and repeat those that are refused
    while the server is alive."""
    tally = Tally()
    end = time.monotonic() + seconds

    def run():
        with channel(port) as connection:
            stub = connection.unary_stream(SYNTHESIZE)
            for _ in range(each):
                while not ask(stub, payload, tally, seconds) and alive() and time.monotonic() < end:
                    time.sleep(1)  # what RetryInfo says
    threads = [threading.Thread(target=run) for _ in range(callers)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return tally


class StalledReaders:
    """Connections whose calls are never read: every call stops at what its window takes."""

    def __init__(self, port, payload, connections, calls):
        self.connections = []
        for _ in range(connections):
            connection = http2.Connection(port, window=0)
            self.connections.append(connection)
            threading.Thread(target=self._drain, args=(connection, payload, calls),
                             daemon=True).start()

    @staticmethod
    def _drain(connection, payload, calls):
        with contextlib.suppress(OSError, StopIteration):
            for _ in range(calls):
                connection.open(SYNTHESIZE, payload)
            for _ in connection.frames():
                pass

    def close(self):
        for connection in self.connections:
            connection.close()


class SlowUploads:
    """Connections that send all of a request except its last byte, and go on holding it."""

    def __init__(self, port, size, connections):
        self.sockets = []
        for _ in range(connections):
            connection = http2.Connection(port)
            self.sockets.append(connection.socket)
            threading.Thread(target=self._send, args=(connection, size), daemon=True).start()

    @staticmethod
    def _send(connection, size):
        with contextlib.suppress(OSError, StopIteration):
            stream = connection.open(SYNTHESIZE)
            left, credit, first = size - 1, 65535, True
            frames = connection.frames()
            while left > 0:
                room = min(16384 - 5 * first, left, connection.credit - 5, credit - 5)
                if room <= 0:
                    kind, flags, number, payload = next(frames)
                    if number == stream and kind == http2.WINDOW_UPDATE:
                        credit += int.from_bytes(payload, "big")
                    if number == stream and kind == http2.HEADERS and flags & http2.END_STREAM:
                        return
                    if kind == http2.SETTINGS and not flags & http2.ACK:
                        credit += initial_window(payload)
                    continue
                head = b"\x00" + size.to_bytes(4, "big") if first else b""
                connection.socket.sendall(
                    http2.frame(http2.DATA, 0, stream, head + bytes(room)))
                left, first = left - room, False
                connection.credit -= room + len(head)
                credit -= room + len(head)
            for _ in frames:
                pass

    def close(self):
        for held in self.sockets:
            held.close()


def initial_window(settings):
    """How much more than 65535 bytes a stream may begin with."""
    for at in range(0, len(settings), 6):
        if int.from_bytes(settings[at:at + 2], "big") == http2.SETTING_INITIAL_WINDOW:
            return int.from_bytes(settings[at + 2:at + 6], "big") - 65535
    return 0
