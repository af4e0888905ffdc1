"""Film strips of two people: moments of a motion side by side, to look at."""

import numpy
from PIL import Image, ImageDraw

MOMENTS, WIDTH, HEIGHT = 12, 150, 190
PIXELS_PER_METRE = 70
DEPTH_UP = 0.18               # the share of the depth that shows
COLOURS = ((0, 114, 178), (213, 94, 0))   # leader, follower


def _axes(people):
    """(across, deep): the picture's directions along the floor; the pair stands across."""
    line = (people[1][:, 0] - people[0][:, 0]).mean(axis=0) * [1, 0, 1]
    length = numpy.linalg.norm(line)
    across = line / length if length > 0.2 else numpy.array([1.0, 0.0, 0.0])
    return across, numpy.array([-across[2], 0, across[0]])


def write(leader, follower, parents, rate, path):
    """Writes a PNG of MOMENTS poses of both people."""
    people = leader, follower
    across, deep = _axes(people)
    picture = Image.new("RGB", (WIDTH * MOMENTS, HEIGHT), "white")
    draw = ImageDraw.Draw(picture)
    for i, t in enumerate(numpy.linspace(0, len(leader) - 1, MOMENTS).round().astype(int)):
        middle = (leader[t, 0] + follower[t, 0]) / 2
        for person, colour in zip(people, COLOURS):
            offset = person[t] - middle
            x = WIDTH * (i + 0.5) + PIXELS_PER_METRE * (offset @ across)
            y = HEIGHT - 25 - PIXELS_PER_METRE * (person[t, :, 1] + DEPTH_UP * (offset @ deep))
            for joint, parent in enumerate(parents):
                if parent >= 0:
                    draw.line([(x[joint], y[joint]), (x[parent], y[parent])], fill=colour, width=2)
        draw.text((WIDTH * i + 5, HEIGHT - 14), f"{t / rate:.2f}", fill="black")
    path.parent.mkdir(parents=True, exist_ok=True)
    picture.save(path)
