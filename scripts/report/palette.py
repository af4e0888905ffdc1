"""The one palette of the evaluation's figures.

Classes differ in colour and in marker, so that a figure survives a print in grey.
"""

# Okabe and Ito 2008, without the yellow that is too faint on white paper.
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000", "#7F7F7F")
MARKERS = ("o", "s", "^", "D", "v", "p", "<", ">")

# Left, middle and right of a body. The left side is the paler one.
LEADER = {"left": "#7db3d8", "middle": COLOURS[0], "right": "#00588a"}
FOLLOWER = {"left": "#f0a46a", "middle": COLOURS[1], "right": "#a84a00"}


def colour(index):
    return COLOURS[index % len(COLOURS)]


def marker(index):
    return MARKERS[index % len(MARKERS)]
