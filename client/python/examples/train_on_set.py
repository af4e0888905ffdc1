"""Learns from a data set of `duet batch` with NumPy only: train_on_set.py SET --out PICTURE.svg

    duet batch samples --recipe recipes/mixes.textproto --out set
    python3 -m duet_motion.sets split set --test 0.3
    python3 -m duet_motion.sets table set
    python3 examples/train_on_set.py set --out learned.svg

Trains a linear classifier to recognise, from the follower's motion, which class was requested, and
draws what it recognises for leaders that it has not seen. It reads the set's tables and arrays as
docs/batch.md describes them, without this package.
"""

import argparse
import csv
import pathlib

import numpy

MOMENTS = 8  # frames of a motion that the classifier sees
PENALTY = 10.0  # of large weights, because there are more numbers than items


def read_items(folder, split):
    with open(folder / "items" / f"{split}.csv", encoding="utf-8", newline="") as table:
        return list(csv.DictReader(table))


def read_pair(folder, item):
    """float32 [2 people, frames, joints, 3] in metres, the leader first."""
    with open(folder / (item["shard"] or item["path"]), "rb") as file:
        file.seek(int(item["offset"]))
        return numpy.load(file)


def features(folder, items):
    """The follower's joints at a few moments, seen from the leader's first pose."""
    rows = []
    for item in items:
        leader, follower = read_pair(folder, item)
        moments = numpy.linspace(0, len(follower) - 1, MOMENTS).round().astype(int)
        rows.append((follower[moments] - leader[0].mean(axis=0)).ravel())
    return numpy.array(rows)


def targets(items, classes):
    """1 for the class of an item, 0 for the others."""
    return numpy.array([[item["interaction_class"] == name for name in classes] for item in items],
                       dtype=float)


def fit(inputs, outputs):
    """Least squares with a penalty; returns the function that it finds."""
    mean, scale = inputs.mean(axis=0), inputs.std(axis=0) + 1e-6

    def standardised(rows):
        return numpy.hstack([(rows - mean) / scale, numpy.ones((len(rows), 1))])
    seen = standardised(inputs)
    weights = numpy.linalg.solve(seen.T @ seen + PENALTY * numpy.eye(seen.shape[1]),
                                 seen.T @ outputs)
    return lambda rows: standardised(rows) @ weights


def picture(counts, classes, title):
    """An SVG of counts[requested, recognised]."""
    cell, left, top = 64, 150, 90
    size = cell * len(classes)
    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{left + size + 70}" '
             f'height="{top + size + 50}" font-family="sans-serif" font-size="13">',
             '<rect width="100%" height="100%" fill="white"/>',
             f'<text x="{left}" y="24" font-size="16">{title}</text>',
             f'<text x="{left}" y="{top + size + 34}">columns: recognised, rows: requested</text>']
    for row, name in enumerate(classes):
        parts.append(f'<text x="{left - 8}" y="{top + cell * row + 36}" text-anchor="end">{name}</text>')
        parts.append(f'<text x="{left + cell * row + 4}" y="{top - 10 - 16 * (row % 2)}">{name}</text>')
        for column, count in enumerate(counts[row]):
            share = count / max(counts[row].sum(), 1)
            x, y = left + cell * column, top + cell * row
            parts.append(f'<rect x="{x}" y="{y}" width="{cell - 2}" height="{cell - 2}" '
                         f'fill="#1f77b4" fill-opacity="{0.08 + 0.92 * share:.2f}"/>')
            parts.append(f'<text x="{x + cell / 2 - 1}" y="{y + 36}" text-anchor="middle" '
                         f'fill="{"white" if share > 0.5 else "black"}">{count}</text>')
    return "\n".join(parts) + "\n</svg>\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("set", type=pathlib.Path, help="a data set with tables")
    parser.add_argument("--out", type=pathlib.Path, required=True, help="the picture, .svg")
    options = parser.parse_args()

    train, test = read_items(options.set, "train"), read_items(options.set, "test")
    if not train or not test:
        parser.error(f"set: expected items in the splits train and test, got {len(train)} and "
                     f"{len(test)}; use duet_motion.sets split --test SHARE, with more leaders")
    classes = sorted({item["interaction_class"] for item in train})
    classify = fit(features(options.set, train), targets(train, classes))
    counts = numpy.zeros((len(classes), len(classes)), dtype=int)
    for item, scores in zip(test, classify(features(options.set, test))):
        if item["interaction_class"] in classes:
            counts[classes.index(item["interaction_class"]), scores.argmax()] += 1
    right, total = counts.trace(), counts.sum()
    title = f"{right} of {total} test items recognised ({100 * right / max(total, 1):.0f} %)"
    options.out.write_text(picture(counts, classes, title), encoding="utf-8")
    seen, unseen = (len({item["leader_sha256"] for item in items}) for items in (train, test))
    print(f"trained on {len(train)} items, leaders: {seen}")
    print(f"{title}, leaders that were not seen: {unseen}; chance is {100 / len(classes):.0f} %")
    print(f"wrote {options.out}")


if __name__ == "__main__":
    main()
