"""Synthesises a reaction to a motion file: react.py LEADER CLASS=WEIGHT... --out REACTION

    python3 examples/react.py samples/hug.bvh hug=1 push=0.5 --out mix.bvh --out mix.csv
"""

import argparse
import sys

import duet_motion as duet


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("leader", help="a motion file: .bvh, .glb, .csv, ...")
    parser.add_argument("labels", nargs="+", help="CLASS=WEIGHT: 1 requests a class, -1 avoids it")
    parser.add_argument("--out", action="append", required=True, help="a file to write; repeatable")
    parser.add_argument("--server", help="host:port (default: DUET_SERVER, or localhost:50051)")
    parser.add_argument("--seed", type=int, default=0, help="selects one of many answers")
    options = parser.parse_args()

    labels = {name: float(weight) for name, _, weight in
              (label.partition("=") for label in options.labels)}
    try:
        leader = duet.read_motion(options.leader)
        with duet.Client(options.server) as client:
            result = client.synthesize(leader, labels, seed=options.seed)
    except duet.InvalidRequestError as error:
        for violation in error.violations:
            print(f"{violation.field}: {violation.description}", file=sys.stderr)
        return 42
    for path in options.out:
        duet.write_motion(path, result.leader, result.follower)
    print(f"{result.model_name}@{result.model_version}: {result.follower!r}, unfamiliarity "
          f"{result.unfamiliarity or 0:.2f}, {result.timings.total:.2f} s")
    return 0


if __name__ == "__main__":
    sys.exit(main())
