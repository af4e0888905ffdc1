"""Leader and follower as stick figures, seen from the side and a little from above."""

from report import palette

COLUMNS = 8        # moments of a strip
HOLD_SECONDS = 0.5  # of an animation's last frame
INCHES_PER_METRE = 0.8
MARGIN_METRES = 0.16
HEAD_METRES = 0.1
# The share of the depth that shows: people behind each other can be told apart.
DEPTH_ACROSS, DEPTH_UP = 0.18, 0.14


def project(pairs, root):
    """Every pose in the picture's plane, metres: [{"name", "leader", "follower"}], [T][J][2] each.

    The camera looks at the line on which the first pair starts, with its leader on the left.
    """
    import numpy
    first = pairs[0]
    across = numpy.subtract(first["follower"][0][root], first["leader"][0][root])
    across[1] = 0
    length = numpy.linalg.norm(across)
    across = across / length if length > 0 else numpy.array([1.0, 0, 0])
    away = numpy.cross([0, 1, 0], across)
    projected = []
    for pair in pairs:
        flat = {"name": pair["name"]}
        for person in ("leader", "follower"):
            world = numpy.asarray(pair[person], dtype=float)
            depth = world @ away
            flat[person] = numpy.stack([world @ across + DEPTH_ACROSS * depth,
                                        world[..., 1] + DEPTH_UP * depth], axis=-1)
        projected.append(flat)
    return projected


def bounds(pairs):
    """(left, right, bottom, top) of all poses, with a margin."""
    import numpy
    points = numpy.concatenate([pair[person].reshape(-1, 2) for pair in pairs
                                for person in ("leader", "follower")])
    low, high = points.min(axis=0) - MARGIN_METRES, points.max(axis=0) + MARGIN_METRES
    return low[0], high[0], low[1], high[1]


def moments(frames, columns=COLUMNS):
    """At most `columns` frames from the first to the last, evenly spread."""
    return sorted({round(i / (columns - 1) * (frames - 1)) for i in range(columns)})


def _body(axes, plot, pose, colours):
    from matplotlib.collections import LineCollection
    from matplotlib.patches import Circle
    # The far side first, so that the near one covers it.
    for side in ("left", "middle", "right"):
        bones = [[pose[bone["parent"]], pose[bone["child"]]] for bone in plot["bones"]
                 if bone["side"] == side]
        axes.add_collection(LineCollection(bones, colors=colours[side], linewidths=3,
                                           capstyle="round"))
    if plot["head"] is not None:
        axes.add_patch(Circle(pose[plot["head"]], HEAD_METRES, color=colours["middle"]))


def _pair(axes, plot, pair, frame, limits):
    _body(axes, plot, pair["leader"][frame], palette.LEADER)
    _body(axes, plot, pair["follower"][frame], palette.FOLLOWER)
    axes.set_xlim(limits[0], limits[1])
    axes.set_ylim(limits[2], limits[3])
    axes.set_aspect("equal")
    axes.set_xticks([])
    axes.set_yticks([])
    for side in ("left", "top", "right"):
        axes.spines[side].set_visible(False)
    axes.spines["bottom"].set_color("#d0d0d0")


def _panels(rows, columns, limits):
    from matplotlib import pyplot
    width = (limits[1] - limits[0]) * INCHES_PER_METRE
    height = (limits[3] - limits[2]) * INCHES_PER_METRE
    return pyplot.subplots(rows, columns, squeeze=False,
                           figsize=(columns * (width + 0.2), rows * (height + 0.4) + 0.4))


def draw(plot):
    """A strip: a row for each pair, a column for each moment."""
    pairs = project(plot["pairs"], plot["root"])
    limits = bounds(pairs)
    frames = moments(len(plot["pairs"][0]["leader"]))
    figure, axes = _panels(len(pairs), len(frames), limits)
    for row, pair in enumerate(pairs):
        for column, frame in enumerate(frames):
            _pair(axes[row][column], plot, pair, frame, limits)
            if row == len(pairs) - 1:
                axes[row][column].set_xlabel(f"{frame / plot['frame_rate_hz']:.1f} s")
        axes[row][0].set_title(pair["name"], fontweight="normal", fontsize=9)
    figure.suptitle(plot["title"], fontweight="bold", x=0.02, ha="left")
    return figure, ""


def animate(plot, file):
    """A panel for each pair, all moving at the true speed, as a GIF that starts over."""
    from matplotlib import pyplot
    from matplotlib.animation import FuncAnimation, PillowWriter
    pairs = project(plot["pairs"], plot["root"])
    limits = bounds(pairs)
    figure, axes = _panels(1, len(pairs), limits)
    figure.suptitle(plot["title"], fontweight="bold", x=0.02, ha="left")
    count, rate = len(plot["pairs"][0]["leader"]), plot["frame_rate_hz"]
    frames = list(range(count)) + [count - 1] * int(HOLD_SECONDS * rate)

    def show(frame):
        for panel, pair in zip(axes[0], pairs):
            panel.clear()
            _pair(panel, plot, pair, frame, limits)
            panel.set_title(pair["name"], fontweight="normal", fontsize=9)

    FuncAnimation(figure, show, frames, init_func=lambda: None).save(file, PillowWriter(fps=rate))
    pyplot.close(figure)
