#!/usr/bin/env python3
"""Simulates clusters of 10, 100 and 1,000 pods while the load rises tenfold within a minute: queue,
pods and rejected calls, from measured service times. Prints a table and draws a picture.

    benchmarks/simulate_pods.py [--clips-per-second 567] [--out scale.png]

The model: clips arrive at random (Poisson) and are spread over the ready pods in turn. Each pod has
two workers and queues at most 64 clips. Every 15 s the autoscaler (deploy/kubernetes) reads each
pod's queue, averaged over 30 s, and requests pods in proportion to queue / 8: at most twice the
current number and four times the initial one. After five quiet minutes it removes one pod in a
hundred per minute. A new pod serves after 10 s (3 s for an image that is on the node, its start and
its first readiness; the rest for scheduling). Steps of 100 ms. The seed is fixed: the same arguments
give the same result.
"""

import argparse
import math
import pathlib
import sys

import numpy

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "scripts"))
from report import palette, plots  # noqa: E402

STEP = 0.1  # seconds
DURATION = 780
WORKERS = 2
MAX_QUEUED = 64
TARGET_QUEUED = 8
AUTOSCALER_PERIOD = 15
METRIC_WINDOW = 30
STABILISATION = 300
POD_START = 10
MOST_TIMES = 4
# Shares of what all workers of the first pods can do: quiet, ten times as much, quiet.
QUIET, BUSY = 0.3, 3.0
RISE_AT, RISE_SECONDS, FALL_AT = 60, 60, 420


def load_share(time):
    """Calls that come, as a share of what the first pods can answer."""
    if time < RISE_AT or time >= FALL_AT:
        return QUIET
    return QUIET + (BUSY - QUIET) * min(1, (time - RISE_AT) / RISE_SECONDS)


class Autoscaler:
    """Pods wanted, from the queue of late; goes down slowly."""

    def __init__(self, pods):
        self._least, self._most = pods, MOST_TIMES * pods
        self._wanted = []  # (time, pods) of late

    def pods(self, time, ready, queued):
        wanted = math.ceil(ready * queued / TARGET_QUEUED)
        # Within a tenth of the target nothing changes.
        if abs(queued / TARGET_QUEUED - 1) < 0.1:
            wanted = ready
        self._wanted = [(at, count) for at, count in self._wanted if time - at < STABILISATION]
        self._wanted.append((time, wanted))
        if wanted > ready:
            return min(wanted, 2 * ready, self._most)
        # Down to what was wanted most within five minutes, and little at a time.
        most = max(count for _, count in self._wanted)
        slowest = ready - max(1, ready // 100) if time % 60 < AUTOSCALER_PERIOD else ready
        return max(self._least, min(ready, max(most, slowest)))


def simulate(first_pods, clips_per_second, random):
    """Seconds, and at each of them: load, pods ready, mean queue, share of calls refused."""
    capacity = clips_per_second * WORKERS
    queue = numpy.zeros(first_pods)
    autoscaler = Autoscaler(first_pods)
    starting, recent, rows = [], [], []
    came = refused = 0
    for step in range(round(DURATION / STEP)):
        time = step * STEP
        # Turns: the same for each pod, but for the rest, and for the time at which they come.
        arrivals = random.poisson(
            load_share(time) * first_pods * capacity * STEP / len(queue), len(queue))
        served = random.poisson(capacity * STEP, len(queue))
        waiting = numpy.maximum(queue + arrivals - served, 0)
        over = numpy.maximum(waiting - MAX_QUEUED, 0)
        queue = waiting - over
        came += arrivals.sum()
        refused += over.sum()
        if step % round(1 / STEP) == 0:
            recent = [*recent, queue.mean()][-METRIC_WINDOW:]
            rows.append((time, load_share(time), len(queue), queue.mean(), refused / max(came, 1)))
            came = refused = 0
            ready = sum(count for at, count in starting if at <= time)
            starting = [(at, count) for at, count in starting if at > time]
            queue = numpy.append(queue, numpy.zeros(ready))
        if step and step % round(AUTOSCALER_PERIOD / STEP) == 0:
            coming = sum(count for _, count in starting)
            wanted = autoscaler.pods(time, len(queue), float(numpy.mean(recent)))
            if wanted > len(queue) + coming:
                starting.append((time + POD_START, wanted - len(queue) - coming))
            elif wanted < len(queue):
                queue = queue[:wanted]  # the rest drain: what waits there is answered there
    return numpy.array(rows)


def summary(pods, rows):
    crowded = rows[rows[:, 3] >= MAX_QUEUED / 2, 0]
    refusing = rows[rows[:, 4] > 0.01, 0]
    calm = crowded[-1] + 1 - RISE_AT if len(crowded) else 0
    return (pods, int(rows[:, 2].max()), rows[:, 3].max(), 100 * rows[:, 4].max(),
            len(refusing), calm)


def draw(results, out):
    plots.use_matplotlib()
    from matplotlib import pyplot
    figure, axes = pyplot.subplots(3, len(results), figsize=(4.5 * len(results), 7), sharex=True,
                                   squeeze=False)
    for column, (pods, rows) in zip(axes.T, results):
        column[0].set_title(f"{pods} pods at first")
        column[0].plot(rows[:, 0], rows[:, 2] / pods, color=palette.colour(0),
                       label="pods that are ready")
        column[0].plot(rows[:, 0], rows[:, 1], "--", color=palette.colour(1),
                       label="pods that the load keeps busy")
        column[1].plot(rows[:, 0], rows[:, 3], color=palette.colour(2), label="queue of a pod, mean")
        column[1].axhline(TARGET_QUEUED, linewidth=0.5, color="black")
        column[2].plot(rows[:, 0], 100 * rows[:, 4], color=palette.colour(3), label="refused, %")
        column[2].set_xlabel("seconds")
        for axis in column:
            axis.set_ylim(bottom=0)
            axis.legend(fontsize=7)
    axes[0][0].set_ylabel("times the first")
    figure.tight_layout()
    figure.savefig(out, dpi=80)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--clips-per-second", type=float, default=567, help="of a worker, measured")
    parser.add_argument("--pods", type=int, nargs="+", default=[10, 100, 1000])
    parser.add_argument("--out", help="a picture")
    arguments = parser.parse_args()
    print("| pods | most | longest mean queue | most refused, % | seconds with refusals | "
          "seconds until it is calm |\n|---|---|---|---|---|---|")
    results = []
    for pods in arguments.pods:
        rows = simulate(pods, arguments.clips_per_second, numpy.random.default_rng(1))
        results.append((pods, rows))
        print("| {} | {} | {:.0f} | {:.0f} | {} | {:.0f} |".format(*summary(pods, rows)))
    if arguments.out:
        draw(results, arguments.out)


if __name__ == "__main__":
    main()
