#!/usr/bin/env python3
"""Soak test: every kind of caller against a server while an operator changes everything that can be
changed. Checks calls, memory, descriptors and threads.

    benchmarks/soak.py BUILD [--seconds 1200] [--rounds 20] [--callers 6] [--rate 20] [--out FOLDER]

Callers request short and long clips, cancel, set tight deadlines, send invalid requests, disconnect;
duet-load sends calls at a steady rate. Meanwhile models are reloaded (SIGHUP and `duet admin`),
loaded, unloaded and rejected, labels move, certificates and tokens are rotated. The server has TLS,
an access file and a repository of its own.

After each round all callers pause. One large request makes the server return its free memory, and
resident memory is read when no call is left. Growth is the median of the last quarter of the rounds
over that of the first quarter after the warm-up (the first fifth).

Exits with 1 if a call was lost (it ended without a status, or with part of its answer), ended in a
way that its kind may not, or was begun and never finished by the server's own count; if an action
failed, memory grew by more than --max-growth, descriptors are left over, or the server did not exit
cleanly. Writes soak.md, soak.svg and soak.json to FOLDER. Needs python3-grpcio,
python3-matplotlib, protobuf-compiler and openssl. docs/soak.md is such a report.
"""

import argparse
import collections
import contextlib
import json
import pathlib
import shutil
import statistics
import sys
import tempfile
import threading
import time

import grpc

import hostile_tools
from load_tool import load_program
from soak_callers import LONG_DEADLINE, Callers
from soak_operator import Operator
from soak_server import Server, run

sys.path.insert(0, str(hostile_tools.SOURCE / "scripts"))
from report import palette, plots  # noqa: E402


class Sampler:
    """Samples memory, descriptors and threads: 600 times in a run, at most ten times a second."""

    def __init__(self, server, seconds):
        self.server, self.samples = server, []
        self._begin, self._over = time.monotonic(), threading.Event()
        self._thread = threading.Thread(target=self._run, args=(max(0.1, seconds / 600),))
        self._thread.start()

    def now(self):
        return time.monotonic() - self._begin

    def _run(self, pause):
        while not self._over.wait(pause):
            self.samples.append((self.now(), self.server.resident(), self.server.descriptors(),
                                 self.server.status("Threads")))

    def end(self):
        self._over.set()
        self._thread.join()


def settle(server, callers):
    """Waits until no call is left and the server has returned its free memory."""
    with server.channel() as channel:
        stream = channel.unary_stream(hostile_tools.SYNTHESIZE)(
            hostile_tools.sample_request(callers.protos, 36000, rate=240.0), timeout=LONG_DEADLINE,
            metadata=(("authorization", f"Bearer {server.tokens['load']}"),))
        with contextlib.suppress(grpc.RpcError):
            next(stream)
        stream.cancel()
    end = time.monotonic() + LONG_DEADLINE
    while server.in_flight() > 0 and time.monotonic() < end:
        time.sleep(0.05)
    time.sleep(3)  # the server trims its heap once a second, twice after large requests


def play(args, server, callers, operator, sampler):
    """Plays all rounds. Returns the samples after each, and the statuses of duet-load's calls."""
    settled, steady = [], collections.Counter()
    for number in range(args.rounds):
        callers.gate.set(True)
        operator.begin()
        load = run(load_program(args.build), "--server", server.address, "--tls-ca",
                   server.authority.certificate, "--token-file", server.folder / "load.token",
                   "--rate", args.rate, "--frames", "46=8,460=1", "--seconds",
                   max(0.5, args.seconds / args.rounds - 1), "--warm-up", "0", "--deadline",
                   LONG_DEADLINE, "--connections", "2", "--seed", number, "--json", "-", "--quiet")
        operator.pause()
        callers.gate.set(False)
        # The exit code is also not 0 if none of a few calls was answered; below 0, a signal ended it.
        if load.returncode < 0 or not load.stdout:
            raise SystemExit(f"duet-load ended with {load.returncode}: {load.stderr}")
        steady.update(json.loads(load.stdout)["steps"][0]["ended"])
        settle(server, callers)
        settled.append((sampler.now(), server.resident(), server.descriptors(),
                        server.status("Threads")))
        print(f"round {number + 1} of {args.rounds}: {settled[-1][1] / 1e6:.1f} MB, "
              f"{sum(callers.ended.values())} calls, {len(callers.lost)} lost", file=sys.stderr,
              flush=True)
    return settled, steady


def growth_of(settled):
    """Relative growth of resident memory after the warm-up."""
    values = [sample[1] for sample in settled]
    rest = values[len(values) // 5:]
    quarter = max(1, len(rest) // 4)
    return statistics.median(rest[-quarter:]) / statistics.median(rest[:quarter]) - 1


def draw(samples, settled, file):
    """Draws resident memory over time: a line under load, dots settled after each round."""
    plots.use_matplotlib()
    from matplotlib import pyplot
    unit, name = (60, "minutes") if max(sample[0] for sample in samples + settled) > 180 else (
        1, "seconds")
    figure, axes = pyplot.subplots(figsize=(8.2, 3.8))
    for index, (readings, style, label) in enumerate((
            (samples, {"linewidth": 1.2}, "under load"),
            (settled, {"linestyle": "", "marker": "o"}, "settled after each round"))):
        axes.plot([time / unit for time, *_ in readings], [rss / 1e6 for _, rss, *_ in readings],
                  color=palette.colour(index), label=label, **style)
    axes.set_title("Resident memory, MB")
    axes.set_xlabel(name)
    axes.set_ylim(bottom=0)
    axes.grid(axis="y", color=palette.GRID)
    axes.legend(loc="lower right")
    figure.savefig(file, bbox_inches="tight", metadata={"Date": None})
    pyplot.close(figure)


def spread(values):
    return f"{min(values)} to {max(values)}"


def describe(args, figures, callers, steady, operator, sampler, settled):
    """The report as Markdown."""
    rest = settled[len(settled) // 5:]
    lines = [
        "| | |", "|---|---|",
        f"| seconds under load | {args.seconds:g}, in {args.rounds} rounds |",
        f"| calls | {figures['calls']} |",
        f"| **lost calls** | **{figures['lost']}** |",
        f"| calls with an unexpected status | {figures['unexpected']} |",
        f"| started but not finished, by the server's count | {figures['unfinished']} |",
        f"| operator changes, of these failed | {sum(operator.done.values())}, "
        f"{len(operator.failed)} |",
        f"| settled resident memory after the warm-up: first, last | {rest[0][1] / 1e6:.1f} MB, "
        f"{rest[-1][1] / 1e6:.1f} MB |",
        f"| **growth after the warm-up** | **{100 * figures['growth']:.2f} %** |",
        f"| maximum resident memory under load | {max(s[1] for s in sampler.samples) / 1e6:.0f} MB |",
        f"| descriptors, settled; under load | {spread([s[2] for s in settled])}; "
        f"{spread([s[2] for s in sampler.samples])} |",
        f"| threads, settled; under load | {spread([s[3] for s in settled])}; "
        f"{spread([s[3] for s in sampler.samples])} |",
        f"| exit code after SIGTERM | {figures['exit_code']} |",
        "", "![Resident memory over time](images/soak.svg)", "", "Status codes by kind of call:", "",
        "| kind | " + " | ".join(codes := sorted({code for _, code in callers.ended} |
                                                  set(steady))) + " |",
        "|---|" + "---|" * len(codes)]
    rows = [(kind, {code: callers.ended[kind, code] for code in codes})
            for kind in Callers.KINDS] + [("duet-load's", steady)]
    for kind, counts in rows:
        lines.append(f"| {kind} | " + " | ".join(str(counts.get(code) or "") for code in codes) +
                     " |")
    lines += ["", "Operator changes:", "", "| change | times |", "|---|---|"]
    lines += [f"| {name} | {count} |" for name, count in sorted(operator.done.items())]
    return "\n".join(lines) + "\n"


def soak(args, folder, protos):
    server = Server(args.server, folder)
    try:
        sampler = Sampler(server, args.seconds)
        callers = Callers(server, protos, args.callers, args.seed)
        operator = Operator(server, callers, args.build / "bin/duet", args.seed)
        try:
            settled, steady = play(args, server, callers, operator, sampler)
        finally:
            callers.end()
            sampler.end()
        metrics = server.metrics()
    finally:
        exit_code = server.stop()

    def total(family):
        return sum(value for name, value in metrics.items() if name.startswith(family + "{"))
    figures = {
        "calls": sum(callers.ended.values()) + sum(steady.values()),
        "lost": len(callers.lost) + steady["INTERNAL"] + steady["DEADLINE_EXCEEDED"],
        "unexpected": sum(callers.unexpected.values()) + sum(
            count for code, count in steady.items() if code not in ("OK", "RESOURCE_EXHAUSTED")),
        "unfinished": int(total("grpc_server_started_total") - total("grpc_server_handled_total")),
        "failed_actions": len(operator.failed),
        "growth": growth_of(settled),
        "descriptors_left": settled[-1][2] - settled[0][2],
        "exit_code": exit_code,
    }
    report = describe(args, figures, callers, steady, operator, sampler, settled)
    print(report)
    for line in callers.lost[:10] + operator.failed[:10]:
        print(line, file=sys.stderr)
    for (kind, code), count in callers.unexpected.items():
        print(f"{kind}: {count} {code}", file=sys.stderr)
    if args.out:
        args.out.mkdir(parents=True, exist_ok=True)
        (args.out / "soak.md").write_text(report, encoding="utf-8")
        draw(sampler.samples, settled, args.out / "soak.svg")
        figures["samples"], figures["settled"] = sampler.samples, settled
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
    parser.add_argument("--rate", type=float, default=20, help="duet-load's calls a second")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--max-growth", type=float, default=0.02)
    parser.add_argument("--server", type=pathlib.Path)
    parser.add_argument("--out", type=pathlib.Path)
    args = parser.parse_args()
    args.server = args.server or args.build / "bin/duet-server"
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "protos").mkdir()
        figures = soak(args, folder, hostile_tools.load_protos(str(folder / "protos")))
    sys.exit(0 if passes(figures, args.max_growth) else 1)


if __name__ == "__main__":
    main()
