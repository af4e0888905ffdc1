"""The fuzzer of live sessions (live_fuzzer.py): that its plans are what they claim, that it finds what it is for, and
that it finds nothing in the server.

    live_fuzz_test.py BUILD     $DUET_LIVE_SECONDS of fuzzing, 30 if absent"""

import contextlib
import io
import json
import os
import pathlib
import sys
import tempfile
import unittest
import unittest.mock

import fuzzing
import live_fuzzer
import tools
from live_fuzz import messages, mistakes, plans, player, verdicts

BUILD = sys.argv[1]
SECONDS = os.environ.get("DUET_LIVE_SECONDS", "30")
del sys.argv[1]
ROOT = "torso"
PLANS = [plans.plan(1, number) for number in range(2000)]


def fuzz(*words):
    """Exit status and what was printed."""
    with contextlib.redirect_stdout(io.StringIO()) as printed:
        status = live_fuzzer.main([BUILD, *words])
    return status, printed.getvalue()


def answer(frames=range(10), **fields):
    """A good answer to a plan of that many frames."""
    made = {index: [float(index), 1.0, 0.5] for index in frames}
    summary = {"frame_count": len(made), "gap_frames": 0, "late_frames": 0, "skipped_frames": 0}
    return player.Answer(**{"frames": made, "summary": summary, **fields})


def of_ten_frames(**fields):
    return {**PLANS[0], "history": None, "lead_in": 0, "steps": [["frames", 0, 10], ["wait"]],
            "start_mistake": None, "start": {}, **fields}


class PlansTest(unittest.TestCase):
    def test_a_plan_is_a_function_of_its_seed_and_number(self):
        self.assertEqual([plans.plan(1, number) for number in range(50)], PLANS[:50])
        self.assertNotEqual([plans.plan(2, number) for number in range(50)], PLANS[:50])
        self.assertEqual(json.loads(json.dumps(PLANS)), PLANS)

    def test_plans_reach_every_rate_unit_and_mistake(self):
        def values(name):
            return {made[name] for made in PLANS}
        self.assertLess(min(values("rate")), 11)
        self.assertGreater(max(values("rate")), 239)
        self.assertGreater(sum(rate % 1 != 0 for rate in values("rate")), 500)
        self.assertEqual(values("unit"), set(plans.UNITS))
        self.assertEqual(values("model"), set(plans.CLASSES))
        self.assertEqual(values("follower_start"), {None, "root", "pose"})
        self.assertEqual(values("end"), {"finish", "cancel"})
        self.assertGreater(len(values("start_mistake")), len(mistakes.START) * 0.8)
        later = {step[1] for made in PLANS for step in made["steps"] if step[0] == "mistake"}
        self.assertGreater(len(later), len(mistakes.LATER) * 0.8)

    def test_every_mistake_has_a_message_and_an_expected_refusal(self):
        wording = messages.Messages(of_ten_frames(), tools.JOINTS, ROOT)
        good = wording.step(["frames", 7, 1], 7)
        for name in mistakes.LATER:
            step = ["mistake", name]
            self.assertNotEqual(wording.step(step, 7), good, name)
            self.assertIsNotNone(mistakes.expected(of_ten_frames(steps=[step])))
        for name in mistakes.START:
            made = of_ten_frames(start_mistake=name)
            self.assertNotEqual(messages.Messages(made, tools.JOINTS, ROOT).start(), wording.start(), name)
            self.assertIsNotNone(mistakes.expected(made))
        self.assertIsNone(mistakes.expected(of_ten_frames()))



class VerdictsTest(unittest.TestCase):
    def test_answers_are_judged_by_their_plans(self):
        made, endless, uncounted = of_ten_frames(), answer(), answer(notices=[("gap", 0, 1)])
        endless.frames[3][0] = float("inf")
        for good in (answer(), answer(code="RESOURCE_EXHAUSTED")):
            self.assertIsNone(verdicts.of_answer(made, good))
        for wrong in (answer(range(9)), answer(range(1, 10)), answer(range(11)), endless, answer(summary=None), uncounted,
                      answer(code="INTERNAL"), answer(code="INVALID_ARGUMENT"), answer(code="UNAVAILABLE")):
            self.assertIsNotNone(verdicts.of_answer(made, wrong), wrong)
        self.assertIsNotNone(verdicts.of_answer(of_ten_frames(start={"reply_rotations": True}), answer()))

    def test_refusals_must_name_the_field(self):
        made, field = of_ten_frames(steps=[["mistake", "not finite"]]), "frames.positions[4]"
        self.assertIsNone(verdicts.of_answer(made, answer(code="INVALID_ARGUMENT", fields=[field])))
        for code, fields in (("INVALID_ARGUMENT", []), ("INVALID_ARGUMENT", [field, "payload"]), ("INTERNAL", [field]),
                             ("OK", [])):
            self.assertIsNotNone(verdicts.of_answer(made, answer(code=code, fields=fields)))

    def test_other_frames_are_found_unless_evaluations_were_skipped(self):
        self.assertIsNone(verdicts.of_repeat(answer(), answer()))
        self.assertIsNone(verdicts.of_resumed(answer(), answer(range(4, 10), first_frame=4)))
        other, skipped = answer(), answer()
        other.frames[6][1] += 1e-7
        skipped.summary["skipped_frames"] = 1
        self.assertIn("frame 6", verdicts.of_repeat(answer(), other))
        self.assertIn("resumed", verdicts.of_resumed(answer(), other))
        turned = answer(rotations={3: [1.0]})
        self.assertIn("rotations", verdicts.of_repeat(answer(rotations={3: [0.5]}), turned))
        self.assertIn("rig", verdicts.of_resumed(answer(rig=b"a"), answer(rig=b"b")))
        self.assertTrue(verdicts.can_compare(answer(), answer()))
        self.assertFalse(verdicts.can_compare(answer(), skipped))


class FindingsTest(unittest.TestCase):
    """That the fuzzer reports a server that fails, and keeps the plans."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.patch(fuzzing, "REPORT_SECONDS", 1)

    def patch(self, *arguments):
        patched = unittest.mock.patch.object(*arguments)
        patched.start()
        self.addCleanup(patched.stop)

    def find(self, *words):
        status, printed = fuzz("--out", self.folder, "--seed", "5", "--from", "1", "--rounds", "1", *words)
        self.assertEqual(status, 1, printed)
        self.assertIn("--seed 5 --from 1 --rounds 1", printed)
        kept = json.loads((pathlib.Path(self.folder) / "plans.json").read_text())
        self.assertEqual(kept["plans"], [plans.plan(5, number) for number in range(4, 8)])
        return printed

    def test_changed_answer_is_reported(self):
        real = player.Player.play

        def play(one, made):
            got = real(one, made)
            got.frames.popitem()
            return got
        self.patch(player.Player, "play", play)
        self.assertIn("expected the frames", self.find())


class ServerTest(unittest.TestCase):
    def test_server_keeps_its_promises(self):
        status = live_fuzzer.main([BUILD, "--seconds", SECONDS, "--memory", str(600 * tools.MEMORY_FACTOR),
                                   "--out", f"{BUILD}/live"])
        self.assertEqual(status, 0)


if __name__ == "__main__":
    tools.main()
