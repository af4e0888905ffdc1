"""The takes of the salsa couple: read, glitches cut out, brought to 30 frames a second.

A take is what both people do between the start and the end of a recording. All positions are metres,
y up, in one world for both people.
"""

import dataclasses

import numpy

LEAD, FOLLOW = "lead", "follow"
FRAME_RATE_HZ = 30
SMOOTHING_SECONDS = 1 / 60   # removes what frames between two output frames would alias
FEWEST_SECONDS = 2.0         # shorter stretches between glitches teach nothing
MENDED_SECONDS = 0.1         # shorter glitches are bridged, longer ones cut the take
STANDING_SHARE = 5           # percent of the frames in which a toe is taken to stand on the floor
STANDING_TOE_METRES = 0.02   # a toe joint of a standing foot above the floor

# The head of these takes is wrong in the recording. It is rebuilt from the trunk.
TAKES_WITHOUT_HEAD = ("06", "07")
HEAD_JOINTS = ("Head", "HeadTop")
# The first seconds of a take that do not show the couple as they stand.
SKIPPED_SECONDS = {"10": 2.0}


class TakesError(Exception):
    """A file that does not hold what a take needs; the message names the file and the field."""


@dataclasses.dataclass(frozen=True)
class Take:
    """Both people from frame to frame. `lead` and `follow`: [frames, joints, 3]."""
    name: str
    lead: numpy.ndarray
    follow: numpy.ndarray
    joints: tuple
    frame_rate_hz: float

    def joint(self, name):
        return self.joints.index(name)

    @property
    def frames(self):
        return len(self.lead)


def _array(archive, path, key, shape):
    if key not in archive:
        raise TakesError(f"{path}: {key}: expected an array of shape {shape}, got none")
    array = archive[key]
    if array.ndim != 3 or array.shape[1:] != shape[1:]:
        raise TakesError(f"{path}: {key}: expected shape {shape}, got {array.shape}")
    if not numpy.isfinite(array).all():
        frame = int(numpy.argwhere(~numpy.isfinite(array))[0][0])
        raise TakesError(f"{path}: {key}: expected finite numbers, got another in frame {frame}")
    return array.astype(float)


def read_archive(path):
    """Every take of an .npz file with the arrays `lead_NN`, `follow_NN`, `joints` and `fps`."""
    with numpy.load(path) as archive:
        for key in ("joints", "fps"):
            if key not in archive:
                raise TakesError(f"{path}: {key}: expected an array, got none")
        joints = tuple(str(name) for name in archive["joints"])
        rate = float(archive["fps"])
        takes = []
        for key in sorted(archive.files):
            if not key.startswith(LEAD + "_"):
                continue
            name = key[len(LEAD) + 1:]
            shape = ("frames", len(joints), 3)
            people = [_array(archive, path, f"{person}_{name}", shape) for person in (LEAD, FOLLOW)]
            if len(people[0]) != len(people[1]):
                raise TakesError(f"{path}: follow_{name}: expected {len(people[0])} frames, as its "
                                 f"lead has, got {len(people[1])}")
            takes.append(Take(name, *people, joints, rate))
    if not takes:
        raise TakesError(f"{path}: lead_NN: expected at least one take, got none")
    return takes


def read_glitches(path):
    """Frames to leave out: {take: [(first, last)]}, both inclusive, of either person."""
    glitches = {}
    with open(path, encoding="utf-8") as file:
        rows = file.read().splitlines()[1:]
    for number, row in enumerate(rows, start=2):
        try:
            person, frames = row.split("\t")
            spans = [tuple(int(frame) for frame in span.split("-")) for span in frames.split(",")]
            if not all(len(span) == 2 for span in spans):
                raise ValueError
        except ValueError:
            raise TakesError(f"{path}: line {number}: expected PERSON_NN, a tab and FIRST-LAST,..., "
                             f"got {row!r}") from None
        glitches.setdefault(person.split("_")[-1], []).extend(spans)
    return glitches


def _bridge(positions, first, last):
    """Replaces frames first to last by the cubic through two frames before and two after them."""
    around = numpy.array([first - 2, first - 1, last + 1, last + 2])
    inside = numpy.arange(first, last + 1)
    flat = positions.reshape(len(positions), -1)
    # About the middle, because a cubic in frame numbers would lose digits.
    middle = (first + last) / 2
    cubic = numpy.polyfit(around - middle, flat[around], 3)
    flat[inside] = numpy.vander(inside - middle, 4) @ cubic


def _mend(take, glitches):
    """(the take with short glitches bridged, the other glitches)."""
    lead, follow, left = take.lead.copy(), take.follow.copy(), []
    for first, last in glitches:
        # A listed frame is one of a sudden acceleration: its neighbours are wrong as well.
        first, last = first - 1, last + 1
        is_short = last + 1 - first <= MENDED_SECONDS * take.frame_rate_hz
        if is_short and first >= 2 and last + 2 < take.frames:
            _bridge(lead, first, last)
            _bridge(follow, first, last)
        else:
            left.append((first, last))
    return dataclasses.replace(take, lead=lead, follow=follow), left


def _clean_stretches(take, glitches):
    """(begin, end) of the frames between glitches, end exclusive."""
    is_clean = numpy.ones(take.frames, dtype=bool)
    is_clean[:round(SKIPPED_SECONDS.get(take.name, 0) * take.frame_rate_hz)] = False
    for first, last in glitches:
        is_clean[max(0, first):last + 1] = False
    edges = numpy.flatnonzero(numpy.diff(numpy.concatenate([[0], is_clean.astype(int), [0]])))
    return [(begin, end) for begin, end in edges.reshape(-1, 2)
            if end - begin >= FEWEST_SECONDS * take.frame_rate_hz]


def smooth(values, deviation):
    """A Gaussian over the first axis; the ends repeat. `deviation`: frames."""
    reach = int(numpy.ceil(3 * deviation))
    if reach < 1:
        return values
    weights = numpy.exp(-0.5 * (numpy.arange(-reach, reach + 1) / deviation) ** 2)
    weights /= weights.sum()
    padding = [(reach, reach)] + [(0, 0)] * (values.ndim - 1)
    padded = numpy.pad(values, padding, mode="edge")
    return sum(weight * padded[i:i + len(values)] for i, weight in enumerate(weights))


def _resample(positions, rate):
    """Smoothed and sampled at FRAME_RATE_HZ."""
    smoothed = smooth(positions, SMOOTHING_SECONDS * rate)
    count = int((len(positions) - 1) / rate * FRAME_RATE_HZ) + 1
    at = numpy.arange(count) * rate / FRAME_RATE_HZ
    before = numpy.minimum(at.astype(int), len(positions) - 2)
    share = (at - before)[:, None, None]
    return (1 - share) * smoothed[before] + share * smoothed[before + 1]


def _floor_height(take, people):
    """The height of the floor under a person, from the toes of the feet that stand."""
    toes = [take.joint(name) for name in take.joints if name.endswith("Toe")]
    lowest = people[:, toes, 1].min(axis=1)
    return numpy.percentile(lowest, STANDING_SHARE) - STANDING_TOE_METRES


def _trunk_frame(take, positions):
    """Origin and axes of the upper trunk of every frame: [frames, 3], [frames, 3, 3]."""
    neck = positions[:, take.joint("Neck")]
    up = neck - positions[:, take.joint("Spine")]
    across = positions[:, take.joint("LShoulder")] - positions[:, take.joint("RShoulder")]
    up = up / numpy.linalg.norm(up, axis=1, keepdims=True)
    ahead = numpy.cross(across, up)
    ahead = ahead / numpy.linalg.norm(ahead, axis=1, keepdims=True)
    return neck, numpy.stack([numpy.cross(up, ahead), up, ahead], axis=1)


def _head_in_trunk(take, positions):
    """The mean position of the head's joints in the trunk's frame: [joints, 3]."""
    neck, axes = _trunk_frame(take, positions)
    joints = [take.joint(name) for name in HEAD_JOINTS]
    return numpy.einsum("tij,tkj->tki", axes, positions[:, joints] - neck[:, None]).mean(axis=0)


def _with_head(take, positions, head):
    neck, axes = _trunk_frame(take, positions)
    positions = positions.copy()
    joints = [take.joint(name) for name in HEAD_JOINTS]
    positions[:, joints] = neck[:, None] + numpy.einsum("tij,ki->tkj", axes, head)
    return positions


def prepare(takes, glitches):
    """Stretches without glitches, at 30 Hz, on a floor at y = 0, with whole heads.

    A stretch is a Take named `NN` or, after the first of its take, `NN_2`, `NN_3`, ...
    """
    sound = [take for take in takes if take.name not in TAKES_WITHOUT_HEAD]
    heads = {person: numpy.mean([_head_in_trunk(take, getattr(take, person)) for take in sound],
                                axis=0) if sound else None for person in (LEAD, FOLLOW)}
    prepared = []
    for take in takes:
        take, long_glitches = _mend(take, glitches.get(take.name, []))
        people = {}
        for person in (LEAD, FOLLOW):
            positions = getattr(take, person).copy()
            positions[..., 1] -= _floor_height(take, positions)
            if take.name in TAKES_WITHOUT_HEAD and heads[person] is not None:
                positions = _with_head(take, positions, heads[person])
            people[person] = positions
        for i, (begin, end) in enumerate(_clean_stretches(take, long_glitches)):
            name = take.name if i == 0 else f"{take.name}_{i + 1}"
            lead, follow = (_resample(people[person][begin:end], take.frame_rate_hz)
                            for person in (LEAD, FOLLOW))
            prepared.append(Take(name, lead, follow, take.joints, FRAME_RATE_HZ))
    return prepared
