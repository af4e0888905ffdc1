#!/usr/bin/env python3
"""What `duet batch` costs its own machine: processor time and memory of the client alone, against a
server whose engine answers at once (tests/duet-fake-server).

    benchmarks/measure_batch.py BUILD [--items 20000] [--lines 1000000] [--before DUET]

Four runs: --items items end to end, each of a leader of its own, which is read for it; the same
with 20 items a leader; that into packed shards; and a manifest of --lines lines of which one in a
thousand is asked for, which shows the memory that a long list takes. Before them what bare gRPC
takes for as many calls (BUILD/benchmarks/call_cost). With --before each run is made by another
`duet` as well, in turn, so that both meet the same machine.
"""

import argparse
import json
import os
import pathlib
import re
import subprocess
import tempfile
import time

RECIPE = """
reactions { labels { weights { key: "kick" value: 1 } } }
output { formats: FORMAT_NPY %s }
"""


def write_leader(path, frames=30):
    """A person of SBU's 15 joints who moves a little."""
    joints = ["head", "neck", "torso", "left_shoulder", "left_elbow", "left_hand",
              "right_shoulder", "right_elbow", "right_hand", "left_hip", "left_knee", "left_foot",
              "right_hip", "right_knee", "right_foot"]
    motion = [[[0.1 * j + 0.01 * t, 1.7 - 0.1 * j, 0.02 * j] for j in range(len(joints))]
              for t in range(frames)]
    path.write_text(json.dumps({"frame_rate_hz": 15, "joint_names": joints, "leader": motion}),
                    encoding="utf-8")


def write_manifest(path, lines, leaders=1):
    """Lines leader by leader, as many of each."""
    with path.open("w", encoding="utf-8") as file:
        file.write("leader\n")
        for line in range(lines):
            file.write(f"leader{line * leaders // lines}.json\n")


def start_server(build, log):
    """The server and its address; its log goes to a file, which no reader holds up."""
    with log.open("w", encoding="utf-8") as file:
        server = subprocess.Popen(
            [build / "tests" / "duet-fake-server", "--listen", "127.0.0.1:0", "--metrics-listen", ""],
            stdout=file, stderr=file)
    while server.poll() is None:
        if found := re.search(r'"event":"serving".*?"port":(\d+)', log.read_text(encoding="utf-8")):
            return server, f"127.0.0.1:{found[1]}"
        time.sleep(0.05)
    raise SystemExit("the server did not start")


def processor_seconds(pid):
    fields = pathlib.Path(f"/proc/{pid}/stat").read_text(encoding="utf-8").split(") ")[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def measure(name, program, server, address, folder, manifest, *flags, recipe="recipe"):
    served = processor_seconds(server.pid)
    start = time.monotonic()
    client = subprocess.Popen(
        [program, "batch", "--manifest", manifest, "--recipe", folder / recipe,
         "--out", tempfile.mkdtemp(dir=folder), "--server", address, "--json", *flags],
        stdout=subprocess.PIPE, text=True)
    events = [json.loads(line) for line in client.stdout]
    _, status, usage = os.wait4(client.pid, 0)
    seconds = time.monotonic() - start
    own = usage.ru_utime + usage.ru_stime
    done = events[-1]["done"]
    served = processor_seconds(server.pid) - served
    print(f"{name}: exit {os.waitstatus_to_exitcode(status)}, {done} items in {seconds:.1f} s, "
          f"{done / seconds:.0f} a second; client {1e6 * own / max(done, 1):.0f} us of processor time an item, "
          f"{1e6 * usage.ru_stime / max(done, 1):.0f} of them in the kernel ({own / seconds:.2f} cores), "
          f"server {1e6 * served / max(done, 1):.0f} us; client's memory at most "
          f"{usage.ru_maxrss / 1024:.0f} MiB", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--items", type=int, default=20000)
    parser.add_argument("--lines", type=int, default=1000000)
    parser.add_argument("--before", type=pathlib.Path, help="another duet to measure beside")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        write_leader(folder / "leader0.json")
        for number in range(1, arguments.items):
            os.link(folder / "leader0.json", folder / f"leader{number}.json")
        (folder / "recipe").write_text(RECIPE % "", encoding="utf-8")
        (folder / "packed").write_text(RECIPE % "packing: PACKING_NPZ", encoding="utf-8")
        write_manifest(folder / "leaders.tsv", arguments.items, arguments.items)
        write_manifest(folder / "items.tsv", arguments.items, max(1, arguments.items // 20))
        write_manifest(folder / "lines.tsv", arguments.lines)
        server, address = start_server(arguments.build, folder / "log")
        try:
            calls = subprocess.run(
                [arguments.build / "benchmarks" / "call_cost", address, "--calls",
                 str(arguments.items)], stdout=subprocess.PIPE, text=True, check=True)
            print("bare gRPC:", calls.stdout.strip(), flush=True)
            programs = {"": arguments.build / "bin" / "duet"}
            if arguments.before:
                programs = {" before": arguments.before, " after": programs[""]}
            for runs in (("leaders", "leaders.tsv"), ("items", "items.tsv"),
                         ("packed", "items.tsv"), ("lines", "lines.tsv", "--shard", "0/1000")):
                name, manifest, *flags = runs
                for which, program in programs.items():
                    measure(name + which, program, server, address, folder, folder / manifest,
                            *flags, recipe="packed" if name == "packed" else "recipe")
        finally:
            server.kill()


if __name__ == "__main__":
    main()
