#!/usr/bin/env python3
"""Measures what each named number of the solver is worth: leaves it out, and compares every answer (README.md).

    contrib/studies/solver_numbers.py build/release --leaders samples --list
    contrib/studies/solver_numbers.py build/release --leaders samples --change steps.kRestSeconds=0 partner.kMostPush=1e9
"""

import argparse
import json
import os
import pathlib
import re
import shlex
import subprocess
import tempfile

import numpy as np

SOURCE = pathlib.Path(__file__).resolve().parents[2]
NUMBERS = re.compile(r"^constexpr (double|float|int) ([^;]+);", re.MULTILINE)
# Reads a number from the environment once, so that one program measures them all.
HEADER = """#include <cstdlib>
#include <cstring>
inline double StudiedNumber(const char* name, double value) {
  const char* const changes = std::getenv("DUET_STUDIED_NUMBERS");
  const char* const at = changes ? std::strstr(changes, name) : nullptr;
  return at ? std::atof(at + std::strlen(name)) : value;
}
"""
# Figures of answers (duet-eval plausible) that the study prints, and of leaders who do not move.
FIGURES = ("twisted", "both feet", "heads", "trunks", "hands", "distance", "speed", "turns", "lean", "facing", "hips",
           "knees")
STILL_FIGURES = ("speed", "hand up", "feet apart")


def open_numbers(text, file):
    """The source with its constants read from the environment, and their values by name."""
    numbers = {}

    def declaration(match):
        parts = []
        for part in match[2].split(","):
            name, value = (side.strip() for side in part.split("="))
            numbers[f"{file}.{name}"] = value
            parts.append(f"{name} = static_cast<{match[1]}>(StudiedNumber(\"{file}.{name}=\", {value}))")
        return f"const {match[1]} {', '.join(parts)};"

    return NUMBERS.sub(declaration, text), numbers


def commands(build, target):
    """The command lines that make a target, in their order."""
    out = subprocess.run(["ninja", "-C", build, "-t", "commands", target], capture_output=True, text=True, check=True)
    return out.stdout.splitlines()


def build_program(build, folder):
    """A duet-eval whose solver reads its numbers from the environment, unless there is one. Returns the numbers."""
    made = (folder / "duet-eval").exists()
    (folder / "numbers.h").write_text(HEADER, encoding="utf-8")
    compiler = next(line for line in commands(build, "model/solver/libduet_solver.a") if "/model/solver/" in line)
    flags = shlex.split(compiler.split(" -MD ")[0])
    numbers, objects = {}, []
    for source in sorted((SOURCE / "model" / "solver").glob("*.cc")):
        text, found = open_numbers(source.read_text(encoding="utf-8"), source.stem)
        numbers.update(found)
        if made:
            continue
        copy = folder / source.name
        copy.write_text(f'#include "{folder}/numbers.h"\n{text}', encoding="utf-8")
        objects.append(str(copy.with_suffix(".o")))
        subprocess.run([*flags, "-c", copy, "-o", objects[-1]], cwd=build, check=True)
    if made:
        return numbers
    link = commands(build, "bin/duet-eval")[-1].replace("model/solver/libduet_solver.a", shlex.join(objects))
    subprocess.run(link.replace("-o bin/duet-eval", f"-o {shlex.quote(str(folder / 'duet-eval'))}"), shell=True,
                   cwd=build, check=True)
    return numbers


def answers(program, changes, options):
    """The figures of every answer, [answers, figures], and their names: with a class at 1, then at rest."""
    with tempfile.TemporaryDirectory() as out:
        subprocess.run([program, "plausible", "--leaders", options.leaders, "--embedded", "--each", "--out", out,
                        "--seconds", str(options.seconds), "--samples", str(options.samples),
                        *([] if options.live is None else ["--live", str(options.live)]),
                        *([] if options.still else ["--no-still"])],
                       env={**os.environ, "DUET_STUDIED_NUMBERS": ",".join(changes) + ","}, check=True,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        tables = json.loads(next(pathlib.Path(out).glob("*.json")).read_text(encoding="utf-8"))["tables"]
    return {"": chosen(tables[-1], FIGURES, lambda name: is_asked(name.split()[1], options.half)),
            **({"still ": chosen(tables[1], STILL_FIGURES, lambda name: name.count(",") > name.count("live")
                                and is_asked(name.split(", ")[-1], options.half))}
               if options.still else {})}


def is_asked(leader, half):
    """Whether a leader is of the half: numbers are chosen on one, and reported on the other."""
    return half is None or sum(leader.encode()) % 2 == half


def chosen(table, figures, keep):
    """The columns of some rows: [rows, figures]. A figure that an answer does not have is nan."""
    at = [table["columns"].index(figure) for figure in figures]
    return np.array([[np.nan if row["values"][i] is None else row["values"][i] for i in at]
                     for row in table["rows"] if keep(row["name"])], dtype=float)


def interval(differences, random):
    """95 % of the means of resampled answers. Shapes: [answers, figures] to [2, figures]."""
    draws = random.integers(len(differences), size=(500, len(differences)))
    return np.quantile(np.nanmean(differences[draws], axis=1), [0.025, 0.975], axis=0)


def compare(name, base, other):
    """Prints by how much the means moved where an interval excludes 0."""
    moved = []
    for kind, figures in (("", FIGURES), ("still ", STILL_FIGURES)):
        if kind not in base:
            continue
        differences = other[kind] - base[kind]
        low, high = interval(differences, np.random.default_rng(0))
        mean, before = np.nanmean(differences, axis=0), np.nanmean(base[kind], axis=0)
        moved += [f"{kind}{figure} {before[i]:.3f} {mean[i]:+.3f} [{low[i]:+.3f} {high[i]:+.3f}]"
                  for i, figure in enumerate(figures) if low[i] > 0 or high[i] < 0]
    print(f"{name}: {'; '.join(moved) or 'nothing'}", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", maxsplit=1)[0])
    parser.add_argument("build", type=pathlib.Path, help="build folder with duet-eval (Ninja)")
    parser.add_argument("--leaders", required=True, help="folder of motion files")
    parser.add_argument("--half", type=int, choices=(0, 1), help="only one half of the leaders")
    parser.add_argument("--seconds", type=float, default=20, help="of each leader (default: %(default)s)")
    parser.add_argument("--samples", type=int, default=1, help="seeds of each leader and class (default: %(default)s)")
    parser.add_argument("--live", type=int, help="answer live with this delay")
    parser.add_argument("--still", action="store_true", help="also leaders who do not move")
    parser.add_argument("--keep", type=pathlib.Path, help="folder for the program, which is used again")
    parser.add_argument("--list", action="store_true", help="print the numbers")
    parser.add_argument("--change", nargs="*", default=[], metavar="FILE.NUMBER=VALUE[,...]",
                        help="each with its own comparison")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        folder = (options.keep or pathlib.Path(temporary)).resolve()
        folder.mkdir(exist_ok=True)
        numbers = build_program(options.build.resolve(), folder)
        if options.list:
            print("\n".join(f"{name} = {value}" for name, value in numbers.items()))
        unknown = [change for changes in options.change for change in changes.split(",")
                   if change.split("=")[0] not in numbers]
        if unknown:
            parser.error(f"--change: expected numbers that --list prints, got {' '.join(unknown)}")
        base = answers(folder / "duet-eval", [], options) if options.change else None
        for changes in options.change:
            compare(changes, base, answers(folder / "duet-eval", changes.split(","), options))


if __name__ == "__main__":
    main()
