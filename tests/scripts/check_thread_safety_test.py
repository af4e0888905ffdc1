#!/usr/bin/env python3
"""Shows that check_thread_safety.py passes code that locks and fails code that does not."""

import contextlib
import io
import shutil
import unittest

import check_thread_safety
import test_project

MUTEX = """#pragma once
class __attribute__((capability("mutex"))) Mutex {
 public:
  void Lock() __attribute__((acquire_capability()));
  void Unlock() __attribute__((release_capability()));
};
"""
COUNTER = """#pragma once
struct Counter {
  void Add();
  Mutex mutex;
  int count __attribute__((guarded_by(mutex))) = 0;
};
"""


@unittest.skipUnless(any(map(shutil.which, check_thread_safety.COMPILERS)), "no clang++")
class CheckThreadSafetyTest(test_project.ProjectTestCase):
    def setUp(self):
        super().setUp()
        self.write("server/mutex.h", text=MUTEX)
        self.write("server/counter.h", "server/mutex.h", text=COUNTER)

    def run_check(self, body):
        self.write("server/counter.cc", "server/counter.h",
                   text=f"void Counter::Add() {{{body}}}\n")
        self.compile_command("server/counter.cc")
        output = io.StringIO()
        with contextlib.redirect_stdout(output), contextlib.redirect_stderr(output):
            status = check_thread_safety.main([str(self.build_dir)])
        return status, output.getvalue()

    def test_locked_access_passes(self):
        status, output = self.run_check("mutex.Lock(); ++count; mutex.Unlock();")
        self.assertEqual(status, 0, output)
        self.assertIn("1 files in 1 compilations, 0 of which failed", output)

    def test_unlocked_access_fails(self):
        status, output = self.run_check("++count;")
        self.assertEqual(status, 1)
        self.assertIn("requires holding mutex", output)

    def test_forgotten_unlock_fails(self):
        self.assertEqual(self.run_check("mutex.Lock(); ++count;")[0], 1)

    def test_files_of_a_batch_are_checked_together(self):
        self.write("server/first.cc", "server/counter.h", text="int First(Counter& counter) { return counter.count; }\n")
        self.write("server/second.cc", "server/counter.h", text="int Second(Counter& counter) { return counter.count; }\n")
        self.batch("server/first.cc", "server/second.cc")
        status, output = self.run_check("mutex.Lock(); ++count; mutex.Unlock();")
        self.assertEqual(status, 1)
        self.assertIn("server/first.cc", output)
        self.assertIn("server/second.cc", output)
        self.assertIn("3 files in 2 compilations, 1 of which failed", output)

    def test_nothing_to_check_is_a_failure(self):
        self.write("server/mutex.h", text="#pragma once\nclass Mutex {};\n")
        with self.assertRaises(SystemExit):
            self.run_check("")


if __name__ == "__main__":
    unittest.main()
