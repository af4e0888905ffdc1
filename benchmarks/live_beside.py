#!/usr/bin/env python3
"""Holds live sessions in real time until its standard input ends. A separate process, so that the measured callers
do not share an interpreter with it.

    benchmarks/live_beside.py ADDRESS CLIENT_KEY SESSIONS CANDIDATES

Prints a line when every session was answered.
"""

import os
import pathlib
import sys
import threading
import time

SOURCE = pathlib.Path(__file__).resolve().parent.parent
os.environ.setdefault("DUET_SOURCE_DIR", str(SOURCE))
sys.path.insert(0, str(SOURCE / "tests/e2e"))

import live_clients as live  # noqa: E402  pylint: disable=wrong-import-position

RATE = 30


def send(session, over, start):
    leader = live.person(live.SBU_JOINTS, RATE, 10 * RATE)
    frame = 0
    while not over.wait(max(0, start + frame / RATE - time.monotonic())):
        session.send(live.frames_message(frame, [leader[frame % len(leader)]]))
        frame += 1
    session.finish()


def read(session, answered):
    while session.read():
        if session.frames:
            answered.set()
        if len(session.frames) > RATE:
            session.frames = {max(session.frames): []}
            session.parts.clear()
            session.notices.clear()


def main():
    address, client_key, count, candidates = *sys.argv[1:3], int(sys.argv[3]), int(sys.argv[4])
    over, answered = threading.Event(), [threading.Event() for _ in range(count)]
    with live.grpc.insecure_channel(address) as channel:
        threads = []
        for i in range(count):
            session = live.Session(channel, live.start_message(candidates=candidates),
                                   metadata=((client_key, "beside"),), timeout=None)
            start = time.monotonic() + i / RATE / count  # not all at the same instant
            threads += [threading.Thread(target=send, args=(session, over, start)),
                        threading.Thread(target=read, args=(session, answered[i]))]
        for thread in threads:
            thread.start()
        for event in answered:
            event.wait()
        print("answered", flush=True)
        sys.stdin.read()
        over.set()
        for thread in threads:
            thread.join()


if __name__ == "__main__":
    main()
