#!/usr/bin/env python3
"""Soak test: every kind of caller against a server while an operator changes everything that can be
changed. Checks calls, memory, descriptors and threads.

    tests/e2e/soak/soak.py BUILD [--seconds 1200] [--rounds 20] [--callers 6] [--out FOLDER]

Callers request short and long clips, cancel, set tight deadlines, send invalid requests, disconnect. Meanwhile models are reloaded (SIGHUP and `duet admin`),
loaded, unloaded and rejected, labels move, certificates and tokens are rotated. The server has TLS,
an access file and a repository of its own.

After each round all callers pause. One large request makes the server return its free memory, and
resident memory is read when no call is left. Growth is the median of the last quarter of the rounds
over that of the first quarter after the warm-up (the first fifth).

Exits with 1 if a call was lost (it ended without a status, or with part of its answer), ended in a
way that its kind may not, or was begun and never finished by the server's own count; if an action
failed, memory grew by more than --max-growth, descriptors are left over, or the server did not exit
cleanly. Prints the figures as JSON; keeps them and the server's log in FOLDER. Needs python3-grpcio,
protobuf-compiler and openssl.
"""

import argparse
import contextlib
import json
import pathlib
import shutil
import statistics
import sys
import tempfile
import time

import grpc

import soak_requests
from soak_callers import LONG_DEADLINE, Callers
from soak_operator import Operator
from soak_server import Server


def settle(server, callers):
    """Waits until no call is left and the server has returned its free memory."""
    with server.channel() as channel:
        stream = channel.unary_stream(soak_requests.SYNTHESIZE)(
            soak_requests.sample_request(callers.protos, 36000, rate=240.0), timeout=LONG_DEADLINE,
            metadata=(("authorization", f"Bearer {server.tokens['load']}"),))
        with contextlib.suppress(grpc.RpcError):
            next(stream)
        stream.cancel()
    end = time.monotonic() + LONG_DEADLINE
    while server.in_flight() > 0 and time.monotonic() < end:
        time.sleep(0.05)
    time.sleep(3)  # the server trims its heap once a second, twice after large requests


def play(args, server, callers, operator):
    """Plays all rounds. Returns after each: resident memory, descriptors, threads."""
    settled = []
    for number in range(args.rounds):
        callers.gate.set(True)
        operator.begin()
        time.sleep(args.seconds / args.rounds)
        operator.pause()
        callers.gate.set(False)
        settle(server, callers)
        settled.append((server.resident(), server.descriptors(), server.status("Threads")))
        print(f"round {number + 1} of {args.rounds}: {settled[-1][0] / 1e6:.1f} MB, "
              f"{sum(callers.ended.values())} calls, {len(callers.lost)} lost", file=sys.stderr,
              flush=True)
    return settled


def growth_of(settled):
    """Relative growth of resident memory after the warm-up."""
    values = [resident for resident, *_ in settled]
    rest = values[len(values) // 5:]
    quarter = max(1, len(rest) // 4)
    return statistics.median(rest[-quarter:]) / statistics.median(rest[:quarter]) - 1


def soak(args, folder, protos):
    server = Server(args.server, folder)
    try:
        callers = Callers(server, protos, args.callers, args.seed)
        operator = Operator(server, callers, args.build / "bin/duet", args.seed)
        try:
            settled = play(args, server, callers, operator)
        finally:
            callers.end()
        metrics = server.metrics()
    finally:
        exit_code = server.stop()

    def total(family):
        return sum(value for name, value in metrics.items() if name.startswith(family + "{"))
    figures = {
        "calls": sum(callers.ended.values()),
        "lost": len(callers.lost),
        "unexpected": sum(callers.unexpected.values()),
        "unfinished": int(total("grpc_server_started_total") - total("grpc_server_handled_total")),
        "failed_actions": len(operator.failed),
        "growth": growth_of(settled),
        "descriptors_left": settled[-1][1] - settled[0][1],
        "exit_code": exit_code,
        "ended": {f"{kind}: {code}": count for (kind, code), count in sorted(callers.ended.items())},
        "actions": dict(sorted(operator.done.items())),
        "settled": settled,
    }
    print(json.dumps(figures, indent=1))
    for line in callers.lost[:10] + operator.failed[:10]:
        print(line, file=sys.stderr)
    for (kind, code), count in callers.unexpected.items():
        print(f"{kind}: {count} {code}", file=sys.stderr)
    if args.out:
        args.out.mkdir(parents=True, exist_ok=True)
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
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--max-growth", type=float, default=0.02)
    parser.add_argument("--server", type=pathlib.Path)
    parser.add_argument("--out", type=pathlib.Path)
    args = parser.parse_args()
    args.server = args.server or args.build / "bin/duet-server"
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "protos").mkdir()
        figures = soak(args, folder, soak_requests.load_protos(str(folder / "protos")))
    sys.exit(0 if passes(figures, args.max_growth) else 1)


if __name__ == "__main__":
    main()
