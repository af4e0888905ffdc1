#!/usr/bin/env python3
"""Measures the Spar page in Chromium, through the gateway, with each model that answers live.

    contrib/studio/measure_page.py BUILD [--seconds 60]

A move begins every second. Prints the time from the page's sending of a leader frame until its script has the
follower's frame. Software draws the page, on the same processor as the server: a graphics card takes that load
off. Exits with 1 if a frame that was sent was not answered.
"""

import argparse
import contextlib
import json
import os
import pathlib
import sys
import time

HERE = pathlib.Path(__file__).resolve().parent
SOURCE = HERE.parents[1]
# Run on the page: keeps latencies and counts pictures.
COUNT = """{
  const add = spar.strip.add.bind(spar.strip);
  spar.strip.add = (latency) => { window.parts.push(latency); add(latency); };
}
(function count() { ++window.pictures; requestAnimationFrame(count); })();"""


def say(figure, value):
    print(f"| {figure} | {value} |", flush=True)


def measure_page(page, model, seconds):
    """Plays a model on the open Spar page. Returns whether each frame that was sent was answered."""
    page.evaluate(f"chooseModel(spar.models.find((one) => nameOf(one) === {json.dumps(model)}))")
    page.wait_until("spar.seen")
    page.evaluate("window.parts = []; window.pictures = 0")
    first = page.evaluate("spar.session.leader.end")
    end = time.monotonic() + seconds
    move = 0
    while time.monotonic() < end:
        page.press(str(1 + move % 4))
        move += 1
        time.sleep(1)
    parts = sorted(page.evaluate("window.parts"))
    sent = page.evaluate("spar.session.leader.end") - first
    p50, p99 = parts[len(parts) // 2], parts[len(parts) * 99 // 100]
    say(f"{model}: from a leader frame to the answer, ms",
        f"p50 {p50:.1f}, p99 {p99:.1f}, most {parts[-1]:.0f}")
    say(f"{model}: leader frames, parts of the follower", f"{sent}, {len(parts)}")
    say(f"{model}: pictures a second", f"{page.evaluate('window.pictures') / seconds:.0f}")
    return len(parts) > 0 and page.evaluate(
        "spar.session.leader.end - spar.session.follower.end <= spar.session.settings.delay + 5")


def measure(args):
    # pylint: disable=import-outside-toplevel
    import tools
    from browser import Browser
    from gateways import Gateway
    with contextlib.ExitStack() as stack:
        server = stack.enter_context(tools.running_server())
        gateway = Gateway(server.address)
        stack.callback(gateway.stop)
        browser = Browser()
        stack.callback(browser.close)
        spar = browser.open(f"{gateway.url}/spar", width=420, height=420)
        spar.evaluate(f"window.parts = []; window.pictures = 0; {COUNT}")
        models = spar.evaluate("spar.models.map(nameOf)")
        return all([measure_page(spar, model, args.seconds / len(models)) for model in models])


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--seconds", type=float, default=60)
    args = parser.parse_args()
    # The helpers of the tests find the programs by these.
    os.environ.update(DUET_SOURCE_DIR=str(SOURCE), DUET_BIN_DIR=str(args.build.resolve() / "bin"))
    sys.path[:0] = [str(HERE / "tests"), str(SOURCE / "tests" / "e2e")]
    return 0 if measure(args) else 1


if __name__ == "__main__":
    sys.exit(main())
