"""What mutate.py prints and writes: the share of mutations that the tests caught, room by room."""

import collections
import datetime
import shlex

HEAD = """# Mutation score

How often the tests notice when the code is broken on purpose. `make mutate` changes one operator, constant,
condition, return or statement at a time in the parts that need no LibTorch, builds the test programs that link the
changed file or start a program that does, and runs them. A change that no test notices survived: a hole in the tests, or a change without effect.
Debian has no mutation tester for C++ (nothing by that name for GCC or Clang), so `scripts/mutate.py` is one.

Written by `{command}` on {date}: up to {per_room} changes that compile
were drawn from each folder with seed {seed}.

"""


class Summary:
    def __init__(self, results):
        self.results = results  # room -> its results
        self.every = [result for found in results.values() for result in found]

    @property
    def score(self):
        return percent(self.every)

    def text(self):
        lines = [f"{room:32} {percent(found):5.1f} % of {len(found)}"
                 for room, found in self.results.items()]
        return "\n".join([*lines, f"{'all':32} {self.score:5.1f} % of {len(self.every)}"])

    def page(self, options, arguments, left_out=()):
        return (HEAD.format(command=shlex.join(["scripts/mutate.py", *arguments]),
                            date=datetime.date.today().isoformat(), per_room=options.per_room,
                            seed=options.seed)
                + self.table()
                + ("\nLeft out, since only test programs with LibTorch reach them: "
                   + ", ".join(f"`{room}`" for room in left_out) + ".\n" if left_out else "")
                + self.listing("Survivors", "survived", "Nothing survived.")
                + self.listing("Caught by a time limit", "timeout", "None."))

    def table(self):
        rows = ["| folder | tried | caught | by its own tests | by a time limit | survived | "
                "score |",
                "|---|---|---|---|---|---|---|"]
        for room, found in [*((f"`{room}`", found) for room, found in self.results.items()),
                            ("**all**", self.every)]:
            count = collections.Counter(result["outcome"] for result in found)
            own = sum(bool(result.get("own")) for result in found)
            rows.append(f"| {room} | {len(found)} | {len(found) - count['survived']} | {own} | "
                        f"{count['timeout']} | {count['survived']} | {percent(found):.1f} % |")
        return "\n".join(rows) + "\n"

    def listing(self, title, outcome, none):
        rows = [f"| `{result['file']}:{result['line']}` | {code(result['before'])} | "
                f"{code(result['after'])} | {code(result['code'])} |"
                for result in self.every if result["outcome"] == outcome]
        head = ["| where | was | became | line |", "|---|---|---|---|"]
        return f"\n## {title}\n\n" + ("\n".join([*head, *rows]) if rows else none) + "\n"


def percent(results):
    caught = sum(result["outcome"] != "survived" for result in results)
    return 100.0 * caught / len(results) if results else 100.0


def code(text):
    """A piece of C++ as a cell of a table."""
    if not text:
        return "(nothing)"
    text = text.replace("&", "&amp;").replace("<", "&lt;").replace("|", "&#124;")
    return f"<code>{text}</code>"
