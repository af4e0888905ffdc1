#!/usr/bin/env python3
"""Repeats one call until its standard input ends and prints the result of each. A separate process,
so that the measured callers do not share an interpreter with it.

    benchmarks/ask_beside.py ADDRESS METHOD PAUSE < REQUEST

Standard input: the request's length in bytes and a line end, the request, then nothing until the end.
Prints a line when it is connected, then, at the end, JSON: [[status, seconds], ...].
"""

import json
import sys
import threading
import time

import grpc


def main():
    address, method, pause = sys.argv[1], sys.argv[2], float(sys.argv[3])
    stdin = sys.stdin.buffer
    request = stdin.read(int(stdin.readline()))
    outcomes, over = [], threading.Event()
    with grpc.insecure_channel(address) as channel:
        grpc.channel_ready_future(channel).result(timeout=60)
        print("connected", flush=True)
        threading.Thread(target=lambda: (stdin.read(), over.set())).start()
        while not over.is_set():
            begin = time.monotonic()
            try:
                for _ in channel.unary_stream(method)(request, timeout=60):
                    pass
                code = "OK"
            except grpc.RpcError as error:
                code = error.code().name
            outcomes.append((code, time.monotonic() - begin))
            time.sleep(pause)
    print(json.dumps(outcomes))


if __name__ == "__main__":
    main()
