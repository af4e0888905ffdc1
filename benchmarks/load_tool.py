"""Runs duet-load, a tool of contrib, for the measuring programs."""

import json
import subprocess


def load_program(build):
    """The path of duet-load in a build. Ends the program if it was not built."""
    program = build / "bin/duet-load"
    if not program.exists():
        raise SystemExit(f"expected {program}, got none; build it: scripts/configure.sh release "
                         f"-DDUET_CONTRIB_LOAD=ON && scripts/build.sh build/release duet-load")
    return program


def run_load(build, address, *flags):
    """Runs BUILD/bin/duet-load, with clips of 45 frames unless `flags` say otherwise; of its only step:
    clips a second, times, calls that failed by status."""
    frames = () if "--frames" in flags else ("--frames", "45")
    printed = subprocess.run([load_program(build), "--server", address, "--json", "-", "--quiet",
                              *frames, *map(str, flags)],
                             stdout=subprocess.PIPE, text=True, check=False).stdout
    step = json.loads(printed)["steps"][0]
    times = step["answers"]["whole_call_ms"]
    first = step["answers"]["first_chunk_ms"]
    return {"clips_per_second": step["answered_per_second"], "p50_ms": times.get("p50", 0),
            "first_chunk_p50_ms": first.get("p50", 0),
            "p99_ms": times.get("p99", 0),
            "failed": {code: count for code, count in step["ended"].items() if code != "OK"}}
