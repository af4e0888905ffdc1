"""What mutate.py found out so far, so that a stopped run goes on and a repeated one is quick."""

import hashlib
import json

import source_tree


def digest(*parts):
    return hashlib.sha256("\0".join(parts).encode()).hexdigest()[:24]


class Journal:
    """One line a mutation. Caught: valid until the file changes. Survived: until anything does."""

    def __init__(self, path, root, fresh=False):
        self.path, self.known = path, {}
        self.tree = self.fingerprint(root)
        path.parent.mkdir(parents=True, exist_ok=True)
        if fresh:
            path.unlink(missing_ok=True)
        if path.exists():
            for line in path.read_text(encoding="utf-8").splitlines():
                entry = self.parse(line)
                if entry:
                    self.known[entry["key"]] = entry

    @staticmethod
    def parse(line):
        try:
            return json.loads(line)
        except ValueError:  # a line that a stopped run left half written
            return None

    @staticmethod
    def fingerprint(root):
        """Of everything that may decide whether a mutation is caught."""
        tree = source_tree.SourceTree(root)
        files = [file for suffix in (".h", ".cc", "CMakeLists.txt") for file in tree.files(suffix)]
        return digest(*(part for file in files
                        for part in (file, (tree.root / file).read_text(encoding="utf-8"))))

    @staticmethod
    def key(file, text, mutation):
        return digest(file, text, str(mutation.start), str(mutation.end), mutation.replacement)

    def result(self, file, text, mutation):
        """What came of a mutation before; None: not known, or no longer valid."""
        entry = self.known.get(self.key(file, text, mutation))
        if entry and (entry["result"]["outcome"] != "survived" or entry["tree"] == self.tree):
            return entry["result"]
        return None

    def add(self, file, text, mutation, result):
        entry = {"key": self.key(file, text, mutation), "tree": self.tree, "result": result}
        self.known[entry["key"]] = entry
        with self.path.open("a", encoding="utf-8") as out:
            out.write(json.dumps(entry) + "\n")
