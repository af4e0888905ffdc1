#!/usr/bin/env python3
"""Shows which commit messages check_commits.py and the hook reject."""

import os
import pathlib
import subprocess
import tempfile
import unittest

import check_commits

SCRIPTS = pathlib.Path(__file__).resolve().parent
GOOD = "server: Reject an expired call\n\nIts answer would come too late.\n"


def found(message, lines=100):
    return list(check_commits.problems(message, lines))


class MessageTest(unittest.TestCase):
    def test_form_of_the_project_is_accepted(self):
        self.assertEqual(found(GOOD), [])
        for subject in ("client/batch, docs: Pass the seed on", "python: Embed a model",
                        "ci: Bring `make` along", "web: Focus the page", "tests: Speed up a fixture"):
            self.assertEqual(found(subject, lines=3), [], subject)

    def test_subject_without_component_or_capital_is_rejected(self):
        for subject in ("Reject an expired call", "server: reject a call", "Server: Reject a call",
                        "server:Reject a call", "server: Reject  a call", ""):
            self.assertIn('expected "component: Imperative summary"', " ".join(found(subject, 1)))

    def test_other_forms_of_the_verb_are_rejected(self):
        for verb in ("Adds", "Added", "Adding", "Fixes"):
            self.assertEqual(found(f"server: {verb} a check", 1),
                             [f'subject: expected the imperative, got "{verb}"'])

    def test_long_subject_and_period_are_rejected(self):
        self.assertEqual(found("server: " + "R" * 64, 1), [])
        self.assertEqual(found("server: " + "R" * 65, 1),
                         ["subject: expected at most 72 characters, got 73"])
        self.assertEqual(found("server: Reject it.", 1), ["subject: expected no period at the end"])

    def test_body_needs_an_empty_line_before_it(self):
        self.assertEqual(found("server: Reject it\nbecause it is late\n"),
                         ['second line: expected an empty line, got "because it is late"',
                          "body: expected the reason for a change of 100 lines, got nothing"])

    def test_only_small_changes_need_no_body(self):
        self.assertEqual(found("server: Reject it", lines=20), [])
        self.assertEqual(found("server: Reject it", lines=21),
                         ["body: expected the reason for a change of 21 lines, got nothing"])

    def test_messages_of_git_are_exempt(self):
        for subject in ("Merge branch 'x'", 'Revert "server: Reject it"', "fixup! server: Reject it"):
            self.assertEqual(found(subject), [], subject)

    def test_comments_and_the_diff_are_no_part_of_a_message(self):
        text = GOOD + "# On branch main\n# ---- >8 ----\ndiff --git a b\n"
        self.assertEqual(check_commits.written(text), GOOD.strip())

    def test_binary_files_count_no_lines(self):
        self.assertEqual(check_commits.changed_lines("3\t4\ta.cc\n-\t-\tb.png\n"), 7)


class RepositoryTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        self.environment = {name: value for name, value in os.environ.items()
                            if not name.startswith("GIT_")}
        self.environment.update(GIT_CONFIG_GLOBAL="/dev/null", GIT_AUTHOR_NAME="a",
                                GIT_AUTHOR_EMAIL="a@b", GIT_COMMITTER_NAME="a",
                                GIT_COMMITTER_EMAIL="a@b")
        self.git("init", "--quiet", "--initial-branch=main")
        self.commit("First", hooks="/dev/null")
        self.git("checkout", "--quiet", "-b", "work")

    def git(self, *words):
        return subprocess.run(["git", *words], cwd=self.root, env=self.environment,
                              capture_output=True, text=True, check=False)

    def commit(self, message, hooks):
        (self.root / "file").write_text(message + "\nline" * 30)
        self.git("add", "file")
        return self.git("-c", f"core.hooksPath={hooks}", "commit", "-m", message)

    def check(self):
        return subprocess.run([SCRIPTS / "check_commits.py"], cwd=self.root, env=self.environment,
                              capture_output=True, text=True, check=False)

    def test_hook_rejects_and_accepts(self):
        (self.root / "scripts").symlink_to(SCRIPTS)
        rejected = self.commit("Rejected things", SCRIPTS / "hooks")
        self.assertNotEqual(rejected.returncode, 0)
        self.assertIn("commit message: subject: expected", rejected.stderr)
        self.assertEqual(self.commit(GOOD, SCRIPTS / "hooks").returncode, 0)

    def test_commits_since_main_are_checked(self):
        self.commit(GOOD, "/dev/null")
        self.assertEqual(self.check().returncode, 0)
        self.commit("Oops", "/dev/null")
        checked = self.check()
        self.assertEqual(checked.returncode, 1)
        self.assertIn('got "Oops"', checked.stderr)
        self.assertNotIn("First", checked.stderr)

    def test_check_is_skipped_without_the_history_of_main(self):
        self.git("branch", "--quiet", "-D", "main")
        checked = self.check()
        self.assertEqual(checked.returncode, 0)
        self.assertIn("SKIPPED", checked.stdout)


if __name__ == "__main__":
    unittest.main()
