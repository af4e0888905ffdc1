#!/usr/bin/env python3
"""Compares duet-server with a straightforward implementation: a Python gRPC server around the same
network in eager PyTorch. Both get the same load in turn; duet-load runs on the same cores.

    benchmarks/compare_servers.py build/release [ROUNDS]

Needs Debian's python3-torch, python3-grpcio and protobuf-compiler-grpc. Prints clips of 45 frames a
second and times, the best of a few rounds (3), and the engine's throughput with one process per
core.
"""
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).resolve().parent
SECONDS = 4
ENVIRONMENT = dict(os.environ, OMP_NUM_THREADS="1")
# Generator in inference_eager.py, version of the embedded sbu.
GENERATORS = (("Paper", 1), ("Sampling", 3))


def wait_for(find, process):
    while process.poll() is None:
        if found := find():
            return found
        time.sleep(0.05)
    raise SystemExit(f"{process.args} ended")


def load(build, address, callers, *model):
    """Runs duet-load with clips of 45 frames; clips a second and the median time of a call."""
    printed = subprocess.run([build / "bin/duet-load", "--server", address, "--json", "-", "--quiet",
                              "--frames", "45", "--callers", str(callers), "--seconds", str(SECONDS), *model],
                             stdout=subprocess.PIPE, text=True, check=False).stdout
    step = json.loads(printed)["steps"][0]
    return {"clips_per_second": step["answered_per_second"],
            "p50_ms": step["answers"]["whole_call_ms"].get("p50", 0)}


def with_duet(build, version, folder, callers):
    log = folder / "log"
    with log.open("w", encoding="utf-8") as file:
        server = subprocess.Popen([build / "bin/duet-server", "--listen", "127.0.0.1:0",
                                   "--metrics-listen", "off", "--clean-up", "off"], stderr=file)
    try:
        port = wait_for(lambda: re.search(r'"event":"serving".*?"port":(\d+)',
                                          log.read_text(encoding="utf-8")), server)[1]
        return load(build, f"127.0.0.1:{port}", callers, "--model", f"sbu@{version}")
    finally:
        server.terminate()
        server.wait()


def with_eager(build, generator, folder, callers):
    port_file = folder / "port"
    port_file.unlink(missing_ok=True)
    server = subprocess.Popen(["/usr/bin/python3", HERE / "eager_server.py", port_file,
                               "--generator", generator], env=ENVIRONMENT)
    try:
        port = wait_for(lambda: port_file.exists() and port_file.read_text(encoding="utf-8"),
                        server)
        return load(build, f"127.0.0.1:{port}", callers)
    finally:
        server.kill()
        server.wait()


def engine_alone(build, version):
    """Windows a second in batches of 8, a process on each core."""
    command = [build / "benchmarks/synthesis_benchmark",
               f"--benchmark_filter=^windows/sbu@{version}/(int16|f32)/8$",
               f"--benchmark_min_time={SECONDS}", "--benchmark_format=json"]
    processes = [subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
                 for _ in range(os.cpu_count())]
    speed = 0
    for process in processes:
        rows = json.loads(process.communicate()[0])["benchmarks"]
        speed += max(8000 / row["real_time"] for row in rows)
    return speed


def main():
    build, rounds = pathlib.Path(sys.argv[1]).resolve(), int(sys.argv[2]) if len(sys.argv) > 2 else 3
    if not (build / "bin/duet-load").exists():
        raise SystemExit(f"expected {build}/bin/duet-load, got none; build it: scripts/configure.sh release "
                         "-DDUET_CONTRIB_LOAD=ON && scripts/build.sh build/release duet-load")
    print("| generator | callers | duet-server: clips/s, p50 ms | eager: clips/s, p50 ms | times |")
    print("|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for generator, version in GENERATORS:
            for callers in (1, 8, 64):
                ours, theirs = [], []
                for _ in range(rounds):
                    ours.append(with_duet(build, version, folder, callers))
                    theirs.append(with_eager(build, generator, folder, callers))
                fast, slow = (max(found, key=lambda one: one["clips_per_second"])
                              for found in (ours, theirs))
                print(f"| sbu@{version} | {callers} | {fast['clips_per_second']:.0f}, "
                      f"{fast['p50_ms']:.1f} | {slow['clips_per_second']:.0f}, "
                      f"{slow['p50_ms']:.1f} | "
                      f"{fast['clips_per_second'] / max(slow['clips_per_second'], 1e-9):.1f} |",
                      flush=True)
            print(f"| sbu@{version} | engine only | {engine_alone(build, version):.0f} | | |",
                  flush=True)


if __name__ == "__main__":
    main()
