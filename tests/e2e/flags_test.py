"""What the command lines of all programs have in common: the spelling of flags (kebab-case everywhere),
versions, output that cannot be written."""

import re
import subprocess
import unittest

import tools

PROGRAMS = ("duet", "duet-eval", "duet-import", "duet-train")


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
        for command in re.findall(r"^  (\w+)", commands.partition("\n\n")[0], re.MULTILINE):
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

    def test_every_program_prints_its_version(self):
        text = (tools.SOURCE / "CMakeLists.txt").read_text(encoding="utf-8")
        version = re.search(r"project\(duet VERSION ([\d.]+)", text)[1]
        for program in PROGRAMS + ("duet-server",):
            result = tools.run(tools.PROGRAMS / program, "--version")
            self.assertEqual((result.returncode, result.stdout), (0, f"{program} {version}\n"), result.stderr)
        with tools.running_server(metrics="127.0.0.1:0") as server:
            self.assertIn(f'\nduet_build_info{{version="{version}"}} 1\n', server.page("/metrics")[1])

    def test_output_that_cannot_be_written_is_an_error(self):
        commands = [(program, "--help") for program in PROGRAMS + ("duet-server",)]
        commands += [("duet", "--help-all"), ("duet", "inspect", tools.sample("kick")),
                     ("duet-server", "--print-config")]
        for program, *arguments in commands:
            with self.subTest((program, *arguments)), open("/dev/full", "wb") as full:
                result = subprocess.run([tools.PROGRAMS / program, *arguments], stdout=full,
                                        stderr=subprocess.PIPE, text=True, check=False)
                self.assertEqual(result.returncode, 1, result.stderr)
                self.assertIn(f"{program}: standard output: cannot write all of it", result.stderr)

    def test_flags_of_the_client_are_documented(self):
        client = ("synthesize", "live", "models", "inspect", "convert", "view")
        for document, commands in (("client", client), ("batch", ("batch",)), ("models", ("admin",))):
            documented = (tools.SOURCE / "docs" / f"{document}.md").read_text(encoding="utf-8")
            if document == "models":  # docs/client.md documents the common flags
                documented += (tools.SOURCE / "docs" / "client.md").read_text(encoding="utf-8")
            for flag in flags_in("".join(help_of("duet", command) for command in commands)):
                if flag != "--help":
                    self.assertRegex(documented, rf"`[^`]*{flag}(?![\w-])", flag)


if __name__ == "__main__":
    tools.main()
