"""The program behind motion files: its output, its errors, and the message if it is missing."""

import os
import pathlib
import sys
import tempfile
import unittest
from unittest import mock

import support
from duet_motion import _program

SCRIPT = f"#!{sys.executable}" + """
import os, signal, sys
if sys.argv[1] == "crash":
    os.kill(os.getpid(), signal.SIGKILL)
print(*sys.argv[1:], os.environ["DUET_CONFIG"] or "-")
if sys.argv[1] == "fail":
    sys.exit("duet: no!")
"""


class ProgramTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        program = pathlib.Path(folder.name) / "duet"
        program.write_text(SCRIPT, encoding="utf-8")
        program.chmod(0o755)
        self.enterContext(mock.patch.dict(os.environ, {"DUET_PROGRAM": str(program), "DUET_CONFIG": "mine"}))

    def test_output_is_returned_and_the_configuration_file_ignored(self):
        self.assertEqual(_program.run("read", "a b"), "read a b -\n")

    def test_failed_command_reports_its_error_and_its_output(self):
        with self.assertRaisesRegex(_program.CommandFailed, "^no!$") as raised:
            _program.run("fail")
        self.assertEqual(raised.exception.output, "fail -\n")
        with self.assertRaisesRegex(_program.CommandFailed, "was ended by signal 9"):
            _program.run("crash")

    def test_missing_program_explains_how_to_install_it(self):
        with mock.patch.dict(os.environ, {"DUET_PROGRAM": "no-such-duet"}):
            with self.assertRaisesRegex(FileNotFoundError,
                                        "program 'no-such-duet': expected .*Debian package duet.*DUET_PROG"):
                _program.run("read")


if __name__ == "__main__":
    unittest.main()
