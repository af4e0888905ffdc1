#!/usr/bin/env python3
"""Measures calls during reloads of a model: a steady rate of calls to two models, one of which is
replaced repeatedly (`duet admin reload` after its checkpoint has changed).

    benchmarks/measure_reload.py BUILD [--rate 30] [--seconds 60] [--pause 4] [--server PROGRAM]

Prints the times of the calls that were due during a reload and of the other calls of the same run, so
that disturbances affect both.
"""

import argparse
import csv
import json
import pathlib
import re
import shutil
import subprocess
import tempfile
import time

from load_tool import load_program

SOURCE = pathlib.Path(__file__).resolve().parent.parent
CHECKPOINTS = SOURCE / "model/embedded"


def publish(repository, name, change=0):
    """Writes a checkpoint to the repository; only its description is changed."""
    folder = repository / name / "1"
    partial = repository / f".{name}"
    shutil.rmtree(partial, ignore_errors=True)
    shutil.copytree(CHECKPOINTS / name / "1", partial)
    manifest = json.loads((partial / "manifest.json").read_text(encoding="utf-8"))
    manifest["description"] = f"change {change}"
    (partial / "manifest.json").write_text(json.dumps(manifest), encoding="utf-8")
    shutil.rmtree(folder, ignore_errors=True)
    folder.parent.mkdir(exist_ok=True)
    partial.rename(folder)


def start(program, repository, log):
    with log.open("w", encoding="utf-8") as file:
        server = subprocess.Popen(
            [program, "--listen", "127.0.0.1:0", "--metrics-listen", "off", "--admin-listen",
             "127.0.0.1:0", "--model-repository", repository, "--log-success-ratio", "0"],
            stderr=file)
    while server.poll() is None:
        text = log.read_text(encoding="utf-8")
        if found := re.search(r'"event":"serving".*?"port":(\d+).*?"admin_port":(\d+)', text):
            return server, *map(int, found.groups())
        time.sleep(0.02)
    raise SystemExit(log.read_text(encoding="utf-8"))


def reload_again_and_again(args, repository, admin_port, load):
    """Until the load is over; when each reload began and ended."""
    reloads = []
    while load.poll() is None:
        publish(repository, "sbu", len(reloads) + 1)
        begin = time.time()
        done = subprocess.run([args.build / "bin/duet", "admin", "--admin-server",
                               f"127.0.0.1:{admin_port}", "reload"], capture_output=True, text=True,
                              check=True).stdout
        if "loaded: sbu/1" not in done:
            raise SystemExit(f"nothing was loaded: {done}")
        reloads.append((begin, time.time()))
        time.sleep(args.pause)
    return reloads


def percentile(ascending, percent):
    return ascending[min(len(ascending) - 1, int(percent / 100 * len(ascending)))]


def report(name, calls):
    times = sorted(float(call["whole_call_ms"]) for call in calls)
    failed = sum(call["code"] != "OK" for call in calls)
    print(f"| {name} | {len(calls)} | {failed} | " +
          " | ".join(f"{percentile(times, p):.1f}" for p in (50, 90, 95, 99, 100)) + " |")


def measure(args, folder):
    repository = folder / "models"
    repository.mkdir()
    for name in ("sbu", "k3hi"):
        publish(repository, name)
    server, port, admin_port = start(args.server, repository, folder / "log")
    try:
        load = subprocess.Popen(
            [load_program(args.build), "--server", f"127.0.0.1:{port}", "--rate",
             str(args.rate), "--seconds", str(args.seconds), "--model", "sbu,k3hi", "--records",
             folder / "calls.csv", "--json", folder / "load.json", "--quiet"],
            stdout=subprocess.DEVNULL)
        reloads = reload_again_and_again(args, repository, admin_port, load)
    finally:
        server.terminate()
        server.wait()
    step = json.loads((folder / "load.json").read_text(encoding="utf-8"))["steps"][0]
    with (folder / "calls.csv").open(encoding="utf-8") as file:
        calls = list(csv.DictReader(file))
    begin = step["measured_from_unix"]
    during = [call for call in calls
              if any(first <= begin + float(call["due_seconds"]) <= last for first, last in reloads)]
    others = [call for call in calls if call not in during]
    seconds = sorted(last - first for first, last in reloads)
    print(f"{len(reloads)} reloads of {seconds[len(seconds) // 2]:.2f} s; "
          f"kept up: {step['kept_up']}\n")
    print("| calls due | calls | failed | p50 ms | p90 | p95 | p99 | max |")
    print("|---|---|---|---|---|---|---|---|")
    for model in ("sbu@1", "k3hi@1"):
        for name, chosen in (("while a reload runs", during), ("otherwise", others)):
            report(f"{name}, {model}", [call for call in chosen if call["model"] == model])


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--rate", type=float, default=30, help="calls a second")
    parser.add_argument("--seconds", type=float, default=60)
    parser.add_argument("--pause", type=float, default=4, help="seconds between reloads")
    parser.add_argument("--server", type=pathlib.Path)
    args = parser.parse_args()
    args.server = args.server or args.build / "bin/duet-server"
    with tempfile.TemporaryDirectory() as folder:
        measure(args, pathlib.Path(folder))


if __name__ == "__main__":
    main()
