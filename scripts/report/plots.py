"""Draws the figures of result sections with matplotlib."""

from report import latent

# An SVG keeps its text as text, and the same data gives the same file.
STYLE = {"svg.fonttype": "none", "svg.hashsalt": "duet", "font.size": 9, "axes.titlesize": 11,
         "axes.titleweight": "bold", "axes.titlelocation": "left", "axes.spines.top": False,
         "axes.spines.right": False, "axes.axisbelow": True, "legend.frameon": False}
DRAW = {"latent": latent.draw}


def use_matplotlib():
    """Prepares matplotlib for drawing without a display. Raises ImportError if it is missing."""
    import matplotlib  # a report without it still has its tables
    matplotlib.use("Agg")
    matplotlib.rcParams.update(STYLE)


def draw_plot(plot, folder, name):
    """Draws a plot. Returns the files that show it, and a sentence for its caption or "".

    Every still picture is written as <name>.svg and, at 300 dots an inch, as <name>.png.
    """
    from matplotlib import pyplot
    figure, remark = DRAW[plot["kind"]](plot)
    figure.savefig(folder / f"{name}.svg", bbox_inches="tight", metadata={"Date": None})
    figure.savefig(folder / f"{name}.png", bbox_inches="tight", dpi=300)
    pyplot.close(figure)
    return [f"{name}.svg"], remark
