#!/usr/bin/env python3
"""Shows how mutate.py chooses, tries, remembers and reports, without compiling anything."""

import argparse
import contextlib
import io
import os
import pathlib
import sys
import time
import unittest

import build_tree
import mutate
import mutation_workshop
import mutations
import test_project
from mutation_workshop import TestRun

CODE = "bool f(int a) {\n  return a < 3;\n}\n"
FILE = "model/motion/clip.cc"


class MutateTest(test_project.ProjectTestCase):
    def setUp(self):
        super().setUp()
        self.write(FILE, text=CODE)
        self.write("tests/motion/clip_test.cc", text="TEST(Clip, Ends) {}\nTEST_P(Rates, Hold) {}\n")
        self.target("duet_torch", [])
        self.target("duet_motion", [FILE])
        self.target("duet_network", ["model/network/lstm.cc"], private=["duet_torch"])
        self.program("motion_test", ["tests/motion/clip_test.cc"])
        self.program("cli_test", ["tests/client/cli_test.cc"])
        self.outcomes, self.tried = lambda text: "caught", []

    def program(self, name, sources, private=("duet_motion",), runs=()):
        for source in sources:
            if not (self.root / source).exists():
                self.write(source, text="TEST(Other, Stands) {}\n")
        self.target(name, sources, kind="EXECUTABLE", private=[*private, "GTest::gtest_main"], runs=runs)

    def rooms(self):
        return mutate.rooms_of(build_tree.read_targets(self.build_dir), self.root)

    def draw(self, seed=1):
        return mutate.draw("model/motion", self.rooms()["model/motion"], self.root, seed)

    def judges(self):
        return mutate.tests_for(build_tree.read_targets(self.build_dir), "duet_motion", FILE, self.root)

    def attempt(self, _, text, tiers):
        """In place of Workshop.attempt."""
        self.tried.append(text)
        return {"outcome": self.outcomes(text), "by": tiers[0][0].program, "own": True}

    def run_room(self, wanted=100):
        self.tried.clear()
        journal = mutate.Journal(self.root / "journal.jsonl", self.root)
        run = mutate.Run([self], journal, self.root, {FILE: ([TestRun("motion_test")], [], [])})
        with contextlib.redirect_stdout(io.StringIO()):
            return run.rooms({"model/motion": self.draw()}, wanted)["model/motion"]

    def test_rooms_are_folders_of_torch_free_libraries(self):
        self.assertEqual(self.rooms(), {"model/motion": {FILE: "duet_motion"}})

    def test_draw_depends_only_on_the_seed(self):
        self.assertEqual(self.draw(1), self.draw(1))
        self.assertTrue(any(self.draw(1) != self.draw(seed) for seed in range(2, 9)))

    def test_tests_of_the_own_folder_come_first_and_programs_that_start_one_count(self):
        self.target("server", ["server/main.cc"], kind="EXECUTABLE", private=["duet_motion"])
        self.program("process_test", ["tests/integration/process_test.cc"], (), ["server"])
        self.assertEqual(self.judges(), (
            [TestRun("motion_test")], [TestRun("cli_test"), TestRun("process_test")], []))

    def test_libtorch_programs_of_the_own_folder_come_last_and_others_do_not_count(self):
        self.program("parity_test", ["tests/motion/parity_test.cc"], ["duet_motion", "duet_torch"])
        self.program("trainer_test", ["tests/training/trainer_test.cc"], ["duet_motion", "duet_torch"])
        self.program("helper_test", ["tests/motion/parity_test.cc"], ["duet_torch"])
        self.assertEqual(self.judges()[2], [TestRun("parity_test")])

    def test_own_suites_of_a_shared_program_come_before_the_rest_of_it(self):
        self.program("both_test", ["tests/motion/clip_test.cc", "tests/other/pose_test.cc"])
        suites = "Clip.*:*/Clip.*:Clip/*:Rates.*:*/Rates.*:Rates/*"
        self.assertEqual(self.judges()[:2], ([TestRun("both_test", suites), TestRun("motion_test")],
                                                [TestRun("both_test"), TestRun("cli_test")]))

    def test_every_mutation_is_tried(self):
        self.assertEqual({result["outcome"] for result in self.run_room()}, {"caught"})
        self.assertEqual(len(self.tried), len(mutations.mutations(CODE)))
        self.assertNotIn(CODE, self.tried)

    def test_next_draw_replaces_what_does_not_compile(self):
        outcomes = iter(["invalid"] * (len(mutations.mutations(CODE)) - 2) + ["caught"] * 2)
        self.outcomes = lambda _: next(outcomes)
        self.assertEqual(len(self.run_room(wanted=2)), 2)

    def test_known_result_counts_until_the_file_changes(self):
        first = self.run_room()
        with (self.root / "journal.jsonl").open("a") as journal:
            journal.write('{"key": "ab')  # a stopped run
        self.assertEqual((self.run_room(), self.tried), (first, []))
        self.write(FILE, text=CODE.replace("3", "4"))
        self.run_room()
        self.assertTrue(self.tried)

    def test_survivors_are_tried_again_after_any_change(self):
        self.outcomes = lambda text: "survived" if ">=" in text else "caught"
        self.assertEqual(sum(result["outcome"] == "survived" for result in self.run_room()), 1)
        self.write("tests/motion/clip_test.cc", text="// a new test\n")
        self.run_room()
        self.assertEqual(len(self.tried), 1)

    def test_interruption_keeps_what_is_known(self):
        def interrupt(_):
            if len(self.tried) > 2:
                raise KeyboardInterrupt
            return "caught"
        self.outcomes = interrupt
        with self.assertRaises(KeyboardInterrupt):
            self.run_room()
        self.outcomes = lambda text: "caught"
        self.run_room()
        self.assertEqual(len(self.tried), len(mutations.mutations(CODE)) - 2)

    def test_lines_can_be_chosen(self):
        options = mutate.parse(["--jobs", "1", "--at", f"{FILE}:2"])
        self.assertEqual(mutate.chosen(options, self.rooms(), self.root), {"model/motion": self.draw()})
        with self.assertRaises(SystemExit):
            mutate.chosen(mutate.parse(["--jobs", "1", "--at", f"{FILE}:1"]), self.rooms(), self.root)

    def test_report_counts_time_limits_as_caught_names_survivors_and_keeps_the_text_above(self):
        place = {"file": "model/a.cc", "line": 3, "before": "a && b", "after": "", "code": "x < y"}
        results = {"model": [dict(place, outcome=outcome, own=outcome == "caught")
                             for outcome in ("caught", "timeout", "survived", "caught")]}
        report = self.root / "mutation.md"
        report.write_text(f"# Score\n{mutate.MARK}\nstale")
        options = argparse.Namespace(per_room=30, seed=1)
        mutate.write_report(report, mutate.page(results, options, ["--rooms", "server/*"], ["model/x"]))
        for part in ("# Score\n<!-- ", "`scripts/mutate.py --rooms 'server/*'`", "reaches them: `model/x`.",
                     "| `model` | 4 | 3 | 2 | 1 | 1 | 75.0 % |",
                     "| `model/a.cc:3` | <code>a &amp;&amp; b</code> | (nothing) | <code>x &lt; y</code> |"):
            self.assertIn(part, report.read_text())
        self.assertNotIn("stale", report.read_text())


class WorkshopTest(test_project.ProjectTestCase):
    def limited(self, code, wall_s=60, **limits):
        return mutation_workshop.limited([sys.executable, "-c", code],
                                         mutation_workshop.Limits(wall_s, **limits), dict(os.environ))

    def test_outcome_follows_from_status_and_limit(self):
        self.assertEqual(self.limited("pass"), "passed")
        self.assertEqual(self.limited("raise SystemExit(1)"), "failed")
        self.assertEqual(self.limited("import time; time.sleep(600)", wall_s=0.2), "timeout")
        self.assertEqual(self.limited("while True: pass", wall_s=600, cpu_s=1), "timeout")
        self.assertEqual(self.limited("bytearray(1 << 32)", memory=1 << 30), "failed")

    def test_processes_that_the_command_started_end_with_it(self):
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
                self.assertLess(time.monotonic(), deadline, "the child is still running")

    def test_mutated_file_is_restored_before_another_is_mutated(self):
        self.write("a.cc", text="a")
        self.write("b.cc", text="b")
        shop = mutation_workshop.Workshop(self.root / "build/shop", self.root)
        mutation_workshop.copy_tree(self.root, shop.source_dir)
        self.assertEqual(shop.attempt("a.cc", "broken", ([], [])), {"outcome": "survived"})
        shop.attempt("b.cc", "broken", ([], []))
        self.assertEqual([(shop.source_dir / name).read_text() for name in ("a.cc", "b.cc")],
                         ["a", "broken"])

    def test_copy_follows_the_tree_and_leaves_equal_files_untouched(self):
        origin, copy = self.root / "origin", self.root / "copy"
        for name in ("kept.cc", "changed.cc", "gone.cc", ".git/x", "build/y"):
            self.write(f"origin/{name}", text="old")
        mutation_workshop.copy_tree(origin, copy)
        before = (copy / "kept.cc").stat().st_mtime_ns
        (origin / "changed.cc").write_text("new")
        (origin / "gone.cc").unlink()
        mutation_workshop.copy_tree(origin, copy)
        self.assertEqual(sorted(os.listdir(copy)), ["changed.cc", "kept.cc"])
        self.assertEqual((copy / "changed.cc").read_text(), "new")
        self.assertEqual((copy / "kept.cc").stat().st_mtime_ns, before)


if __name__ == "__main__":
    unittest.main()
