"""Every program, the metrics and the Python package state the version of CMakeLists.txt."""

import re
import sys
import unittest

import tools

sys.path.insert(0, str(tools.SOURCE / "scripts"))
import check_version  # noqa: E402

PROGRAMS = ("duet", "duet-server", "duet-train", "duet-eval", "duet-import", "duet-keyframe")


class VersionTest(unittest.TestCase):
    version = check_version.project_version(tools.SOURCE)

    def test_programs_print_it(self):
        for program in PROGRAMS:
            with self.subTest(program):
                printed = tools.run(tools.PROGRAMS / program, "--version")
                self.assertEqual((printed.returncode, printed.stdout.strip()),
                                 (0, f"{program} {self.version}"))

    def test_the_server_reports_it_as_a_metric(self):
        with tools.running_server(metrics="127.0.0.1:0") as server:
            page = server.page("/metrics")[1]
        self.assertEqual(re.findall(r'^duet_build_info\{version="([^"]*)"\} 1$', page, re.M),
                         [self.version])


if __name__ == "__main__":
    tools.main()
