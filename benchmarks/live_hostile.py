"""Live sessions of callers that mean no good, for as long as a benchmark wants."""

import itertools
import random
import threading

import live_clients as live
from live_clients import frames_message, grpc, label_message, live_pb2, start_message

RATE = 30
BATCH = 60  # leader frames in a hostile message
METHOD = "/duet.v1.MotionSynthesis/SynthesizeLive"
# A start of 2 MiB, of keyframes that each take four bytes and hundreds when parsed.
BOMB = b"\x0a\x80\x80\x80\x01" + b"\x22\x02\x12\x00" * (1 << 19)


class HostileCallers:
    """Threads that open hostile sessions of every kind until they are stopped; they all name themselves
    `client` in the metadata `client_key`."""

    def __init__(self, address, client_key, client="hostile", seed=0):
        self.address, self.metadata = address, ((client_key, client),)
        self.leader = live.person(live.SBU_JOINTS, RATE, BATCH)
        self.ends = {}  # (kind, status code) -> sessions
        self._seed = seed
        self._lock, self._stopped = threading.Lock(), threading.Event()
        kinds = (self.never_send, self.never_read, self.end_at_once, self.tiny_messages,
                 self.impossible, self.large_starts, self.no_messages, self.disconnect)
        self._threads = [threading.Thread(target=self._run, args=(kind, number), daemon=True)
                         for number, kind in enumerate(kinds)]

    def __enter__(self):
        for thread in self._threads:
            thread.start()
        return self

    def __exit__(self, *_):
        self._stopped.set()
        for thread in self._threads:
            thread.join()

    def _run(self, kind, number):
        rng = random.Random(1000 * self._seed + number)
        while not self._stopped.is_set():
            with grpc.insecure_channel(
                    self.address, options=(("grpc.use_local_subchannel_pool", 1),)) as channel:
                for code in kind(channel, rng):
                    with self._lock:
                        key = (kind.__name__, code)
                        self.ends[key] = self.ends.get(key, 0) + 1

    def _open(self, channel, start=None, **options):
        return live.Session(channel, start or start_message(), metadata=self.metadata, **options)

    def never_send(self, channel, rng):
        """Twenty sessions that wait for seconds, then are cancelled."""
        sessions = [self._open(channel) for _ in range(20)]
        self._stopped.wait(rng.uniform(1, 5))
        for session in sessions:
            session.call.cancel()
            session.finish()
            yield session.error()[0]

    def never_read(self, channel, rng):
        """Four sessions that send minutes of frames and take nothing."""
        sessions = [self._open(channel, start_message(plan_frames=30)) for _ in range(4)]
        for session in sessions:
            for first in range(0, 100 * BATCH, BATCH):
                session.send(frames_message(first, self.leader))
        self._stopped.wait(rng.uniform(2, 8))
        for session in sessions:
            session.call.cancel()
            yield session.call.code().name

    def end_at_once(self, channel, _):
        for _ in range(50):
            session = self._open(channel)
            session.finish()
            yield session.error()[0]

    def tiny_messages(self, channel, _):
        """Late frames, of which each asks for a notice, and label changes."""
        session = self._open(channel)
        for frame in range(2):
            session.send(frames_message(frame, self.leader[:1]))
        late, change = frames_message(0, self.leader[:1]), label_message("kick")
        for _ in range(5000):
            session.send(late)
            session.send(change)
        session.finish()
        yield session.error()[0]

    def impossible(self, channel, rng):
        """Indices, counts, times, values and orders that no caller should send."""
        nan = float("nan")
        frame = self.leader[:1]
        wrong_count = frames_message(0, frame)
        wrong_count.frames.frame_count = 2**32 - 1
        messages = [frames_message(2**32 - 1, frame), frames_message(10**6, frame), wrong_count,
                    frames_message(0, [[nan] * 45], nan), start_message(),
                    live_pb2.SynthesizeLiveRequest(), label_message("tango"),
                    label_message("kick", frame=2**32 - 1),
                    label_message("kick", ease_frames=2**32 - 1)]
        for first, then in itertools.product((None, *messages), messages):
            if self._stopped.is_set():
                return
            session = self._open(channel, first)
            session.send(then)
            session.finish()
            yield session.error()[0]
        self._stopped.wait(rng.uniform(0, 0.5))

    def large_starts(self, channel, rng):
        """Histories of up to 32 MiB, most of them too long."""
        for frames in (300, 3000, 23000, 170000):
            start = start_message()
            start.start.leader.frame_count = frames
            start.start.leader.positions.extend(self.leader[0] * frames)
            yield self._send_bytes(channel, start.SerializeToString())
        self._stopped.wait(rng.uniform(0, 0.5))

    def no_messages(self, channel, rng):
        """Bytes that no protobuf is, and one that grows a hundredfold."""
        yield self._send_bytes(channel, b"")
        yield self._send_bytes(channel, rng.randbytes(rng.randrange(1, 100_000)))
        yield self._send_bytes(channel, BOMB)
        self._stopped.wait(rng.uniform(0, 0.5))

    def disconnect(self, channel, rng):
        """Ten sessions on a connection that is closed while they are answered."""
        sessions = [self._open(channel) for _ in range(10)]
        for session in sessions:
            for first in range(0, 20 * BATCH, BATCH):
                session.send(frames_message(first, self.leader))
        self._stopped.wait(rng.uniform(0, 1))
        channel.close()
        for session in sessions:
            session.finish()
            yield session.call.code().name

    def _send_bytes(self, channel, *messages):
        call = channel.stream_stream(METHOD)(iter(messages), metadata=self.metadata, timeout=60)
        try:
            for _ in call:
                pass
            return "OK"
        except grpc.RpcError as failure:
            return failure.code().name
