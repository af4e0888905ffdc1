"""Maps of a latent space: t-SNE of the feature vectors that duet-eval latent writes."""

from report import palette

SIZE = (7.0, 5.0)  # inches


def embed(features, perplexity, seed):
    """Maps feature vectors to the plane. Shapes: [samples][features] to [samples][2].

    The perplexity is lowered to what the number of samples allows.
    """
    import numpy
    from sklearn.manifold import TSNE
    features = numpy.asarray(features, dtype=float)
    perplexity = min(perplexity, (len(features) - 1) / 3)
    return TSNE(n_components=2, perplexity=perplexity, init="pca", learning_rate="auto",
                random_state=seed % 2**32).fit_transform(features)


def purity(points, classes):
    """The share of points whose nearest neighbour has the same class."""
    import numpy
    from sklearn.neighbors import NearestNeighbors
    nearest = NearestNeighbors(n_neighbors=1).fit(points).kneighbors(return_distance=False)[:, 0]
    classes = numpy.asarray(classes)
    return float((classes[nearest] == classes).mean())


def draw(plot):
    from matplotlib import pyplot
    points = embed(plot["features"], plot["perplexity"], plot["seed"])
    figure, axes = pyplot.subplots(figsize=SIZE)
    for index, name in enumerate(plot["class_names"]):
        chosen = [i for i, c in enumerate(plot["classes"]) if c == index]
        axes.scatter(points[chosen, 0], points[chosen, 1], s=34, alpha=0.8, linewidths=0.6,
                     color=palette.colour(index), marker=palette.marker(index),
                     edgecolors="white", label=name)
    axes.set_title(plot["title"])
    axes.set_aspect("equal", adjustable="datalim")  # only distances have a meaning
    axes.set_xticks([])
    axes.set_yticks([])
    for spine in axes.spines.values():
        spine.set_visible(True)
    axes.legend(loc="upper left", bbox_to_anchor=(1, 1))
    share = purity(points, plot["classes"])
    return figure, f"In the map, the nearest neighbour of {share:.3f} of the clips has their class."
