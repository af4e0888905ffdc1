#!/usr/bin/env python3
"""Takes the leader of a live session from motion capture, and sends the follower to a game engine or Blender.

    duet_capture.py --from vmc://:39539 --to vmc://192.168.1.20:39539 --label hug=1

README.md describes the set-up. While it runs, weights can be typed: `kick=1 hug=0 ease=0.3`, then Enter.
Ctrl-C ends the leader's motion.
"""

import argparse
import asyncio
import re
import signal
import socket
import sys
import time
from typing import Dict, List, Optional, Tuple

import duet_motion as duet

from body import BodyMap
from clock import CaptureStream, TimedFrame
from rokoko import RokokoReader
from vmc import VmcReader, VmcWriter
from xsens import XsensReader

PROTOCOLS = {"vmc": (VmcReader, 39539), "xsens": (XsensReader, 9763), "rokoko": (RokokoReader, 14043)}


def parse_address(text: str) -> Tuple[str, str, int]:
    """The protocol, host (empty: not stated) and port of "vmc://[HOST][:PORT]", "xsens://..." or
    "rokoko://..."."""
    found = re.fullmatch(r"(vmc|xsens|rokoko)://(\[[^\]]*\]|[^:\[\]]*)(?::(\d{1,5}))?", text)
    if not found or int(found[3] or 0) > 65535:
        raise argparse.ArgumentTypeError(
            "expected vmc://, xsens:// or rokoko://[HOST][:PORT], with an IPv6 address in brackets, got "
            f"{text!r}")
    return found[1], found[2].strip("[]"), int(found[3]) if found[3] else PROTOCOLS[found[1]][1]


def parse_target(text: str) -> Tuple[str, int]:
    protocol, host, port = parse_address(text)
    if protocol != "vmc" or not host:
        raise argparse.ArgumentTypeError(f"expected vmc://HOST[:PORT], got {text!r}")
    return host, port


def parse_label(text: str) -> Tuple[str, float]:
    name, equals, weight = text.partition("=")
    return name, float(weight) if equals else 1.0


class Receiver(asyncio.DatagramProtocol):
    """Hands datagrams to a stream, and wakes who waits for them."""

    def __init__(self, stream: CaptureStream) -> None:
        self._stream = stream
        self.arrived = asyncio.Event()

    def datagram_received(self, data: bytes, addr: Tuple) -> None:
        self._stream.receive(data, addr, time.monotonic())
        self.arrived.set()


class Bridge:
    """One session: frames from the stream to the server, and the follower's to the targets."""

    def __init__(self, options: argparse.Namespace, stream: CaptureStream, receiver: Receiver) -> None:
        self._options, self._stream, self._receiver = options, stream, receiver
        self.stopped = asyncio.Event()

    async def next_frame(self) -> Optional[TimedFrame]:
        """Waits for the next frame of the output; None if the session was stopped."""
        while not self.stopped.is_set():
            frame = self._stream.next(time.monotonic())
            for note in self._stream.notes:
                print(note, file=sys.stderr)
            self._stream.notes.clear()
            if frame is not None:
                return frame
            self._receiver.arrived.clear()
            wait = min(self._stream.next_due() - time.monotonic(), 0.1)  # looks for Ctrl-C that often
            try:
                await asyncio.wait_for(self._receiver.arrived.wait(), max(wait, 0.0005))
            except asyncio.TimeoutError:
                pass
        return None

    async def run(self) -> None:
        first = await self.next_frame()
        if first is None:
            raise SystemExit(f"interrupted before the first frame: {self._stream.summary()}")
        options = self._options
        async with duet.aio.Client(options.server) as client:
            joints = (await client.get_model(options.model)).model.joint_names
            body = BodyMap(self._stream.joint_names, joints, first.positions, dict(options.joint))
            targets = [(socket.getaddrinfo(host, port, type=socket.SOCK_DGRAM)[0]) for host, port in options.to]
            async with client.live(joints, self._stream.rate_hz, dict(options.label), model=options.model,
                                   delay=options.delay, seed=options.seed, variety=options.variety,
                                   rotations=True, on_notice=print_notice) as session:
                self._read_typed_labels(session)
                feeding = asyncio.create_task(self._feed(session, body, first))
                count, latencies = await self._answer(session, VmcWriter(joints), targets)
                await feeding
        median = sorted(latencies)[len(latencies) // 2] if latencies else 0
        print(f"leader: {self._stream.summary()}\nfollower: {count} frames, half of them within "
              f"{1e3 * median:.0f} ms of the capture")

    async def _feed(self, session: duet.aio.LiveSession, body: BodyMap, first: TimedFrame) -> None:
        try:
            frame: Optional[TimedFrame] = first
            while frame is not None:
                await session.send(body.apply(frame.positions), capture_seconds=frame.capture_seconds)
                frame = await self.next_frame()
            await session.finish()
        except duet.DuetError:
            pass  # the session's iterator raises it too

    async def _answer(self, session: duet.aio.LiveSession, writer: VmcWriter,
                      targets: List) -> Tuple[int, List[float]]:
        count, latencies = 0, []
        sockets = [(socket.socket(family, kind), where) for family, kind, _, _, where in targets]
        async for part in session:
            latencies.append(part.latency)
            for positions, rotations in zip(part.positions, part.rotations.rotations):
                datagrams = writer.write(part.rotations.rig, rotations, positions,
                                         count / self._stream.rate_hz)
                count += 1
                for sender, where in sockets:
                    for datagram in datagrams:
                        sender.sendto(datagram, where)
        return count, latencies

    def _read_typed_labels(self, session: duet.aio.LiveSession) -> None:
        if not sys.stdin or not sys.stdin.isatty():
            return

        def read() -> None:
            asyncio.ensure_future(change_labels(session, sys.stdin.readline()))

        asyncio.get_running_loop().add_reader(sys.stdin, read)


async def change_labels(session: duet.aio.LiveSession, line: str) -> None:
    """Applies a line such as "kick=1 hug=0 ease=0.3"."""
    try:
        labels: Dict[str, float] = dict(parse_label(word) for word in line.split())
        ease = labels.pop("ease", 0.0)
        if labels:
            frame = await session.change_labels(labels, ease_seconds=ease)
            print(f"from frame {frame}: {labels}", file=sys.stderr)
    except (ValueError, duet.DuetError) as error:
        print(error, file=sys.stderr)


def print_notice(notice: duet.LiveNotice) -> None:
    frames = notice.frames
    where = "" if frames is None else f": {frames.frame_count} frames from {frames.first_frame} on"
    print(f"server: {notice.kind}{where}", file=sys.stderr)


async def run(options: argparse.Namespace) -> None:
    protocol, host, port = options.source
    stream = CaptureStream(PROTOCOLS[protocol][0], options.frame_rate)
    loop = asyncio.get_running_loop()
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    transport, receiver = await loop.create_datagram_endpoint(
        lambda: Receiver(stream), local_addr=(host or "0.0.0.0", port), family=family)
    try:
        bridge = Bridge(options, stream, receiver)
        for number in (signal.SIGINT, signal.SIGTERM):
            loop.add_signal_handler(number, bridge.stopped.set)
        print(f"waiting for frames at {protocol}://{host}:{transport.get_extra_info('sockname')[1]}",
              file=sys.stderr, flush=True)
        await bridge.run()
    finally:
        transport.close()


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--from", dest="source", required=True, type=parse_address, metavar="ADDRESS",
                        help="vmc://, xsens:// or rokoko://[HOST][:PORT]: where frames are received")
    parser.add_argument("--to", required=True, action="append", type=parse_target, metavar="ADDRESS",
                        help="vmc://HOST[:PORT]: where the follower is sent; repeatable")
    parser.add_argument("--label", required=True, action="append", type=parse_label, metavar="CLASS[=WEIGHT]",
                        help="weight of an interaction class from the first frame on; repeatable")
    parser.add_argument("--server", help="host:port (default: DUET_SERVER, or localhost:50051)")
    parser.add_argument("--model", default="", help="default: the server's")
    parser.add_argument("--frame-rate", type=float, default=0, metavar="HZ",
                        help="of the leader (default: the sender's, measured for a second)")
    parser.add_argument("--delay", type=int, default=0, metavar="FRAMES",
                        help="leader frames that the server waits for before it answers, 0 to 10")
    parser.add_argument("--seed", type=int, help="selects an answer of a model that samples (default: a typical one)")
    parser.add_argument("--variety", type=float, default=1.0, metavar="0..2",
                        help="0 typical, 1 as varied as people, at most 2")
    parser.add_argument("--joint", action="append", default=[], metavar="MODEL=CAPTURE",
                        type=lambda text: tuple(text.split("=", 1)),
                        help="uses a joint of the capture for a joint of the model; repeatable")
    options = parser.parse_args()
    try:
        asyncio.run(run(options))
    except (OSError, ValueError, duet.DuetError) as error:
        sys.exit(f"duet_capture: {error}")


if __name__ == "__main__":
    main()
