"""Captures of everyday interactions, read from archives of joint positions.

Positions are metres, y up; the two people of a trial share one world.
"""

import csv
import dataclasses

import numpy

FRAME_RATE_HZ = 30
SHORTEST_SECONDS = 1.0        # a stretch between glitches that is shorter teaches nothing
LEFT_OUT = "left_out"         # the subject of the trials that measure a model
SMOOTHING_SECONDS = 1 / 60    # removes what frames between two output frames would alias


class CaptureError(Exception):
    """A file that does not hold what is needed; the message names the file and the field."""


@dataclasses.dataclass(frozen=True)
class Pair:
    """Two people, frame by frame at FRAME_RATE_HZ, and when each class holds.

    `people`: two arrays of [frames, joints, 3]. `leader`: the index of the one who leads.
    `spans`: [(class, begin, end)] in seconds. `subjects`: what an evaluation can leave out.
    """
    name: str
    people: tuple
    leader: int
    spans: tuple
    subjects: tuple

    @property
    def seconds(self):
        return len(self.people[0]) / FRAME_RATE_HZ


@dataclasses.dataclass(frozen=True)
class Archive:
    """An .npz file: `arrays` are [frames, joints, 3] by key, `parents` is -1 for the root."""
    path: str
    joints: tuple
    parents: tuple
    frame_rate_hz: float
    arrays: dict

    def people(self, *keys):
        """The arrays of `keys`, equally long."""
        for key in keys:
            if key not in self.arrays:
                raise CaptureError(f"{self.path}: {key}: expected an array, got none")
        counts = [len(self.arrays[key]) for key in keys]
        if len(set(counts)) > 1:
            raise CaptureError(f"{self.path}: {keys[1]}: expected {counts[0]} frames, as {keys[0]} "
                               f"has, got {counts[1]}")
        return tuple(self.arrays[key] for key in keys)


def read_archive(path):
    """The archive with the names `joints`, the indices `parents`, `fps`, and one array a person."""
    with numpy.load(path) as file:
        for key in ("joints", "parents", "fps"):
            if key not in file:
                raise CaptureError(f"{path}: {key}: expected an array, got none")
        joints = tuple(str(name) for name in file["joints"])
        arrays = {}
        for key in file.files:
            if key in ("joints", "parents", "fps"):
                continue
            array = file[key].astype(float)
            if array.ndim != 3 or array.shape[1:] != (len(joints), 3):
                raise CaptureError(f"{path}: {key}: expected shape (frames, {len(joints)}, 3), got "
                                   f"{array.shape}")
            if not numpy.isfinite(array).all():
                raise CaptureError(f"{path}: {key}: expected finite numbers, got others")
            arrays[key] = array
        return Archive(str(path), joints, tuple(int(parent) for parent in file["parents"]),
                       float(file["fps"]), arrays)


def _rows(path, columns):
    with open(path, encoding="utf-8", newline="") as file:
        for number, row in enumerate(csv.DictReader(file, delimiter="\t"), start=2):
            missing = [column for column in columns if not row.get(column)]
            if missing:
                raise CaptureError(f"{path}: line {number}: {missing[0]}: expected a value, got none")
            yield number, row


def read_glitches(path):
    """Frames to leave out: {key of the archive: [(first, last)]}, both inclusive."""
    glitches = {}
    for number, row in _rows(path, ("key", "first", "last")):
        try:
            span = int(row["first"]), int(row["last"])
        except ValueError:
            raise CaptureError(f"{path}: line {number}: expected the numbers of two frames, got "
                               f"{row['first']!r} and {row['last']!r}") from None
        glitches.setdefault(row["key"], []).append(span)
    return glitches


def read_stretches(path):
    """The classes of each trial: {trial: (leader, left out, [(class, begin, end)])}."""
    trials = {}
    for number, row in _rows(path, ("trial", "leader", "class", "from_seconds", "to_seconds")):
        if row["leader"] not in ("a", "b"):
            raise CaptureError(f"{path}: line {number}: leader: expected a or b, got "
                               f"{row['leader']!r}")
        try:
            span = row["class"], float(row["from_seconds"]), float(row["to_seconds"])
        except ValueError:
            raise CaptureError(f"{path}: line {number}: expected seconds, got "
                               f"{row['from_seconds']!r} and {row['to_seconds']!r}") from None
        trial = trials.setdefault(row["trial"],
                                  ("ab".index(row["leader"]), row["left_out"] == "yes", []))
        trial[2].append(span)
    return trials


def _smooth(values, deviation):
    """A Gaussian over the first axis; the ends repeat. `deviation`: frames."""
    reach = int(numpy.ceil(3 * deviation))
    weights = numpy.exp(-0.5 * (numpy.arange(-reach, reach + 1) / deviation) ** 2)
    weights /= weights.sum()
    padded = numpy.pad(values, [(reach, reach), (0, 0), (0, 0)], mode="edge")
    return sum(weight * padded[i:i + len(values)] for i, weight in enumerate(weights))


def resample(positions, rate):
    """[frames, joints, 3] of `rate` at FRAME_RATE_HZ."""
    if rate > FRAME_RATE_HZ:
        positions = _smooth(positions, SMOOTHING_SECONDS * rate)
    count = int((len(positions) - 1) / rate * FRAME_RATE_HZ + 1e-6) + 1
    at = numpy.arange(count) * rate / FRAME_RATE_HZ
    before = numpy.minimum(at.astype(int), len(positions) - 2)
    share = (at - before)[:, None, None]
    return (1 - share) * positions[before] + share * positions[before + 1]


def _clean_stretches(frames, glitches, shortest):
    """(begin, end) of the frames between glitches, end exclusive."""
    is_clean = numpy.ones(frames, dtype=bool)
    for first, last in glitches:
        is_clean[max(0, first):last + 1] = False
    edges = numpy.flatnonzero(numpy.diff(numpy.concatenate([[0], is_clean.astype(int), [0]])))
    return [(begin, end) for begin, end in edges.reshape(-1, 2) if end - begin >= shortest]


def _within(spans, begin, end):
    """The spans between two moments."""
    cut = [(name, max(first, begin), min(last, end)) for name, first, last in spans]
    return [span for span in cut if span[2] - span[1] >= SHORTEST_SECONDS]


def _pair(name, people, rate, leader, spans, subjects):
    """The frames from the first span to the last one."""
    begin, end = min(span[1] for span in spans), max(span[2] for span in spans)
    cut = slice(round(begin * rate), round(end * rate))
    return Pair(name, tuple(resample(person[cut], rate) for person in people), leader,
                tuple((label, first - begin, last - begin) for label, first, last in spans), subjects)


def pairs(archive, stretches, glitches):
    """Every stretch of a labelled trial without a glitch, as a Pair.

    A trial SS_TT is the arrays `a_SS_TT` and `b_SS_TT`, of which the second has the partner's
    subject, SS + 1.
    """
    found = []
    rate = archive.frame_rate_hz
    for trial, (leader, is_left_out, spans) in stretches.items():
        subject, take = trial.split("_")
        keys = f"a_{trial}", f"b_{int(subject) + 1}_{take}"
        people = archive.people(*keys)
        bad = [span for key in keys for span in glitches.get(key, [])]
        clean = _clean_stretches(len(people[0]), bad, SHORTEST_SECONDS * rate)
        for i, (begin, end) in enumerate(clean):
            held = _within(spans, begin / rate, end / rate)
            if held:
                found.append(_pair(trial if i == 0 else f"{trial}_{i + 1}", people, rate, leader,
                                   held, (trial, LEFT_OUT) if is_left_out else (trial,)))
    return found
