"""How the programs' flags are spelt: kebab-case everywhere; names of old in snake_case still work."""

import re
import unittest

import tools

PROGRAMS = ("duet", "duet-eval", "duet-import", "duet-keyframe", "duet-train")
PROGRAMS_OF_SERVING = ("duet-load", "duet-server")


def help_of(*command):
    return tools.run(tools.PROGRAMS / command[0], *command[1:], "--help").stdout


def flags_in(text):
    return re.findall(r"(?<![\w-])--[\w-]+", text)


def every_help():
    """(command, help text) of every program and each of its commands."""
    for program in PROGRAMS:
        text = help_of(program)
        yield (program,), text
        _, _, commands = text.partition("Subcommands:\n")
        for command in re.findall(r"^  (\w+)", commands, re.MULTILINE):
            yield (program, command), help_of(program, command)


class FlagsTest(unittest.TestCase):
    def test_flags_are_shown_in_kebab_case(self):
        seen = {}
        for command, text in every_help():
            seen[command] = flags_in(text)
            self.assertIn("--help", seen[command], command)
            self.assertEqual([flag for flag in seen[command] if "_" in flag], [], command)
        self.assertIn("--version-number", seen["duet-train",])
        self.assertIn("--as-served", seen["duet-eval", "folds"])

    def test_every_program_tells_its_version(self):
        text = (tools.SOURCE / "CMakeLists.txt").read_text(encoding="utf-8")
        version = re.search(r"project\(duet VERSION ([\d.]+)", text)[1]
        for program in PROGRAMS + PROGRAMS_OF_SERVING:
            result = tools.run(tools.PROGRAMS / program, "--version")
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertEqual(result.stdout, f"{program} {version}\n")

    def test_flags_of_the_client_are_documented(self):
        client = ("synthesize", "models", "inspect", "convert", "view", "compare", "man")
        for document, commands in (("client", client), ("batch", ("batch",)), ("models", ("admin",))):
            documented = (tools.SOURCE / "docs" / f"{document}.md").read_text(encoding="utf-8")
            if document == "models":  # it leaves the flags of every command to the other
                documented += (tools.SOURCE / "docs" / "client.md").read_text(encoding="utf-8")
            for flag in flags_in("".join(help_of("duet", command) for command in commands)):
                if flag != "--help":
                    self.assertRegex(documented, rf"`[^`]*{flag}(?![\w-])", flag)

    def refused(self, *command):
        result = tools.run(tools.PROGRAMS / command[0], *command[1:])
        self.assertNotEqual(result.returncode, 0)
        return result.stderr + result.stdout

    def test_old_names_are_taken(self):
        # Each gets past its flag, to what is wrong behind it.
        for flag in ("--as-served", "--as_served"):
            message = self.refused("duet-eval", "folds", "--data", "no-such-folder", flag)
            self.assertIn("no-such-folder", message)
        for flag in ("--version-number", "--version_number"):
            message = self.refused("duet-train", "--data", "x", "--out", "x", flag, "0")
            self.assertIn("--version-number: Value 0 not in range", message)

    def test_other_names_are_not(self):
        message = self.refused("duet-eval", "folds", "--data", "no-such-folder", "--as-surved")
        self.assertIn("--as-surved", message)
        self.assertNotIn("no-such-folder", message)


if __name__ == "__main__":
    tools.main()
