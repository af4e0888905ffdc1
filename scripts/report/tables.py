"""A table's cells as they are printed."""

MISSING = "-"


def rounded(value, decimals):
    if value is None:
        return MISSING
    text = f"{value:.{decimals}f}"
    return text[1:] if text.startswith("-") and not text.strip("-0.") else text  # never "-0.00"


def best_of(table, column):
    """The best value of a column among the rows measured here, as printed; None if none is best."""
    if table["best"] == "none":
        return None
    values = [row["values"][column] for row in table["rows"]
              if not row.get("printed") and row["values"][column] is not None]
    if not values:
        return None
    return rounded(min(values) if table["best"] == "lowest" else max(values), table["decimals"])


def cells(table):
    """For each row, a list of (text, is best). Every value printed like the best one is best."""
    best = [best_of(table, column) for column in range(len(table["columns"]))]
    rows = []
    for row in table["rows"]:
        texts = [rounded(value, table["decimals"]) for value in row["values"]]
        rows.append([(text, text == best[column] and not row.get("printed"))
                     for column, text in enumerate(texts)])
    return rows
