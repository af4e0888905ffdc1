"""The systemd unit of deploy/systemd: that systemd understands all of it, and does not give up."""

import configparser
import shutil
import unittest

import tools

UNIT = tools.SOURCE / "deploy/systemd/duet-server.service"


class UnitTest(tools.FolderTest):
    def test_no_number_of_failures_ends_the_service(self):
        unit = configparser.ConfigParser(strict=False, interpolation=None)
        unit.optionxform = str
        unit.read(UNIT)
        self.assertEqual(unit["Service"]["Restart"], "on-failure")
        # In the section Service, systemd 252 ignores it.
        self.assertEqual(unit["Unit"]["StartLimitIntervalSec"], "0")

    @unittest.skipUnless(shutil.which("systemd-analyze"), "needs systemd-analyze")
    def test_systemd_understands_every_line(self):
        # It must find the program.
        text = UNIT.read_text(encoding="utf-8").replace("/usr/bin/", f"{tools.PROGRAMS}/")
        unit = self.folder / UNIT.name
        unit.write_text(text, encoding="utf-8")
        verified = tools.run("systemd-analyze", "verify", "--man=no", unit)
        self.assertEqual((verified.returncode, verified.stderr), (0, ""))


if __name__ == "__main__":
    tools.main()
