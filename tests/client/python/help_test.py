"""help() describes every argument of the public API."""

import inspect
import pydoc
import unittest

import support  # noqa: F401
import duet_motion as duet

# Created by the package, not by its callers.
RESULTS = {"FieldViolation", "FollowerChunk", "FrameRun", "LiveHeader",
           "LiveNotice", "LivePart", "LiveSession", "LiveSummary", "ModelDetails", "ModelInfo", "MotionGrade", "MotionSet", "Outcome",
           "PaddedBatch", "RequestLimits", "SetItem", "SynthesisResult", "SynthesisStream", "Timings"}


def public_callables():
    for home, prefix in ((duet, "duet"), (duet.aio, "duet.aio")):
        for name in duet.__all__ if home is duet else ("Client", "LiveSession"):
            thing = getattr(home, name)
            if inspect.isclass(thing):
                if name not in RESULTS and not issubclass(thing, Exception):
                    yield f"{prefix}.{name}", thing
                for method, value in inspect.getmembers(thing, callable):
                    if not method.startswith("_") and not issubclass(thing, Exception):
                        yield f"{prefix}.{name}.{method}", value
            elif inspect.isfunction(thing):
                yield f"{prefix}.{name}", thing


class HelpTest(unittest.TestCase):
    def test_every_argument_is_described(self):
        checked = 0
        for name, thing in public_callables():
            text = inspect.getdoc(thing) or ""
            for argument in inspect.signature(thing).parameters:
                if argument in ("self", "value") or name.endswith((".index", ".count")):
                    continue  # of Sequence
                checked += 1
                with self.subTest(thing=name, argument=argument):
                    self.assertRegex(text, rf"(?m)^    {argument}: \S")
        self.assertGreater(checked, 90)

    def test_help_of_synthesize_has_shapes_units_and_errors(self):
        text = pydoc.render_doc(duet.Client.synthesize, renderer=pydoc.plaintext)
        for words in ("leader: the leader's motion", "[frames, joints, 3]",
                      "labels: weights by interaction class",
                      "follower_start: the follower's position", "[joints, 3]", "timeout: seconds",
                      "DuetError: the call failed", "ValueError:"):
            self.assertIn(words, text)

    def test_version_has_three_numbers(self):
        self.assertRegex(duet.__version__, r"^\d+\.\d+\.\d+$")


if __name__ == "__main__":
    unittest.main()
