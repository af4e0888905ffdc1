"""The completion scripts in their shells, and the manual pages under their linters.

Shells and linters that are not installed are skipped."""

import os
import pathlib
import pty
import select
import shutil
import subprocess
import tempfile
import time
import unittest

import tools

# The typed text, and the completions of its last word in each shell. Files: kick.csv and kick.json.
OFFERS = {
    "duet in": {"inspect"},
    "duet synthesize --leader": {"--leader", "--leader-side"},
    "duet synthesize --leader-side ": {"left", "right"},
    "duet synthesize --priority b": {"bulk"},
    "duet li": {"live"},
    "duet live --clean-up o": {"on", "off"},
    "duet convert --out ki": {"kick.csv", "kick.json"},
    "duet inspect kick.c": {"kick.csv"},
    "duet batch --verif": {"--verify"},
    "duet help set": {"settings"},
    "duet help con": {"convert"},
    "duet completion ": {"bash", "fish", "zsh"},
    "duet man syn": {"synthesize"},
    "duet synthesize --timeout ": set(),
}

BASH = """
source "$1"
shift
COMP_WORDS=("$@") COMP_CWORD=$(($# - 1)) COMPREPLY=()
_duet
printf '%s\\n' "${COMPREPLY[@]}"
"""

# ^I completes the typed text, ^X prints it between marks and clears it.
ZSH = """
PROMPT='' RPROMPT=''
unset zle_bracketed_paste
fpath=({folder} $fpath)
autoload -U compinit && compinit -u -D
unsetopt beep prompt_sp
show() {{ print -r -- "<$BUFFER>"; BUFFER='' }}
zle -N show
bindkey '^X' show
bindkey '^I' complete-word
print READY
"""


class CompletionTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        for name in ("kick.csv", "kick.json"):
            (self.folder / name).touch()

    def script(self, shell, name):
        result = tools.duet("completion", shell)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        file = self.folder / name
        file.write_text(result.stdout, encoding="utf-8")
        return file

    def shell(self, name):
        return shutil.which(name) or self.skipTest(f"no {name}")

    def test_bash(self):
        bash = self.shell("bash")
        script = self.script("bash", "script.bash")
        for line, offers in OFFERS.items():
            with self.subTest(line):
                result = tools.run(bash, "--norc", "-c", BASH, "bash", script, *line.split(" "),
                                   cwd=self.folder)
                self.assertEqual((result.returncode, result.stderr), (0, ""))
                self.assertEqual(set(result.stdout.split()), offers)

    def test_bash_takes_a_value_after_an_equals_sign(self):
        bash = self.shell("bash")
        script = self.script("bash", "script.bash")
        result = tools.run(bash, "--norc", "-c", BASH, "bash", script, "duet", "synthesize",
                           "--leader-side", "=", "ri")
        self.assertEqual(result.stdout.split(), ["right"])

    def test_fish(self):
        fish = self.shell("fish")
        script = self.script("fish", "script.fish")
        environment = {**os.environ, "HOME": str(self.folder), "XDG_CONFIG_HOME": str(self.folder)}
        for line, offers in OFFERS.items():
            with self.subTest(line):
                result = tools.run(fish, "--no-config", "-c",
                                   f"source {script}; complete -C '{line}'", cwd=self.folder,
                                   env=environment)
                self.assertEqual(result.returncode, 0, result.stderr)
                self.assertEqual({offer.split("\t")[0] for offer in result.stdout.splitlines()},
                                 offers)

    def test_zsh(self):
        zsh = self.shell("zsh")
        self.script("zsh", "_duet")
        (self.folder / ".zshrc").write_text(ZSH.format(folder=self.folder), encoding="utf-8")
        with Terminal([zsh, "-d", "-i"], self.folder) as terminal:
            terminal.read_until("READY\r\n")
            for line, offers in OFFERS.items():
                if len(offers) != 1:
                    continue
                with self.subTest(line):
                    terminal.type(line + "\t\x18")
                    # A single completion is inserted; a flag with a value gets its '='.
                    shown = terminal.read_until(">\r\n").rpartition("<")[2].partition(">")[0]
                    start = line.rpartition(" ")[0]
                    self.assertEqual(shown.rstrip(" ="), f"{start} {next(iter(offers))}")

    def test_manual_pages(self):
        result = tools.duet("man", "--out", self.folder / "man1")
        self.assertEqual((result.returncode, result.stdout), (0, ""), result.stderr)
        pages = sorted((self.folder / "man1").iterdir())
        self.assertIn("duet-batch-merge.1", [page.name for page in pages])
        for page in pages:
            with self.subTest(page.name):
                self.lint(page)

    def lint(self, page):
        if shutil.which("man"):
            result = tools.run("man", "--warnings", "-E", "UTF-8", "-l", "-Tutf8", "-Z", page,
                               env={**os.environ, "LC_ALL": "C.UTF-8", "MANROFFSEQ": ""})
            self.assertEqual((result.returncode, result.stderr), (0, ""))
        if shutil.which("mandoc"):
            result = tools.run("mandoc", "-T", "lint", "-W", "warning", page)
            # A date would differ from build to build.
            complaints = [line for line in result.stdout.splitlines() if "missing date" not in line]
            self.assertEqual(complaints, [])


class Terminal:
    """Runs a program on a pseudo-terminal."""

    def __init__(self, command, folder):
        self._descriptor, inner = pty.openpty()
        self._process = subprocess.Popen(
            [str(word) for word in command], stdin=inner, stdout=inner, stderr=inner, cwd=folder,
            start_new_session=True, env={**os.environ, "TERM": "dumb", "HOME": str(folder),
                                          "ZDOTDIR": str(folder)})
        os.close(inner)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._process.kill()
        self._process.wait()
        os.close(self._descriptor)

    def type(self, text):
        os.write(self._descriptor, text.encode())

    def read_until(self, end):
        text = ""
        deadline = time.monotonic() + tools.RUN_SECONDS
        while not text.endswith(end):
            left = deadline - time.monotonic()
            assert left > 0 and select.select([self._descriptor], [], [], left)[0], text
            text += os.read(self._descriptor, 1).decode(errors="replace")
        return text


if __name__ == "__main__":
    tools.main()
