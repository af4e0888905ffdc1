#!/usr/bin/env python3
"""Writes the limits that duet-server derives from its memory to benchmarks/memory_plan.json (docs/costs.md).

    benchmarks/plan_memory.py build/release
"""

import json
import pathlib
import re
import subprocess
import sys

MIB = 1 << 20
LIMITS = ("max_calls", "max_request_bytes", "max_transport_bytes", "max_held_bytes")


def limits(server, mebibytes):
    """The limits for a memory with two workers; those in bytes as MiB."""
    config = subprocess.run([server, "--workers", "2", "--memory-limit-bytes",
                             str(mebibytes * MIB), "--print-config"],
                            check=True, capture_output=True, text=True).stdout
    values = {name: int(re.search(rf"^{name}: (\d+)", config, re.MULTILINE)[1]) for name in LIMITS}
    return {name.replace("bytes", "mebibytes"): round(value / MIB, 1) if "bytes" in name else value
            for name, value in values.items()}


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    plan = {f"{size} MiB": limits(pathlib.Path(sys.argv[1]) / "bin/duet-server", size)
            for size in (256, 400, 512, 1024, 2048)}
    target = pathlib.Path(__file__).with_name("memory_plan.json")
    target.write_text(json.dumps(plan, indent=1) + "\n", encoding="utf-8")
