"""The process behind motion files: kept for the next command, never shared, replaced if it ends."""

import concurrent.futures
import os
import pathlib
import shutil
import stat
import subprocess
import sys
import tempfile
import threading
import unittest
from unittest import mock

import support
from duet_motion import _program

PROGRAM = pathlib.Path(os.environ.get("DUET_BIN_DIR", support.SOURCE / "build/release/bin")) / "duet"

# Answers as `duet stdio` does, with its process id; "end" ends it in the middle of an answer.
KEPT = f"#!{sys.executable}" + """
import json, os, sys
if sys.argv[1:] != ["stdio"]:
    print("once", end="")
    sys.exit(sys.argv[1] == "fail" and 42)
for line in sys.stdin:
    words = json.loads(line)
    out = str(os.getpid())
    if words[0] == "end":
        print('{"exit_code": 0, "out_bytes": 5, "err_bytes": 0}', end="\\n1", flush=True)
        break
    print(json.dumps({"exit_code": 42 * (words[0] == "fail"), "out_bytes": len(out),
                      "err_bytes": 3}))
    print(out + "no!", end="", flush=True)
    if words[0] == "last":
        break
"""
# A program from before `duet stdio`.
OLD = """#!/bin/sh
if [ "$1" = stdio ]; then echo 'There is no command "stdio"' >&2; exit 2; fi
printf old
"""


# Prints the process id of the program before a fork, in the child, and in the parent after it.
FORKING = """
import os
from duet_motion import _program

print(_program.run("read"), flush=True)
child = os.fork()
print(_program.run("read"), flush=True)
if child == 0:
    os._exit(0)
os.waitpid(child, 0)
"""


class ProgramTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.addCleanup(_program._idle.close)
        self.use(KEPT)

    def use(self, script):
        program = self.folder / "duet"
        program.write_text(script, encoding="utf-8")
        program.chmod(program.stat().st_mode | stat.S_IXUSR)
        _program._idle.close()
        self.enterContext(mock.patch.dict(os.environ, {"DUET_PROGRAM": str(program)}))

    def test_one_process_runs_many_commands(self):
        self.assertEqual(len({_program.run("read", str(number)) for number in range(10)}), 1)

    def test_failed_command_reports_its_error_and_keeps_the_process(self):
        kept = _program.run("read")
        with self.assertRaisesRegex(_program.CommandFailed, "^no!$"):
            _program.run("fail")
        self.assertEqual(_program.run("read"), kept)

    def test_idle_process_that_ended_is_replaced(self):
        gone = _program.run("last")
        other = _program.run("read")
        self.assertNotIn(other, (gone, "once"))
        self.assertEqual(_program.run("read"), other)

    def test_process_that_ends_during_an_answer_is_replaced_by_a_single_command(self):
        _program.run("read")
        helper, = _program._idle._helpers
        self.assertEqual(_program.run("end"), "once")
        self.assertIsNotNone(helper._process.returncode)
        self.assertNotEqual(_program.run("read"), "once")

    def test_program_without_stdio_starts_a_process_per_command(self):
        self.use(OLD)
        self.assertEqual([_program.run("read"), _program.run("read")], ["old", "old"])

    def test_file_name_that_is_not_utf_8_starts_a_process(self):
        self.assertEqual(_program.run("read", "\udcff"), "once")

    def test_each_thread_has_a_process_and_at_most_four_are_kept(self):
        together = threading.Barrier(6)

        def read(_):
            together.wait(support.LONGEST_CALL)
            return _program.run("read")
        with concurrent.futures.ThreadPoolExecutor(6) as pool:
            self.assertLessEqual(len(set(pool.map(read, range(6)))), 6)
        self.assertLessEqual(len(_program._idle._helpers), 4)

    def test_another_working_directory_starts_a_process(self):
        kept = _program.run("read")
        here = os.getcwd()
        self.addCleanup(os.chdir, here)
        os.chdir(self.folder)
        self.assertNotEqual(_program.run("read"), kept)

    def test_forked_child_starts_its_own_process(self):
        # In a new interpreter: here, gRPC's threads of other tests may keep a fork waiting for ever.
        done = subprocess.run([sys.executable, "-B", "-c", FORKING], check=True, text=True, stdout=subprocess.PIPE,
                              timeout=support.LONGEST_CALL, env={**os.environ, "PYTHONPATH": str(support.PACKAGE)})
        kept, *later = done.stdout.split()
        self.assertEqual(len(later), 2)
        self.assertIn(kept, later)
        self.assertEqual(len(set(later)), 2)

    def test_interrupted_command_ends_its_process(self):
        kept = _program.run("read")
        helper, = _program._idle._helpers
        with mock.patch.object(_program._Helper, "_ask", side_effect=KeyboardInterrupt):
            with self.assertRaises(KeyboardInterrupt):
                _program.run("read")
        self.assertIsNotNone(helper._process.returncode)
        self.assertNotEqual(_program.run("read"), kept)

    def test_missing_program_explains_how_to_install_it(self):
        with mock.patch.dict(os.environ, {"DUET_PROGRAM": "no-such-duet"}):
            with self.assertRaisesRegex(FileNotFoundError,
                                        "program 'no-such-duet': expected .*Debian package duet.*DUET_PROG"):
                _program.run("read")

    @unittest.skipUnless(PROGRAM.exists(), f"no program at {PROGRAM}; build it, or set DUET_BIN_DIR")
    def test_real_program_is_kept(self):
        with mock.patch.dict(os.environ, {"DUET_PROGRAM": str(PROGRAM)}):
            shutil.copy(support.SOURCE / "samples" / "hug.bvh", self.folder)
            with mock.patch.object(_program, "_run_once", side_effect=AssertionError("not kept")):
                for _ in range(3):
                    printed = _program.run("convert", str(self.folder / "hug.bvh"), "--out", "-",
                                           "--output-format", "json", "--quiet")
                    self.assertIn('"leader"', printed)
                with self.assertRaisesRegex(_program.CommandFailed, "absent.bvh"):
                    _program.run("convert", "absent.bvh", "--out", "-", "--output-format", "json")


if __name__ == "__main__":
    unittest.main()
