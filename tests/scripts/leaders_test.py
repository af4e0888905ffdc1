"""Tests of the leaders that scripts/make_leaders.py makes."""

import math
import random
import unittest

import make_leaders
from leaders import body, kinds

SECONDS = 20


def bodies_of(kind, seed=1):
    return kind(random.Random(seed), SECONDS)


class LeadersTest(unittest.TestCase):
    def test_the_same_seed_makes_the_same_motion_and_another_seed_another(self):
        for kind in kinds.KINDS:
            one = make_leaders.key_frames(kind, 1, 1, SECONDS)
            self.assertEqual(one, make_leaders.key_frames(kind, 1, 1, SECONDS))
            self.assertNotEqual(one, make_leaders.key_frames(kind, 2, 1, SECONDS))
            self.assertNotEqual(one, make_leaders.key_frames(kind, 1, 2, SECONDS))

    def test_keys_cover_the_motion(self):
        for kind in kinds.KINDS:
            times = [float(line.split()[1])
                     for line in make_leaders.key_frames(kind, 1, 1, SECONDS).splitlines()
                     if line.startswith("at ")]
            self.assertEqual(times[0], 0)
            self.assertEqual(times[-1], SECONDS)
            self.assertTrue(all(a < b for a, b in zip(times, times[1:])))

    def test_one_foot_stands_in_every_key_and_stays_below_the_body(self):
        for kind in kinds.KINDS:
            for seed in range(5):
                bodies = bodies_of(kind, seed)
                feet = body.place_feet(bodies)
                for t in range(1, len(bodies)):
                    stands = [side for side in (0, 1) if feet[t][side] == feet[t - 1][side]]
                    self.assertTrue(stands, (kind.__name__, seed, t))
                    for x, _, z in feet[t]:
                        away = math.hypot(x - bodies[t].x, z - bodies[t].z)
                        self.assertLess(away, 0.75, (kind.__name__, seed, t))

    def test_bodies_move_as_fast_as_people(self):
        for kind in kinds.KINDS:
            for seed in range(5):
                bodies = bodies_of(kind, seed)
                for a, b in zip(bodies, bodies[1:]):
                    walked = math.hypot(b.x - a.x, b.z - a.z) * body.KEYS_PER_SECOND
                    turned = abs(b.yaw - a.yaw) * body.KEYS_PER_SECOND
                    self.assertLess(walked, 1.5, kind.__name__)
                    self.assertLess(turned, 700, kind.__name__)
                    self.assertGreater(b.torso, 0.6)

    def test_each_kind_does_what_it_is_named_for(self):
        def turned(bodies):
            return max(b.yaw for b in bodies) - min(b.yaw for b in bodies)

        def walked(bodies):
            return sum(math.hypot(b.x - a.x, b.z - a.z) for a, b in zip(bodies, bodies[1:]))

        self.assertGreater(turned(bodies_of(kinds.circles)), 300)
        self.assertGreater(turned(bodies_of(kinds.turns)), 90)
        self.assertGreater(walked(bodies_of(kinds.paces)), 4)
        self.assertGreater(walked(bodies_of(kinds.dances)), 1)
        for kind in (kinds.crouches, kinds.sits):
            heights = [b.torso for b in bodies_of(kind)]
            self.assertGreater(max(heights) - min(heights), 0.2)
        self.assertLess(walked(bodies_of(kinds.idles)), 1.5)


if __name__ == "__main__":
    unittest.main()
