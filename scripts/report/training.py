"""Sections about runs of duet-train, from their log.csv: training curves and validation errors."""

import csv
import datetime
import math
from pathlib import Path

LOSSES = {"generator": "generator, weighted sum", "reconstruction": "reconstruction",
          "bone": "bone lengths", "continuity": "continuity", "adversarial": "adversarial",
          "discriminator": "discriminator"}
SMOOTHING = "Strong lines are means over nine epochs, faint ones the epochs."
RUNNING_MEAN = 9  # epochs
VALIDATION = "validation_afd"
# 1 in the epochs whose losses are scores of whole answers, on another scale than before; only one of
# these epochs can become the checkpoint.
SCORED = "whole_answers"


class LogError(ValueError):
    """A log that cannot be read; the message names file, line and column."""


class Log:
    """A run's log.csv: a list of numbers per column, NaN where there is none."""

    def __init__(self, columns):
        self.columns = columns
        self.epochs = columns["epoch"]

    def find(self, column):
        """The values of a column; None if the log has no finite one."""
        values = self.columns.get(column, [])
        return values if any(math.isfinite(value) for value in values) else None


def read_log(file):
    try:
        with open(file, newline="", encoding="utf-8") as text:
            lines = list(csv.reader(text))
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise LogError(f"{file}: {error}") from error
    names = lines[0] if lines else []
    if "epoch" not in names or len(set(names)) != len(names) or "" in names:
        raise LogError(f"{file}:1: expected distinct column names, one of them epoch, "
                       f"got {','.join(names)!r:.80}")
    columns = {name: [] for name in names}
    for number, line in enumerate(lines[1:], start=2):
        _add_line(columns, names, line, f"{file}:{number}")
    if not columns["epoch"]:
        raise LogError(f"{file}:2: expected a line for each epoch, got none")
    return Log(columns)


def _add_line(columns, names, line, where):
    if len(line) != len(names):
        raise LogError(f"{where}: expected {len(names)} fields, got {len(line)}")
    for name, field in zip(names, line):
        try:
            columns[name].append(float(field) if field else math.nan)
        except ValueError:
            raise LogError(f"{where}: {name}: expected a number, got {field!r:.40}") from None
    epochs = columns["epoch"]
    if not math.isfinite(epochs[-1]) or (len(epochs) > 1 and epochs[-1] <= epochs[-2]):
        raise LogError(f"{where}: epoch: expected a later one, got {epochs[-1]:g}")


def parse_run(text):
    """Splits "[NAME=]DIR"; without a name, the last part of the folder is the name."""
    name, equals, folder = text.partition("=")
    if not equals:
        name, folder = Path(text).resolve().name, text
    if not name or not folder:
        raise LogError(f"--run: expected [NAME=]DIR, got {text!r}")
    return name, Path(folder)


def _number(value):
    """A number as JSON holds it: a missing one is null."""
    return value if value is not None and math.isfinite(value) else None


def _table(title, columns, rows, decimals, best="none"):
    return {"title": title, "columns": columns, "notes": [], "decimals": decimals, "best": best,
            "rows": [{"name": name, "printed": False, "values": [_number(v) for v in values]}
                     for name, values in rows]}


def _section(section_id, title, text, command):
    return {"format_version": 1, "id": section_id, "title": title, "text": [text], "tables": [],
            "figures": [], "settings": [], "command": command,
            "date": datetime.datetime.now(datetime.timezone.utc).date().isoformat()}


def _line_plot(title, y_label, series, **more):
    return {"kind": "lines", "title": title, "x_label": "epoch", "y_label": y_label,
            "series": series, "y_range": None, "log_y": False, "markers": False, "marked_x": [],
            "running_mean": 1, **more}


def _series(name, log, values):
    # Epochs without a value are no gap: not every epoch is validated.
    points = [(x, y) for x, y in zip(log.epochs, values) if not math.isnan(y)]
    return {"name": name, "x": [x for x, _ in points], "y": [_number(y) for _, y in points]}


def _loss(log, column):
    """The values of a loss; None if it was off."""
    values = log.find(column)
    return values if values and any(abs(value) > 0 for value in values) else None


def _least(values):
    """The index of the smallest value."""
    return min((i for i, v in enumerate(values) if not math.isnan(v)), key=values.__getitem__)


def _scored_from(log):
    """The first epoch that scored whole answers after one that did not; None without a change."""
    scored = log.columns.get(SCORED, [])
    changes = [epoch for epoch, before, now in zip(log.epochs[1:], scored, scored[1:])
               if not before and now]
    return changes[0] if changes else None


def _loss_figures(section_id, runs):
    smooth = {"log_y": True, "running_mean": RUNNING_MEAN}
    label = "mean loss of an epoch (logarithmic)"
    if len(runs) == 1:
        name, log = runs[0]
        series = [_series(text, log, _loss(log, column)) for column, text in LOSSES.items()
                  if _loss(log, column)]
        caption, change = f"Every loss of the run by epoch. {SMOOTHING}", _scored_from(log)
        if change is not None:
            caption += (" From the dotted line on, the losses are scores of whole answers, on "
                        "another scale than before.")
        yield (f"{section_id}_losses", caption,
               _line_plot(f"Losses of {name}", label, series, **smooth,
                          marked_x=[] if change is None else [change]))
        return
    for column, text in LOSSES.items():
        series = [_series(name, log, _loss(log, column)) for name, log in runs
                  if _loss(log, column)]
        yield (f"{section_id}_{column}", f"Loss by epoch: {text}; one line a run. {SMOOTHING}",
               _line_plot(f"Loss: {text}", label, series, **smooth))


def _best(log):
    """The index of the epoch with the least validation error among those that may be kept."""
    errors = log.find(VALIDATION)
    scored = log.columns.get(SCORED, [])
    if any(scored):
        errors = [error if now else math.nan for error, now in zip(errors, scored)]
    return _least(errors)


def _validation_figure(section_id, runs):
    validated = [(name, log) for name, log in runs if log.find(VALIDATION)]
    one = len(runs) == 1
    marked = [log.epochs[_best(log)] for _, log in validated] if one else []
    caption = ("Average frame distance on clips that the run held back, by epoch"
               + ("; the dotted line marks the least." if one else "."))
    plot = _line_plot("Average frame distance on the validation clips", "average frame distance",
                      [_series(name, log, log.find(VALIDATION)) for name, log in validated],
                      marked_x=marked)
    return f"{section_id}_{VALIDATION}", caption, plot


def _curve_tables(runs):
    took, reached = [], []
    for name, log in runs:
        seconds, validation = log.find("seconds"), log.find(VALIDATION)
        best = _best(log) if validation else None
        last = [log.find(column)[-1] if log.find(column) else None
                for column in ("reconstruction", "bone")]
        took.append((name, [log.epochs[-1],
                            sum(s for s in seconds if not math.isnan(s)) if seconds else None,
                            log.epochs[best] if validation else None]))
        reached.append((name, last + [validation[best] if validation else None]))
    return [_table("What the runs took",
                   ["epochs", "seconds", "epoch of the least validation error"], took, 0),
            _table("What the runs reached",
                   ["reconstruction, last epoch", "bone lengths, last epoch",
                    "validation error, least"], reached, 4)]


def curves(section_id, title, runs):
    """The section on training curves. `runs`: (name, Log) pairs.

    One run has its losses in one figure; several have a figure for each loss with a line for each
    run. Losses that are zero throughout were off and are left out.
    """
    command = "scripts/training_results.py curves --run " + " ".join(f"{n}=RUN" for n, _ in runs)
    section = _section(section_id, title,
                       "What duet-train logged. Losses are means over an epoch's batches, before "
                       "their weights, but for the generator's weighted sum; a loss that was "
                       "switched off is not shown.", command)
    section["settings"] = [{"name": "runs", "value": str(len(runs))}]
    section["tables"] = _curve_tables(runs)
    for name, caption, plot in [*_loss_figures(section_id, runs),
                                _validation_figure(section_id, runs)]:
        if plot["series"]:
            section["figures"].append({"name": name, "caption": caption, "plot": plot})
    return section


def _validation_table(title, column, configurations):
    names = list(dict.fromkeys(name for _, logs in configurations for name in logs))
    rows = []
    for configuration, logs in configurations:
        columns = [logs[name].find(column) if name in logs else None for name in names]
        values = [found[-1] if found else math.nan for found in columns]
        rows.append((configuration, values + [sum(values) / len(values)]))
    return _table(title, names + ["mean"], rows, 4, best="lowest")


def validation(section_id, title, configurations):
    """The section that compares settings. `configurations`: (name, {left-out subject: Log})."""
    command = ("scripts/training_results.py validation --runs "
               + " ".join(f"{name}=RUNS" for name, _ in configurations))
    section = _section(section_id, title,
                       "Average frame distance in metres after the last epoch, on validation "
                       "subjects. A column is the subject that a run left out altogether; another "
                       "one validated it. Lower is better; what differs less than two seeds do "
                       "means nothing.", command)
    section["tables"] = [
        _validation_table("Without a start: afd, metres", VALIDATION, configurations),
        _validation_table("Told the first pose: afd, metres", VALIDATION + "_pose",
                          configurations)]
    return section
