"""Synthesises reactions of every class to every leader, into one NumPy file: augment.py OUT
LEADER...

    python3 examples/augment.py reactions.npz samples/*.bvh --seeds 8 --concurrency 4

For each (leader, class, seed) the file has a row in `leader`, `interaction_class` and `seed`, and
the positions [frames, joints, 3] in metres, y up, as `follower_ROW`. For data sets with a recipe,
filters and a journal, use `duet batch`.
"""

import argparse
import itertools

import duet_motion as duet
import numpy as np


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("out")
    parser.add_argument("leaders", nargs="+")
    parser.add_argument("--seeds", type=int, default=4)
    parser.add_argument("--concurrency", type=int, default=4)
    parser.add_argument("--server", help="host:port (default: DUET_SERVER, or localhost:50051)")
    options = parser.parse_args()

    leaders = [duet.read_motion(path) for path in options.leaders]
    rows, arrays = [], {}
    with duet.Client(options.server) as client:
        classes = client.get_model().model.interaction_classes
        asked = list(itertools.product(range(len(leaders)), classes, range(options.seeds)))
        requests = (duet.SynthesisRequest(leaders[index], {name: 1}, seed=seed, priority="bulk")
                    for index, name, seed in asked)
        outcomes = client.synthesize_many(requests, concurrency=options.concurrency)
        for (index, name, seed), outcome in zip(asked, outcomes):
            if outcome.result is None:
                print(f"{options.leaders[index]}, {name}, seed {seed}: {outcome.error}")
                continue
            arrays[f"follower_{len(rows)}"] = outcome.result.follower.positions
            rows.append((options.leaders[index], name, seed))
    names, kinds, seeds = zip(*rows)
    np.savez_compressed(options.out, leader=names, interaction_class=kinds, seed=seeds, **arrays)
    print(f"{len(rows)} of {len(asked)} reactions in {options.out}")


if __name__ == "__main__":
    main()
