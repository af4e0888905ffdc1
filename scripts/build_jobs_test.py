"""Tests build_jobs.sh: compilations at once, by cores and by what memory the container has."""

import os
import pathlib
import subprocess
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parent / "build_jobs.sh"
GIB = 1 << 30
UNLIMITED_OF_VERSION_1 = 9223372036854771712


class BuildJobsTest(unittest.TestCase):
    def jobs(self, memory, **limits):
        """The answer on a machine with so much memory, and cgroup files with such contents."""
        with tempfile.TemporaryDirectory() as name:
            root = pathlib.Path(name)
            (root / "proc").mkdir()
            (root / "proc/meminfo").write_text(f"MemAvailable:   {memory // 1024} kB\n")
            cgroup = root / "sys/fs/cgroup"
            (cgroup / "memory").mkdir(parents=True)
            files = {"version_2": cgroup / "memory.max",
                     "version_1": cgroup / "memory/memory.limit_in_bytes"}
            for version, limit in limits.items():
                files[version].write_text(f"{limit}\n")
            return int(subprocess.run([SCRIPT, name], check=True, capture_output=True).stdout)

    def test_one_a_core_where_memory_is_plenty(self):
        cores = len(os.sched_getaffinity(0))
        self.assertEqual(self.jobs(1000 * GIB), cores)
        self.assertEqual(self.jobs(1000 * GIB, version_2="max"), cores)
        self.assertEqual(self.jobs(1000 * GIB, version_1=UNLIMITED_OF_VERSION_1), cores)

    def test_one_where_the_machine_has_little(self):
        self.assertEqual(self.jobs(GIB), 1)

    def test_a_container_s_limit_counts_in_either_version(self):
        self.assertEqual(self.jobs(1000 * GIB, version_2=GIB), 1)
        self.assertEqual(self.jobs(1000 * GIB, version_1=GIB), 1)


if __name__ == "__main__":
    unittest.main()
