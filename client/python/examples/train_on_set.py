"""Learns from a data set of `duet batch` with NumPy: train_on_set.py SET

    duet batch samples --recipe recipes/mixes.textproto --out set
    python3 -m duet_motion.sets split set --test 0.3
    python3 examples/train_on_set.py set

Trains a linear classifier to recognise, from the follower's motion, which class was requested, and
prints what it recognises for leaders that it has not seen.
"""

import argparse

import numpy

import duet_motion as duet

MOMENTS = 8  # frames of a motion that the classifier sees
PENALTY = 10.0  # of large weights, because there are more numbers than items


def features(items):
    """The follower's joints at a few moments, seen from the leader's first pose."""
    rows = []
    for leader, follower in (item.pair for item in items):
        moments = numpy.linspace(0, len(follower) - 1, MOMENTS).round().astype(int)
        rows.append((follower[moments] - leader[0].mean(axis=0)).ravel())
    return numpy.array(rows)


def requested(items):
    """The class of the largest weight of each item, as a number."""
    return numpy.array([item.weights.max(axis=0).argmax() for item in items])


def fit(inputs, outputs):
    """Least squares with a penalty; returns the function that it finds."""
    mean, scale = inputs.mean(axis=0), inputs.std(axis=0) + 1e-6

    def standardised(rows):
        return numpy.hstack([(rows - mean) / scale, numpy.ones((len(rows), 1))])
    seen = standardised(inputs)
    weights = numpy.linalg.solve(seen.T @ seen + PENALTY * numpy.eye(seen.shape[1]),
                                 seen.T @ outputs)
    return lambda rows: standardised(rows) @ weights


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("set", help="a data set with splits")
    path = parser.parse_args().set
    try:
        train, test = (duet.read_set(path, split=split) for split in ("train", "test"))
    except duet.DataSetError as error:
        parser.error(f"{error}; use duet_motion.sets split --test SHARE")
    if not train or not test:
        parser.error(f"set: expected items in the splits train and test, got {len(train)} and "
                     f"{len(test)}; add leaders, or another share")
    classes = train.interaction_classes
    classify = fit(features(train), numpy.eye(len(classes))[requested(train)])
    counts = numpy.zeros((len(classes), len(classes)), dtype=int)
    for wanted, scores in zip(requested(test), classify(features(test))):
        counts[wanted, scores.argmax()] += 1
    print("requested, and how often each class was recognised: " + ", ".join(classes))
    for name, row in zip(classes, counts):
        print(f"{name:>16} " + " ".join(f"{count:4}" for count in row))
    right, total = counts.trace(), counts.sum()
    seen, unseen = (len({record["leader_sha256"] for record in items.records}) for items in (train, test))
    print(f"trained on {len(train)} items, leaders: {seen}")
    print(f"{right} of {total} test items recognised ({100 * right / total:.0f} %), leaders that were "
          f"not seen: {unseen}; chance is {100 / len(classes):.0f} %")


if __name__ == "__main__":
    main()
