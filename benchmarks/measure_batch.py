#!/usr/bin/env python3
"""Measures `duet batch` and prints a table: items a second, and the processor time
and memory of the client.

    benchmarks/measure_batch.py BUILD [--items 20000] [--lines 1000000] [--leaders 50] [--before DUET]

Three runs against a server whose engine answers at once (tests/duet-fake-server), so that the client
is the bottleneck: --items items, each with its own leader and output file; the same with 20 items per
leader; and a manifest of --lines lines of which one in a thousand is
requested, which shows the memory of a long list. Before each, plain gRPC makes as many calls
(BUILD/benchmarks/call_cost): on a machine with other load, only adjacent figures are comparable.
Last, a real server: --leaders leaders with recipes/mixes.textproto, 26 items each.

With --before, another `duet` also makes each run, in turn.
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
RECIPE = """
reactions { labels { weights { key: "kick" value: 1 } } }
output { formats: FORMAT_NPY }
"""
COLUMNS = ("run", "items", "items a second", "bare gRPC, calls a second", "ratio",
           "client, us an item", "in the kernel", "server, us an item", "client's memory, MiB")
JOINTS = ("head", "neck", "torso", "left_shoulder", "left_elbow", "left_hand", "right_shoulder",
          "right_elbow", "right_hand", "left_hip", "left_knee", "left_foot", "right_hip",
          "right_knee", "right_foot")


def machine():
    for line in pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
        if line.startswith("model name"):
            return f"{line.split(':', 1)[1].strip()}, {os.cpu_count()} processors"
    return f"{os.cpu_count()} processors"


def write_leader(path, frames=30):
    """A person of SBU's 15 joints who moves a little."""
    motion = [[[0.1 * j + 0.01 * t, 1.7 - 0.1 * j, 0.02 * j] for j in range(len(JOINTS))]
              for t in range(frames)]
    path.write_text(json.dumps({"frame_rate_hz": 15, "joint_names": JOINTS, "leader": motion}),
                    encoding="utf-8")


def write_manifest(path, lines, leaders=1):
    """Lines leader by leader, as many of each."""
    with path.open("w", encoding="utf-8") as file:
        file.write("leader\n")
        for line in range(lines):
            file.write(f"leader{line * leaders // lines}.json\n")


@contextlib.contextmanager
def serving(program, folder):
    """A server and its address. The log goes to a file, so no reader delays the server."""
    log = folder / f"{program.name}.log"
    with log.open("w", encoding="utf-8") as file:
        server = subprocess.Popen(
            [program, "--listen", "127.0.0.1:0", "--metrics-listen", "off"], stdout=file, stderr=file)
    try:
        while server.poll() is None:
            found = re.search(r'"event":"serving".*?"port":(\d+)', log.read_text(encoding="utf-8"))
            if found:
                break
            time.sleep(0.05)
        else:
            raise SystemExit(f"{program} did not start: {log.read_text(encoding='utf-8')}")
        yield server, f"127.0.0.1:{found[1]}"
    finally:
        server.kill()
        server.wait()


def processor_seconds(pid):
    fields = pathlib.Path(f"/proc/{pid}/stat").read_text(encoding="utf-8").split(") ")[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def measure(name, program, server, address, folder, recipe, *leaders, bare=None):
    """One run; its row of the table. `bare`: calls a second of bare gRPC at the same server."""
    served = processor_seconds(server.pid)
    start = time.monotonic()
    client = subprocess.Popen(
        [program, "batch", *leaders, "--recipe", recipe, "--out", tempfile.mkdtemp(dir=folder),
         "--server", address, "--json"], stdout=subprocess.PIPE, text=True)
    events = [json.loads(line) for line in client.stdout]
    _, status, usage = os.wait4(client.pid, 0)
    seconds = time.monotonic() - start
    if os.waitstatus_to_exitcode(status) != 0:
        raise SystemExit(f"{name}: exit {os.waitstatus_to_exitcode(status)}, {events[-1:]}")
    settled = events[-1]["done"] + events[-1]["rejected"]
    served = processor_seconds(server.pid) - served
    beside = {"bare gRPC, calls a second": f"{bare:,.0f}",
              "ratio": f"{settled / seconds / bare:.2f}"} if bare else {}
    return {"run": name, **beside, "items": f"{settled:,}", "items a second": f"{settled / seconds:,.0f}",
            "client, us an item": f"{1e6 * (usage.ru_utime + usage.ru_stime) / settled:,.0f}",
            "in the kernel": f"{1e6 * usage.ru_stime / settled:,.0f}",
            "server, us an item": f"{1e6 * served / settled:,.0f}",
            "client's memory, MiB": f"{usage.ru_maxrss / 1024:.0f}"}


def bare_calls(build, address, calls):
    printed = subprocess.run([build / "benchmarks" / "call_cost", address, "--calls", str(calls)],
                             stdout=subprocess.PIPE, text=True, check=True).stdout
    return json.loads(printed)["calls_per_second"]


def fake_runs(folder, arguments):
    """The runs that the client limits: name, recipe and leaders."""
    write_leader(folder / "leader0.json")
    for number in range(1, arguments.items):
        os.link(folder / "leader0.json", folder / f"leader{number}.json")
    (folder / "files").write_text(RECIPE, encoding="utf-8")
    write_manifest(folder / "leaders.tsv", arguments.items, arguments.items)
    write_manifest(folder / "items.tsv", arguments.items, max(1, arguments.items // 20))
    write_manifest(folder / "lines.tsv", arguments.lines)
    yield "a leader an item", "files", ("--manifest", folder / "leaders.tsv")
    yield "20 items a leader", "files", ("--manifest", folder / "items.tsv")
    yield (f"1 in 1,000 of {arguments.lines:,} lines", "files",
           ("--manifest", folder / "lines.tsv", "--shard", "0/1000"))


def write_samples(folder, count):
    folder.mkdir()
    samples = sorted((SOURCE / "samples").glob("*.bvh"))
    for number in range(count):
        sample = samples[number % len(samples)]
        shutil.copy(sample, folder / f"{sample.stem}{number}.bvh")


def rows(folder, arguments):
    duet = arguments.build / "bin" / "duet"
    programs = {", before": arguments.before, ", after": duet} if arguments.before else {"": duet}
    with serving(arguments.build / "tests" / "duet-fake-server", folder) as (server, address):
        for name, recipe, leaders in fake_runs(folder, arguments):
            calls = bare_calls(arguments.build, address, min(arguments.items, 5000))
            for which, program in programs.items():
                yield measure(name + which, program, server, address, folder, folder / recipe,
                              *leaders, bare=calls)
    write_samples(folder / "samples", arguments.leaders)
    with serving(arguments.build / "bin" / "duet-server", folder) as (server, address):
        for which, program in programs.items():
            yield measure(f"a real server, `recipes/mixes.textproto`{which}", program,
                          server, address, folder, SOURCE / "recipes" / "mixes.textproto",
                          folder / "samples")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--items", type=int, default=20000)
    parser.add_argument("--lines", type=int, default=1000000)
    parser.add_argument("--leaders", type=int, default=50)
    parser.add_argument("--before", type=pathlib.Path, help="another duet to measure beside")
    arguments = parser.parse_args()
    load = os.getloadavg()[0]
    with tempfile.TemporaryDirectory() as temporary:
        print("| " + " | ".join(COLUMNS) + " |\n|" + "---|" * len(COLUMNS), flush=True)
        for row in rows(pathlib.Path(temporary), arguments):
            print("| " + " | ".join(row.get(column, "") for column in COLUMNS) + " |", flush=True)
    print(f"\n{machine()}; load average before the first run {load:.1f}"
          + (": other programs were running, so compare only figures in the same row."
             if load > 0.5 else "."))


if __name__ == "__main__":
    main()
