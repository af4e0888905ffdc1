#!/usr/bin/env python3
"""Shows that scripts/checks.tsv is well formed, that the guide follows it, and how check.py runs it."""

import contextlib
import io
import shlex
import unittest
import unittest.mock

import check


class ListTest(unittest.TestCase):
    def setUp(self):
        self.checks = check.read_checks()

    def test_each_check_is_complete_and_its_script_exists(self):
        names = [one.name for one in self.checks]
        self.assertEqual(len(names), len(set(names)))
        for one in self.checks:
            self.assertIn(one.needs, check.NEEDS, one.name)
            self.assertTrue(one.promise, one.name)
            for command in filter(None, (one.command, one.quick_command)):
                self.assertTrue((check.ROOT / shlex.split(command)[0]).is_file(), command)

    def test_every_check_script_is_in_the_list(self):
        listed = {shlex.split(one.command)[0] for one in self.checks}
        scripts = {f"scripts/{file.name}" for file in (check.ROOT / "scripts").glob("check_*.*")
                   if not file.name.endswith("_test.py")}
        self.assertEqual(scripts - listed, set())

    def test_guide_holds_the_table_of_the_list(self):
        lines = check.GUIDE.read_text(encoding="utf-8").splitlines()
        self.assertEqual([line for line in lines if line.startswith("|")],
                         list(check.guide_table(self.checks)),
                         "run scripts/check.py --write-guide")


class RunTest(unittest.TestCase):
    def steps(self, needs, failing=(), **options):
        """The names of the steps that run() makes for checks with these needs."""
        made = []
        checks = [check.Check(f"{number}", need, "yes", "true", "-")
                  for number, need in enumerate(needs)]

        def step(name, _):
            made.append(name)
            return name not in failing
        with unittest.mock.patch.object(check, "step", step):
            check.run([(one, one.command) for one in checks],
                      **{"stop_at_failure": False, **options})
        return made

    def test_what_a_check_needs_is_made_once_before_the_first_that_needs_it(self):
        self.assertEqual(self.steps(["nothing", "configure", "build", "configure"]),
                         ["0", "configure", "1", "build", "2", "3"])
        self.assertEqual(self.steps(["build"]), ["configure", "build", "0"])
        self.assertEqual(self.steps(["nothing"]), ["0"])

    def test_quick_run_stops_at_the_first_failure_and_the_full_run_goes_on(self):
        self.assertEqual(self.steps(["nothing"] * 3, ["1"], stop_at_failure=True), ["0", "1"])
        self.assertEqual(self.steps(["nothing"] * 3, ["1"]), ["0", "1", "2"])

    def test_failed_build_ends_the_run(self):
        with self.assertRaises(SystemExit):
            self.steps(["configure"], ["configure"])

    def test_failure_decides_the_exit_status(self):
        for passed, status in ((True, 0), (False, 1)):
            with unittest.mock.patch.object(check, "step", lambda *_: passed), \
                    contextlib.redirect_stdout(io.StringIO()) as printed:
                self.assertEqual(check.main(["shell"]), status)
            self.assertIn("ok" if passed else "FAILED", printed.getvalue())


if __name__ == "__main__":
    unittest.main()
