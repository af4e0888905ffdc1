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
            self.assertIn(one.in_make_test, check.IN_MAKE_TEST, one.name)
            self.assertTrue(one.promise, one.name)
            self.assertTrue((check.ROOT / shlex.split(one.command)[0]).is_file(), one.command)

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
        checks = [check.Check(f"{number}", need, "before", "true", "-")
                  for number, need in enumerate(needs)]

        def step(name, _):
            made.append(name)
            return name not in failing
        with unittest.mock.patch.object(check, "step", step):
            check.run(checks, **options)
        return made

    def test_what_a_check_needs_is_made_once_before_the_first_that_needs_it(self):
        self.assertEqual(self.steps(["nothing", "configure", "build", "configure"]),
                         ["0", "configure", "1", "build", "2", "3"])
        self.assertEqual(self.steps(["build"]), ["configure", "build", "0"])
        self.assertEqual(self.steps(["nothing"]), ["0"])
        self.assertEqual(self.steps(["configure", "build"], prepared="build"), ["0", "1"])

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


class TestTest(unittest.TestCase):
    def run_test(self, failing=None, beside_status=0):
        """The status of `make test` and the steps that it made."""
        made = []

        def step(name, _):
            made.append(name)
            return name != failing

        def start(command, **_):
            made.append(command[command.index("--prepared"):])
            return unittest.mock.Mock(wait=lambda: beside_status)
        checks = [check.Check("a", "nothing", "before", "true", "-"), check.Check("b", "build", "beside", "true", "-"),
                  check.Check("c", "build", "no", "true", "-")]
        with unittest.mock.patch.object(check, "step", step), unittest.mock.patch("subprocess.Popen", start), \
                unittest.mock.patch.object(check, "read_checks", lambda: checks), \
                unittest.mock.patch.dict("os.environ", {"JOBS": "2"}), contextlib.redirect_stdout(io.StringIO()):
            return check.main(["--test"]), made

    def test_some_checks_run_before_the_tests_and_some_beside_them(self):
        self.assertEqual(self.run_test(), (0, ["a", ["--prepared", "b"], "tests"]))

    def test_failed_check_before_the_tests_ends_the_run(self):
        self.assertEqual(self.run_test(failing="a"), (1, ["a"]))

    def test_failed_test_and_failed_check_beside_it_decide_the_exit_status(self):
        self.assertEqual(self.run_test(failing="tests")[0], 1)
        self.assertEqual(self.run_test(beside_status=1)[0], 1)


if __name__ == "__main__":
    unittest.main()
