"""Runs duet-load for the measuring programs."""

import json
import subprocess


def run_load(build, address, *flags):
    """Runs BUILD/bin/duet-load, with clips of 45 frames unless `flags` say otherwise; of its only step:
    clips a second, times, calls that failed by status."""
    frames = () if "--frames" in flags else ("--frames", "45")
    printed = subprocess.run([build / "bin/duet-load", "--server", address, "--json", "-", "--quiet",
                              *frames, *map(str, flags)],
                             stdout=subprocess.PIPE, text=True, check=False).stdout
    step = json.loads(printed)["steps"][0]
    times = step["answers"]["whole_call_ms"]
    first = step["answers"]["first_chunk_ms"]
    return {"clips_per_second": step["answered_per_second"], "p50_ms": times.get("p50", 0),
            "first_chunk_p50_ms": first.get("p50", 0),
            "p99_ms": times.get("p99", 0),
            "failed": {code: count for code, count in step["ended"].items() if code != "OK"}}
