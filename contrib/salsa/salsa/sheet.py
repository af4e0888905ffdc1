"""Contact sheets: moments of every stretch of a class, to check the rules by eye."""

import numpy

from salsa.moves import spans

MOMENTS = 8
ROWS = 12             # of a sheet; the stretches are spread evenly over all takes
REACH_METRES = 1.0    # from the middle of the couple to the edge of a picture
DEPTH_UP = 0.35       # the share of the depth that shows
INCHES = 1.25
COLOURS = {"leader": "#0072B2", "follower": "#D55E00"}


def _project(points, middle):
    """Seen from the front and above: [..., 3] to [..., 2]."""
    across = points[..., 0] - middle[0]
    return numpy.stack([across, points[..., 1] - DEPTH_UP * (points[..., 2] - middle[2])], axis=-1)


def _moments(begin, end):
    return [round(begin + (end - 1 - begin) * i / (MOMENTS - 1)) for i in range(MOMENTS)]


def _draw(axes, take, parents, frame):
    from matplotlib.collections import LineCollection
    people = {"leader": take.lead[frame], "follower": take.follow[frame]}
    middle = (people["leader"][0] + people["follower"][0]) / 2
    for person, pose in people.items():
        flat = _project(pose, middle)
        bones = [[flat[parent], flat[joint]] for joint, parent in enumerate(parents) if parent >= 0]
        colour = COLOURS[person]
        axes.add_collection(LineCollection(bones, colors=colour, linewidths=1.6))
        # The right hand, so that sides can be told apart.
        axes.plot(*flat[take.joint("RWrist")], "o", color=colour, markersize=3)
    axes.set_xlim(-REACH_METRES, REACH_METRES)
    axes.set_ylim(-0.35, 2 * REACH_METRES - 0.2)
    axes.set_aspect("equal")
    axes.axis("off")


def draw(takes, parents, name, path):
    """Writes the sheet of a class; returns how many stretches it has in all."""
    from matplotlib import pyplot
    found = [(take, begin, end) for take in takes for one, begin, end in spans(take) if one == name]
    rows = [found[round(i * (len(found) - 1) / (min(ROWS, len(found)) - 1 or 1))]
            for i in range(min(ROWS, len(found)))]
    figure, grid = pyplot.subplots(max(1, len(rows)), MOMENTS, squeeze=False,
                                   figsize=(INCHES * MOMENTS, INCHES * max(1, len(rows))))
    for axes in grid.flat:
        axes.axis("off")
    for row, (take, begin, end) in zip(grid, rows):
        for axes, frame in zip(row, _moments(begin, end)):
            _draw(axes, take, parents, frame)
        rate = take.frame_rate_hz
        row[0].set_title(f"{take.name}: {begin / rate:.1f} to {end / rate:.1f} s", fontsize=6,
                         loc="left")
    figure.suptitle(f"{name}: {len(rows)} of {len(found)}", fontsize=8)
    figure.subplots_adjust(left=0, right=1, bottom=0, top=0.96, wspace=0, hspace=0.12)
    figure.savefig(path, dpi=100)
    pyplot.close(figure)
    return len(found)
