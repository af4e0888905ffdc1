#!/usr/bin/env python3
"""Shows how mutate.py chooses, tries and remembers, without compiling anything."""

import contextlib
import io
import os
import subprocess
import sys
import unittest

import build_tree
import mutate
import mutation_workshop
import mutations
import test_project

CODE = "bool f(int a) {\n  return a < 3;\n}\n"
FILE = "model/motion/clip.cc"


class MutateTest(test_project.ProjectTestCase):
    def setUp(self):
        super().setUp()
        self.write(FILE, text=CODE)
        self.target("duet_torch", [])
        self.target("duet_motion", [FILE])
        self.target("duet_network", ["model/network/lstm.cc"], private=["duet_torch"])
        self.program("motion_test", ["tests/motion/clip_test.cc"])
        self.program("cli_test", ["tests/client/cli_test.cc"])
        self.outcomes, self.tried = lambda text: "caught", []

    def program(self, name, sources, private=("duet_motion",), runs=()):
        self.target(name, sources, kind="EXECUTABLE", private=[*private, "GTest::gtest_main"], runs=runs)

    def rooms(self):
        return mutate.rooms_of(build_tree.read_targets(self.build_dir), self.root)

    def draw(self, *arguments):
        return mutate.draw(mutate.parse(arguments), self.rooms(), self.root)

    def judges(self):
        return mutate.tests_for(build_tree.read_targets(self.build_dir), "duet_motion", FILE)

    def attempt(self, _, text, programs):
        """In place of Workshop.attempt."""
        self.assertEqual(programs, ["motion_test"])
        self.tried.append(text)
        return self.outcomes(text)

    def run_room(self, wanted=100):
        self.tried.clear()
        run = mutate.Run([self], self.root / "caught", self.root, {FILE: ["motion_test"]})
        with contextlib.redirect_stdout(io.StringIO()):
            return run.rooms(self.draw(), wanted)["model/motion"]

    def test_rooms_are_folders_of_torch_free_libraries(self):
        self.assertEqual(self.rooms(), {"model/motion": {FILE: "duet_motion"}})

    def test_draw_depends_only_on_the_seed(self):
        self.assertEqual(self.draw("--seed", "1"), self.draw("--seed", "1"))
        self.assertTrue(any(self.draw() != self.draw("--seed", str(seed)) for seed in range(2, 9)))

    def test_lines_and_rooms_can_be_chosen(self):
        self.assertEqual(self.draw("--at", f"{FILE}:2"), self.draw("--rooms", "model/*"))
        for nothing in (("--at", f"{FILE}:1"), ("--rooms", "server/*")):
            with self.assertRaises(SystemExit):
                self.draw(*nothing)

    def test_programs_of_the_own_folder_come_first_and_programs_that_start_one_count(self):
        self.target("server", ["server/main.cc"], kind="EXECUTABLE", private=["duet_motion"])
        self.program("process_test", ["tests/integration/process_test.cc"], (), ["server"])
        self.assertEqual(self.judges(), ["motion_test", "cli_test", "process_test"])

    def test_libtorch_programs_of_the_own_folder_come_last_and_others_do_not_count(self):
        self.program("parity_test", ["tests/motion/parity_test.cc"], ["duet_motion", "duet_torch"])
        self.program("trainer_test", ["tests/training/trainer_test.cc"], ["duet_motion", "duet_torch"])
        self.program("helper_test", ["tests/motion/parity_test.cc"], ["duet_torch"])
        self.assertEqual(self.judges(), ["motion_test", "cli_test", "parity_test"])

    def test_every_mutation_is_tried(self):
        self.assertTrue(all(self.run_room()))
        self.assertEqual(len(self.tried), len(mutations.mutations(CODE)))
        self.assertNotIn(CODE, self.tried)

    def test_next_draw_replaces_what_does_not_compile(self):
        outcomes = iter(["invalid"] * (len(mutations.mutations(CODE)) - 2) + ["caught"] * 2)
        self.outcomes = lambda _: next(outcomes)
        self.assertEqual(len(self.run_room(wanted=2)), 2)

    def test_caught_mutation_counts_until_the_file_changes(self):
        self.outcomes = lambda text: "survived" if ">=" in text else "caught"
        first = self.run_room()
        self.assertEqual((self.run_room(), len(self.tried)), (first, 1))
        self.write(FILE, text=CODE.replace("3", "4"))
        self.run_room()
        self.assertEqual(len(self.tried), len(mutations.mutations(CODE)))

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


class WorkshopTest(test_project.ProjectTestCase):
    def test_outcome_follows_from_status_and_limit(self):
        for code, limit_s, passes in ("", 60, True), ("exit(1)", 60, False), ("import time; time.sleep(600)", 0.2, False):
            command = [sys.executable, "-c", code]
            self.assertEqual(mutation_workshop.passes(command, limit_s, dict(os.environ)), passes, code)

    def test_copy_follows_the_tree_and_only_one_file_is_mutated(self):
        self.write("CMakeLists.txt", text="cmake_minimum_required(VERSION 3.25)\nproject(none NONE)\n")
        for name in ("a.cc", "b.cc"):
            self.write(name, text="old")
        subprocess.run(["git", "init", "-q", self.root], check=True)
        shop = mutation_workshop.Workshop(self.root / ".git/shop", self.root)
        shop.prepare()
        before = (shop.source_dir / "a.cc").stat().st_mtime_ns
        (self.root / "b.cc").write_text("new")
        shop.prepare()
        self.assertEqual((shop.source_dir / "a.cc").stat().st_mtime_ns, before)
        for name, texts in (("a.cc", ["broken", "new"]), ("b.cc", ["old", "broken"])):
            self.assertEqual(shop.attempt(name, "broken", []), "survived")
            self.assertEqual([(shop.source_dir / file).read_text() for file in ("a.cc", "b.cc")], texts)


if __name__ == "__main__":
    unittest.main()
