"""The Debian packages: what is in them, what lintian and systemd say of them, and a server that runs from
their files with their configuration.

    package_test.py <build folder> <cpack>
"""

import os
import re
import shutil
import sys
import unittest

import tools

sys.path.insert(0, str(tools.SOURCE / "scripts"))
import check_version  # noqa: E402

BUILD, CPACK = sys.argv[1:]
del sys.argv[1:]
COMPONENTS = "client;server;training"


def run(*command, **options):
    result = tools.run(*command, **options)
    assert result.returncode == 0, f"{command}: {result.stdout}{result.stderr}"
    return result.stdout


class PackageTest(tools.FolderTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        run(CPACK, "-G", "DEB", "-B", cls.folder, "-D", f"CPACK_COMPONENTS_ALL={COMPONENTS}",
            cwd=BUILD, timeout=600)
        cls.packages = {file.name.split("_")[0]: file for file in cls.folder.glob("*.deb")}
        cls.root = cls.folder / "root"
        for package in cls.packages.values():
            run("dpkg-deb", "-x", package, cls.root)

    def test_each_package_has_its_files_and_only_their_dependencies(self):
        self.assertEqual(sorted(self.packages), ["duet", "duet-server", "duet-training"])
        version = check_version.project_version(tools.SOURCE)
        for name, package in self.packages.items():
            self.assertEqual(run("dpkg-deb", "-f", package, "Version").strip(), f"{version}-1")
            needed = run("dpkg-deb", "-f", package, "Depends")
            self.assertEqual("libgrpc++1.51" in needed, name in ("duet", "duet-server"), name)
            self.assertEqual("libtorch" in needed, name == "duet-training", name)
        pages = ("man1/duet-synthesize.1.gz", "man1/duet-train.1.gz", "man8/duet-server.8.gz")
        for path in (*(f"usr/share/man/{page}" for page in pages if shutil.which("help2man")), "usr/bin/duet",
                     "usr/bin/duet-server",
                     "usr/lib/systemd/system/duet-server.service",
                     "usr/lib/sysusers.d/duet-server.conf", "etc/duet/server.textproto",
                     "usr/bin/duet-train", "usr/bin/duet-eval", "usr/bin/duet-import"):
            self.assertTrue((self.root / path).is_file(), path)
        for name in self.packages:
            self.assertIn("mocap.cs.cmu.edu",
                          (self.root / "usr/share/doc" / name / "NOTICE").read_text())
        # What an operator changed stays on an upgrade.
        self.assertEqual(run("dpkg-deb", "-I", self.packages["duet-server"], "conffiles"),
                         "/etc/duet/server.textproto\n")

    def test_the_unit_waits_longer_than_the_server_drains(self):
        unit = (self.root / "usr/lib/systemd/system/duet-server.service").read_text()
        config = (self.root / "etc/duet/server.textproto").read_text()
        seconds = [int(found) for found in re.findall(r"^\w+_seconds: (\d+)$", config, re.M)]
        self.assertEqual(len(seconds), 2)
        self.assertGreater(int(re.search(r"TimeoutStopSec=(\d+)", unit)[1]), sum(seconds))

    def test_the_server_runs_with_the_packaged_configuration(self):
        config = self.root / "etc/duet/server.textproto"
        program = self.root / "usr/bin/duet-server"
        server = tools.Server("--config", config, "--drain-seconds", "0", program=program)
        client = self.root / "usr/bin/duet"
        result = tools.run(client, "models", "--server", server.address)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(server.stop(), 0)

    @unittest.skipUnless(shutil.which("lintian"), "needs lintian")
    def test_lintian_finds_nothing(self):
        root = ["--allow-root"] if os.geteuid() == 0 else []
        found = tools.run("lintian", *root, *self.packages.values(), timeout=600)
        self.assertEqual(found.stdout, "")

    @unittest.skipUnless(shutil.which("systemd-analyze"), "needs systemd-analyze")
    def test_service_unit_is_confined(self):
        unit = self.root / "usr/lib/systemd/system/duet-server.service"
        # In tenths, of 100.
        run("systemd-analyze", "security", "--offline=yes", "--threshold=15", unit)


if __name__ == "__main__":
    for needed in ("dpkg-deb", "dpkg-shlibdeps"):
        if not shutil.which(needed):
            tools.skip(f"{needed} is not installed")
    tools.main()
