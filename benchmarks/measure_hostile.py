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

from hostile_tools import (LIST_MODELS, MIB, SOURCE, SYNTHESIZE, Beside, Server, call, counted,
                           load_protos, running, sample_request, together)
from load_tool import run_load

sys.path.insert(0, str(SOURCE / "tests/e2e"))
import http2_client as http2  # noqa: E402
from free_ports import free_port  # noqa: E402

HOSTILE = "127.0.0.2"


def say(scenario, figure, value):
    print(f"| {scenario} | {figure} | {value} |", flush=True)


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
