#!/usr/bin/env python3
"""Shows how mutate.py chooses, tries, remembers and reports, without compiling anything."""

import argparse
import io
import contextlib
import os
import pathlib
import sys
import time
import unittest

import build_tree
import mutate
import mutation_journal
import mutation_report
import mutation_workshop
import mutations
import test_project
from mutation_workshop import TestRun

CODE = "bool f(int a) {\n  return a < 3;\n}\n"


class FakeShop:
    """Catches every mutation but those for which `outcome` says otherwise."""

    def __init__(self, outcome=lambda text: "caught"):
        self.outcome, self.tried, self.restored = outcome, [], []

    def attempt(self, file, text, own, others):
        self.tried.append(text)
        return {"outcome": self.outcome(text), "by": own[0].program, "own": True}

    def restore(self, file, text):
        self.restored.append(file)


class MutateTest(test_project.ProjectTestCase):
    def setUp(self):
        super().setUp()
        self.write("model/motion/clip.cc", text=CODE)
        self.target("duet_torch", [])
        self.target("duet_motion", ["model/motion/clip.cc"])
        self.target("duet_network", ["model/network/lstm.cc"], private=["duet_torch"])
        self.target("motion_test", ["tests/motion/clip_test.cc"], kind="EXECUTABLE",
                    private=["duet_motion", "GTest::gtest_main"])
        self.target("cli_test", ["tests/client/cli_test.cc"], kind="EXECUTABLE",
                    private=["duet_motion", "GTest::gtest_main"])
        self.table = build_tree.read_targets(self.build_dir)
        self.rooms = mutate.rooms_of(self.table, self.root)

    def run_room(self, shop, wanted=100):
        journal = mutation_journal.Journal(self.root / "journal.jsonl", self.root)
        tests = {("duet_motion", "model/motion/clip.cc"): ([TestRun("motion_test")], [])}
        run = mutate.Run([shop], journal, self.table, tests)
        drawn = mutate.draw("model/motion", self.rooms["model/motion"], self.root, seed=1)
        with contextlib.redirect_stdout(io.StringIO()):
            return run.room("model/motion", self.rooms["model/motion"], drawn, wanted)

    def test_rooms_are_folders_of_torch_free_libraries(self):
        self.assertEqual(self.rooms, {"model/motion": {"model/motion/clip.cc": "duet_motion"}})

    def test_draw_depends_on_the_seed_alone(self):
        def draw(seed):
            return mutate.draw("model/motion", self.rooms["model/motion"], self.root, seed)
        self.assertEqual(draw(1), draw(1))
        self.assertTrue(any(draw(1) != draw(seed) for seed in range(2, 9)))

    def test_tests_of_the_own_folder_come_first(self):
        self.assertEqual(
            mutation_workshop.tests_for(self.table, "duet_motion", "model/motion/clip.cc"),
            ([TestRun("motion_test")], [TestRun("cli_test")]))

    def test_programs_that_start_one_with_the_library_count(self):
        self.target("server", ["server/main.cc"], kind="EXECUTABLE", private=["duet_motion"])
        self.target("process_test", ["tests/integration/process_test.cc"], kind="EXECUTABLE",
                    private=["GTest::gtest_main"], runs=["server"])
        self.target("trainer", ["model/main.cc"], kind="EXECUTABLE",
                    private=["duet_motion", "duet_torch"])
        self.target("trainer_test", ["tests/integration/trainer_test.cc"], kind="EXECUTABLE",
                    private=["GTest::gtest_main"], runs=["trainer"])
        _, others = mutation_workshop.tests_for(build_tree.read_targets(self.build_dir),
                                                "duet_motion", "model/motion/clip.cc")
        self.assertEqual(others, [TestRun("cli_test"), TestRun("process_test")])

    def test_own_suites_of_a_shared_program_come_before_the_rest_of_it(self):
        self.write("tests/motion/clip_test.cc",
                   text="TEST(Clip, Ends) {}\nTEST_P(Rates, Hold) {}\n")
        self.write("tests/other/pose_test.cc", text="TEST(Pose, Stands) {}\n")
        self.target("both_test", ["tests/motion/clip_test.cc", "tests/other/pose_test.cc"],
                    kind="EXECUTABLE", private=["duet_motion", "GTest::gtest_main"])
        own, others = mutation_workshop.tests_for(build_tree.read_targets(self.build_dir),
                                                  "duet_motion", "model/motion/clip.cc", self.root)
        self.assertEqual(own, [TestRun("both_test", "Clip.*:*/Clip.*:Clip/*:"
                                                    "Rates.*:*/Rates.*:Rates/*"),
                               TestRun("motion_test")])
        self.assertEqual(others, [TestRun("both_test"), TestRun("cli_test")])

    def test_every_mutation_is_tried_and_the_file_restored(self):
        shop = FakeShop()
        results = self.run_room(shop)
        self.assertEqual(len(results), len(mutations.mutations(CODE)))
        self.assertEqual({result["outcome"] for result in results}, {"caught"})
        self.assertNotIn(CODE, shop.tried)
        self.assertEqual(shop.restored, ["model/motion/clip.cc"])

    def test_file_is_restored_after_an_interruption(self):
        def interrupt(_):
            raise KeyboardInterrupt
        shop = FakeShop(interrupt)
        with self.assertRaises(KeyboardInterrupt):
            self.run_room(shop)
        self.assertEqual(shop.restored, ["model/motion/clip.cc"])

    def test_what_does_not_compile_is_replaced_by_the_next_draw(self):
        every = len(mutations.mutations(CODE))
        outcomes = iter(["invalid"] * (every - 2) + ["caught"] * 2)
        self.assertEqual(len(self.run_room(FakeShop(lambda _: next(outcomes)), wanted=2)), 2)

    def test_what_is_known_is_not_tried_again(self):
        first = self.run_room(FakeShop())
        again = FakeShop()
        self.assertEqual(self.run_room(again), first)
        self.assertEqual(again.tried, [])

    def test_changed_file_is_tried_again(self):
        self.run_room(FakeShop())
        self.write("model/motion/clip.cc", text=CODE.replace("3", "4"))
        again = FakeShop()
        self.run_room(again)
        self.assertTrue(again.tried)

    def test_survivors_are_tried_again_after_any_change(self):
        survivors = self.run_room(FakeShop(lambda text: "survived" if ">=" in text else "caught"))
        self.assertEqual(sum(r["outcome"] == "survived" for r in survivors), 1)
        self.write("tests/motion/clip_test.cc", text="// a new test\n")
        again = FakeShop()
        self.run_room(again)
        self.assertEqual(len(again.tried), 1)

    def test_half_written_journal_is_read(self):
        first = self.run_room(FakeShop())
        with (self.root / "journal.jsonl").open("a") as journal:
            journal.write('{"key": "ab')
        self.assertEqual(self.run_room(FakeShop()), first)


class WorkshopTest(test_project.ProjectTestCase):
    def limited(self, code, wall_s=60, **limits):
        return mutation_workshop.limited([sys.executable, "-c", code],
                                         mutation_workshop.Limits(wall_s, **limits),
                                         dict(os.environ))

    def test_outcome_is_told_by_status_and_limit(self):
        self.assertEqual(self.limited("pass"), "passed")
        self.assertEqual(self.limited("raise SystemExit(1)"), "failed")
        self.assertEqual(self.limited("import time; time.sleep(600)", wall_s=0.2), "timeout")
        self.assertEqual(self.limited("while True: pass", wall_s=600, cpu_s=1), "timeout")
        self.assertEqual(self.limited("bytearray(1 << 32)", memory=1 << 30), "failed")

    def test_what_the_command_started_ends_with_it(self):
        mark = self.root / "child"
        code = (f"import subprocess, time; p = subprocess.Popen(['sleep', '600']); "
                f"open({str(mark)!r}, 'w').write(str(p.pid)); time.sleep(600)")
        wall_s = 0.2
        while not mark.exists() or not mark.read_text():  # a busy machine gets longer
            wall_s *= 2
            self.assertEqual(self.limited(code, wall_s), "timeout")
        child = pathlib.Path("/proc", mark.read_text(), "stat")
        deadline = time.monotonic() + 60
        with contextlib.suppress(FileNotFoundError):
            while child.read_text().split()[2] != "Z":
                self.assertLess(time.monotonic(), deadline, "the child lives on")

    def test_copy_follows_the_tree_and_leaves_equal_files_untouched(self):
        origin, copy = self.root / "origin", self.root / "copy"
        for name in ("kept.cc", "changed.cc", "gone.cc", ".git/x", "build/y"):
            (origin / name).parent.mkdir(parents=True, exist_ok=True)
            (origin / name).write_text("old")
        mutation_workshop.copy_tree(origin, copy)
        before = (copy / "kept.cc").stat().st_mtime_ns
        (origin / "changed.cc").write_text("new")
        (origin / "gone.cc").unlink()
        mutation_workshop.copy_tree(origin, copy)
        self.assertEqual(sorted(os.listdir(copy)), ["changed.cc", "kept.cc"])
        self.assertEqual((copy / "changed.cc").read_text(), "new")
        self.assertEqual((copy / "kept.cc").stat().st_mtime_ns, before)


class ReportTest(unittest.TestCase):
    def setUp(self):
        place = {"file": "model/a.cc", "line": 3, "before": "a && b", "after": "", "code": "x < y"}
        outcomes = ["caught", "timeout", "survived", "caught"]
        self.summary = mutation_report.Summary(
            {"model": [dict(place, outcome=outcome, own=outcome == "caught")
                       for outcome in outcomes]})

    def test_score_counts_time_limits_as_caught(self):
        self.assertEqual(self.summary.score, 75.0)
        self.assertIn("| `model` | 4 | 3 | 2 | 1 | 1 | 75.0 % |", self.summary.table())

    def test_survivors_are_named_with_the_change(self):
        options = argparse.Namespace(per_room=30, seed=1)
        page = self.summary.page(options, ["--rooms", "server/*"])
        self.assertIn("`scripts/mutate.py --rooms 'server/*'`", page)
        self.assertIn("| `model/a.cc:3` | <code>a &amp;&amp; b</code> | (nothing) | "
                      "<code>x &lt; y</code> |", page)


if __name__ == "__main__":
    unittest.main()
