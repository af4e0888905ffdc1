#!/usr/bin/env python3
"""Measures live sessions: memory, what regular ones notice of hostile ones and of a server that dies.

    benchmarks/measure_live.py BUILD hostile [--seconds 600] [--sessions 4]
    benchmarks/measure_live.py BUILD hour [--minutes 60] [--sessions 4]
    benchmarks/measure_live.py BUILD killed [--times 20]
    benchmarks/measure_live.py BUILD candidates [--seconds 10]

hostile: regular sessions of duet-load at 30 frames a second, first without and then beside callers that
never send, never read, end at once, send tiny, impossible, huge or malformed messages, or disconnect.
Prints latency, frames that were lost or late, and memory.

hour: sessions whose callers send each frame as soon as the one before is answered: an hour of frames at
30 a second takes some minutes. Prints memory after each tenth.

killed: a session of `duet live` in real time whose server is killed while another one serves. Prints the longest time
without a frame, and whether all frames are those of an undisturbed session: they are unless the machine is so
busy that the server skips evaluations.

candidates: short clips and one live session of a client, alone and beside eight live sessions of another client with
1, 8 and 16 candidates. Prints the time of a clip, the latency of the live session, and the frames that were
answered from an older plan.

Exits with 1 if a regular session lost a frame or did not end with OK, if memory grew by more than
MEMORY_MB, or if the session beside candidates was answered from an older plan. Needs python3-grpcio and protobuf-compiler.
"""

import argparse
import contextlib
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import threading
import time

from load_tool import load_program

SOURCE = pathlib.Path(__file__).resolve().parent.parent
os.environ.setdefault("DUET_SOURCE_DIR", str(SOURCE))
sys.path.insert(0, str(SOURCE / "tests/e2e"))
CLIENT_KEY = "x-duet-client"
RATE = 30
WINDOW = 256  # frames that a session of an hour may have unanswered


def say(figure, value):
    print(f"| {figure} | {value} |", flush=True)


def load(args, server, seconds, sessions=None):
    """Regular sessions; duet-load's figures of them."""
    printed = subprocess.run(
        [load_program(args.build), "--server", server.address, "--live", str(sessions or args.sessions),
         "--seconds", str(seconds), "--deadline", str(seconds + 60), "--json", "-", "--quiet"],
        stdout=subprocess.PIPE, text=True, check=False).stdout
    return json.loads(printed)["live"][0]


def say_load(name, step):
    latency = step["latency_ms"]
    say(f"{name}: latency, ms",
        f"p50 {latency['p50']:.1f}, p99 {latency['p99']:.1f}, most {latency['max']:.0f}")
    say(f"{name}: added at the server, ms",
        f"p50 {step['at_server_ms']['p50']:.1f}, p99 {step['at_server_ms']['p99']:.1f}")
    say(f"{name}: frames answered of those sent", f"{step['answered']} of {step['sent']}")
    say(f"{name}: lost, doubled, answered from an older plan",
        f"{step['lost']}, {step['doubled']}, {step['skipped']}")
    say(f"{name}: sessions by status", ", ".join(f"{count} {code}"
                                                 for code, count in step["ended"].items()))


def undisturbed(args, step):
    return (step["lost"] == step["doubled"] == 0 and step["answered"] == step["sent"] and
            step["ended"] == {"OK": args.sessions})


def hostile(args):
    from live_hostile import HostileCallers  # pylint: disable=import-outside-toplevel
    with args.running(args.build / "bin/duet-server", "--client-key", CLIENT_KEY) as server:
        quiet = load(args, server, min(10, args.seconds))
        say_load("alone", quiet)
        begin = server.memory()
        say("memory before, MB", begin)
        with HostileCallers(server.address, CLIENT_KEY) as callers:
            beside = load(args, server, args.seconds)
        for (kind, code), count in sorted(callers.ends.items()):
            say(f"sessions: {kind}", f"{count} {code}")
        say_load("beside", beside)
        time.sleep(10)
        say("memory at its peak, MB", server.memory("VmHWM"))
        say("memory ten seconds later, MB", server.memory())
        alive = server.process.poll() is None
        return (alive and undisturbed(args, beside) and
                server.memory() - begin < args.memory_mb)


def answer_all(server, frames):
    """A session of so many frames, each sent when an earlier one is answered. Returns how many were
    answered."""
    import live_clients as live  # pylint: disable=import-outside-toplevel
    leader = live.person(live.SBU_JOINTS, RATE, 10 * RATE)
    with live.grpc.insecure_channel(server.address) as channel:
        session = live.Session(channel, live.start_message(), timeout=None)
        sent = 0
        while session.read():
            last = max(session.frames, default=-1)
            session.frames = {last: session.frames.get(last)} if last >= 0 else {}
            session.parts.clear()
            session.notices.clear()
            while sent < min(frames, last + WINDOW):
                session.send(live.frames_message(sent, [leader[sent % len(leader)]]))
                sent += 1
            if sent == frames:
                session.finish()
                sent += 1
        return session.summary.frame_count if session.summary else 0


def hour(args):
    frames = round(args.minutes * 60 * RATE)
    answered = [0] * args.sessions
    with args.running(args.build / "bin/duet-server") as server:
        def session(i):
            answered[i] = answer_all(server, frames)
        threads = [threading.Thread(target=session, args=(i,)) for i in range(args.sessions)]
        for thread in threads:
            thread.start()
        readings = []
        while any(thread.is_alive() for thread in threads):
            time.sleep(1)
            readings.append(server.memory())
        tenth = max(1, len(readings) // 10)
        for i in range(0, len(readings), tenth):
            say(f"memory after {100 * i // len(readings)} %, MB", readings[i])
        say("frames answered of those sent", f"{sum(answered)} of {args.sessions * frames}")
        growth = readings[-1] - readings[min(tenth, len(readings) - 1)]
        say("growth after the first tenth, MB", growth)
        return sum(answered) == args.sessions * frames and growth < args.memory_mb


def work_of(server):
    """Clock ticks of processor time that a server has used."""
    stat = pathlib.Path(f"/proc/{server.pid}/stat").read_text(encoding="ascii")
    return sum(map(int, stat.rpartition(")")[2].split()[11:13]))


def interrupted(command, servers):
    """Kills the server of a session after a second. Returns the longest time without a frame from its death on,
    all lines, and the summary."""
    before = [work_of(server) for server in servers]
    address = ",".join(server.address for server in servers)
    with subprocess.Popen([*command, "--realtime", "--server", f"ipv4:{address}"],
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        lines = [process.stdout.readline() for _ in range(1 + RATE)]
        work = [work_of(server) - ticks for server, ticks in zip(servers, before)]
        pid = servers[work.index(max(work))].pid  # a session goes to either
        os.kill(pid, signal.SIGKILL)
        os.waitid(os.P_PID, pid, os.WEXITED | os.WNOWAIT)  # the system closes its connections
        times = [time.monotonic()]
        for line in process.stdout:
            times.append(time.monotonic())
            lines.append(line)
        return max(b - a for a, b in zip(times, times[1:])), lines, process.stderr.read()


def killed(args):
    import tools  # pylint: disable=import-outside-toplevel
    command = [args.build / "bin/duet", "live", "--from", tools.sample("hug"), "--label", "hug=1", "--to", "-"]
    gaps, resumed, in_time, same = [], 0, 0, 0
    for _ in range(args.times):
        servers = [tools.Server(), tools.Server()]
        try:
            alone = tools.run(*command, "--server", servers[0].address).stdout.splitlines(True)
            gap, lines, summary = interrupted(command, servers)
        finally:
            for server in servers:
                server.kill()
        gaps.append(1000 * gap)
        resumed += "resumed   1 time" in summary
        if "older plan" not in summary:
            in_time += 1
            same += lines == alone
    gaps.sort()
    # Which server works is a guess of a hundredth of a second; the other one may have been killed.
    say("sessions that resumed", f"{resumed} of {args.times}")
    say("longest time without a frame, ms", f"p50 {gaps[len(gaps) // 2]:.0f}, most {gaps[-1]:.0f}")
    say("sessions in which every evaluation was in time", in_time)
    say("... and whose frames are those of an undisturbed session", same)
    return resumed > 0 and same == in_time


class Sessions:
    """Live sessions in real time of a client of its own, from a process of their own."""

    def __init__(self, server, count, samples):
        self.process = subprocess.Popen(
            [sys.executable, "-B", SOURCE / "benchmarks/live_beside.py", server.address, CLIENT_KEY, str(count),
             str(samples)], stdin=subprocess.PIPE, stdout=subprocess.PIPE)

    def __enter__(self):
        self.process.stdout.readline()  # all are answered
        return self

    def __exit__(self, *_):
        self.process.communicate()


def candidates(args):
    import hostile_tools as tools  # pylint: disable=import-outside-toplevel
    kept = True
    with args.running(args.build / "bin/duet-server", "--client-key", CLIENT_KEY) as server, \
            tempfile.TemporaryDirectory() as folder:
        request = tools.sample_request(tools.load_protos(folder), frames=30)
        for name, count in (("alone", 0), ("1 candidate", 1), ("8 candidates", 8), ("16 candidates", 16)):
            with Sessions(server, 8, count) if count else contextlib.nullcontext():
                with tools.Beside(server, tools.SYNTHESIZE, request, pause=0.037) as clips:
                    step = load(args, server, args.seconds, sessions=1)
            times = sorted(1000 * outcome.seconds for outcome in clips.outcomes)
            say(f"{name}: a clip, ms", f"p50 {times[len(times) // 2]:.1f}, p99 {times[len(times) * 99 // 100]:.1f}")
            say_load(name, step)
            kept = kept and step["skipped"] == step["lost"] == 0
    return kept


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("measured", choices=("hostile", "hour", "killed", "candidates"))
    parser.add_argument("--seconds", type=float, default=600,
                        help="of the hostile sessions, or beside candidates")
    parser.add_argument("--minutes", type=float, default=60, help="of frames at 30 a second")
    parser.add_argument("--times", type=int, default=20, help="servers that are killed")
    parser.add_argument("--sessions", type=int, default=4, help="regular sessions side by side")
    parser.add_argument("--memory-mb", type=int, default=150, help="growth that is accepted")
    args = parser.parse_args()
    args.build = args.build.resolve()
    os.environ.setdefault("DUET_BIN_DIR", str(args.build / "bin"))
    from hostile_tools import running  # pylint: disable=import-outside-toplevel
    args.running = running
    measure = {"hostile": hostile, "hour": hour, "killed": killed, "candidates": candidates}[args.measured]
    return 0 if measure(args) else 1


if __name__ == "__main__":
    sys.exit(main())
