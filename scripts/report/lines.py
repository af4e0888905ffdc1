"""Lines over labelled axes: label sweeps and training curves."""

import math

from report import palette

SIZE = (7.9, 5.4)  # inches


def running_mean(values, window):
    """Each value's mean with those up to half a window away. Gaps (None, NaN) stay gaps."""
    reach = window // 2
    smooth = []
    for index, value in enumerate(values):
        near = [v for v in values[max(0, index - reach):index + reach + 1] if math.isfinite(v)]
        smooth.append(sum(near) / len(near) if math.isfinite(value) else math.nan)
    return smooth


def draw(plot):
    from matplotlib import pyplot
    figure, axes = pyplot.subplots(figsize=SIZE)
    for index, series in enumerate(plot["series"]):
        _draw_series(axes, plot, index, series)
    for x in plot["marked_x"]:
        axes.axvline(x, color=palette.MARK, linestyle=":", linewidth=1)
    if plot["log_y"]:
        axes.set_yscale("log")
    if plot["y_range"] is not None:
        axes.set_ylim(*plot["y_range"])
    axes.set_title(plot["title"])
    axes.set_xlabel(plot["x_label"])
    axes.set_ylabel(plot["y_label"])
    axes.grid(color=palette.GRID, linewidth=0.8)
    axes.legend(loc="upper left", bbox_to_anchor=(1, 1))
    return figure, ""


def _draw_series(axes, plot, index, series):
    # A logarithmic axis has no place for 0 and below: these leave gaps too.
    y = [math.nan if v is None or (plot["log_y"] and v <= 0) else v for v in series["y"]]
    style = {"color": palette.colour(index), "linestyle": palette.dash(index), "linewidth": 1.8,
             "label": series["name"]}
    if plot["y_range"] is not None:  # a line that leaves the range runs along its edge
        low, high = plot["y_range"]
        y = [min(max(v, low), high) if math.isfinite(v) else v for v in y]
    if plot["markers"]:
        style.update(marker=palette.marker(index), markersize=5, markeredgecolor="white",
                     markeredgewidth=0.6)
    if plot["running_mean"] > 1:
        axes.plot(series["x"], y, color=palette.colour(index), linewidth=1, alpha=0.3)
        y = running_mean(y, plot["running_mean"])
    axes.plot(series["x"], y, clip_on=False, **style)
