#!/usr/bin/env python3
"""Measures `duet batch` and prints a table: items a second, processor time of client and server, and the client's memory.

    benchmarks/measure_batch.py BUILD [--items 5000] [--leaders 50]

Two runs: --items items of 30 frames, 20 for each leader, against a server whose engine answers at once
(BUILD/tests/duet-fake-server), so that the client is the bottleneck; and --leaders sample leaders with
recipes/mixes.textproto, 26 items each, against a real server.
"""

import argparse
import contextlib
import json
import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import time

SOURCE = pathlib.Path(__file__).resolve().parent.parent
RECIPE = 'reactions { labels { weights { key: "kick" value: 1 } } }\noutput { formats: FORMAT_NPY }\n'
ITEMS_OF_A_LEADER = 20
COLUMNS = ("run", "items", "items a second", "client, us an item", "server, us an item", "client's memory, MiB")
JOINTS = ("head", "neck", "torso", "left_shoulder", "left_elbow", "left_hand", "right_shoulder",
          "right_elbow", "right_hand", "left_hip", "left_knee", "left_foot", "right_hip",
          "right_knee", "right_foot")


def write_leaders(folder, items):
    """Leaders who move a little, and a manifest of `items` lines."""
    motion = [[[0.1 * j + 0.01 * t, 1.7 - 0.1 * j, 0.02 * j] for j in range(len(JOINTS))] for t in range(30)]
    text = json.dumps({"frame_rate_hz": 15, "joint_names": JOINTS, "leader": motion})
    names = [f"leader{line // ITEMS_OF_A_LEADER}.json" for line in range(items)]
    for name in set(names):
        (folder / name).write_text(text, encoding="utf-8")
    (folder / "items.tsv").write_text("leader\n" + "".join(f"{name}\n" for name in names), encoding="utf-8")
    (folder / "recipe").write_text(RECIPE, encoding="utf-8")


def write_samples(folder, count):
    folder.mkdir()
    samples = sorted((SOURCE / "samples").glob("*.bvh"))
    for number in range(count):
        sample = samples[number % len(samples)]
        shutil.copy(sample, folder / f"{sample.stem}{number}.bvh")


@contextlib.contextmanager
def serving(program, folder):
    """A server and its address. The log goes to a file, so no reader delays the server."""
    log = folder / f"{program.name}.log"
    with log.open("w", encoding="utf-8") as file:
        server = subprocess.Popen(
            [program, "--listen", "127.0.0.1:0", "--metrics-listen", "off"], stdout=file, stderr=file)
    try:
        while not (found := re.search(r'"event":"serving".*?"port":(\d+)', log.read_text(encoding="utf-8"))):
            if server.poll() is not None:
                raise SystemExit(f"{program} did not start: {log.read_text(encoding='utf-8')}")
            time.sleep(0.05)
        yield server, f"127.0.0.1:{found[1]}"
    finally:
        server.kill()
        server.wait()


def processor_seconds(pid):
    fields = pathlib.Path(f"/proc/{pid}/stat").read_text(encoding="utf-8").split(") ")[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def measure(name, build, program, folder, *flags):
    """One run; its row of the table."""
    with serving(build / program, folder) as (server, address):
        served, start = processor_seconds(server.pid), time.monotonic()
        out = pathlib.Path(tempfile.mkdtemp(dir=folder))
        client = subprocess.Popen(
            [build / "bin/duet", "batch", *flags, "--out", out, "--server", address, "--quiet"])
        _, status, usage = os.wait4(client.pid, 0)
        seconds, served = time.monotonic() - start, processor_seconds(server.pid) - served
    if os.waitstatus_to_exitcode(status) != 0:
        raise SystemExit(f"{name}: exit {os.waitstatus_to_exitcode(status)}")
    counts = json.loads((out / "dataset.json").read_text(encoding="utf-8"))["items"]
    settled = counts["done"] + counts["rejected"]
    return (name, f"{settled:,}", f"{settled / seconds:,.0f}",
            f"{1e6 * (usage.ru_utime + usage.ru_stime) / settled:,.0f}", f"{1e6 * served / settled:,.0f}",
            f"{usage.ru_maxrss / 1024:.0f}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--items", type=int, default=5000)
    parser.add_argument("--leaders", type=int, default=50)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        write_leaders(folder, arguments.items)
        write_samples(folder / "samples", arguments.leaders)
        print("| " + " | ".join(COLUMNS) + " |\n|" + "---|" * len(COLUMNS), flush=True)
        for row in (("an engine that answers at once", "tests/duet-fake-server", "--manifest", folder / "items.tsv",
                     "--recipe", folder / "recipe"),
                    ("a real server", "bin/duet-server", folder / "samples", "--recipe",
                     SOURCE / "recipes/mixes.textproto")):
            print("| " + " | ".join(measure(row[0], arguments.build, row[1], folder, *row[2:])) + " |", flush=True)
    print(f"\n{os.cpu_count()} processors; load average now {os.getloadavg()[0]:.1f}.")


if __name__ == "__main__":
    main()
