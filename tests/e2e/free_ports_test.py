"""free_ports: no two tests at the same time get the same port."""

import random
import subprocess
import sys
import unittest

import free_ports

COUNT = 20
# Chooses in the same order as this process.
OTHER = f"""import random, sys, free_ports
random.seed(7)
print(*free_ports.free_ports({COUNT}), flush=True)
sys.stdin.read()
"""


class FreePortsTest(unittest.TestCase):
    def test_ports_are_different_in_all_processes(self):
        random.seed(7)
        mine = free_ports.free_ports(COUNT)
        with subprocess.Popen([sys.executable, "-B", "-c", OTHER], stdin=subprocess.PIPE,
                              stdout=subprocess.PIPE, text=True, cwd=sys.path[0]) as other:
            others = list(map(int, other.stdout.readline().split()))
            random.seed(7)
            more = free_ports.free_ports(COUNT)
            other.stdin.close()
        self.assertEqual(len({*mine, *others, *more}), 3 * COUNT)


if __name__ == "__main__":
    unittest.main(verbosity=2)
