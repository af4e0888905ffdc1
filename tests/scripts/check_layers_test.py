#!/usr/bin/env python3
"""Shows that check_layers.py lets through what the layers allow and fails on what they do not."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

import check_layers

CHECKER = pathlib.Path(__file__).resolve().parents[2] / "scripts/check_layers.py"


class CheckLayersTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        self.write("model/motion/clip.h")
        self.write("model/engine/synthesizer.h", "model/motion/clip.h")
        self.write("model/network/generator.h", "torch/torch.h", "model/motion/clip.h")
        self.write("model/evaluation/judge/judge.h", "model/engine/synthesizer.h")
        self.write("model/evaluation/judge/judge.cc", "model/evaluation/judge/judge.h",
                   "model/network/generator.h")
        self.write("server/service/service.h", "grpcpp/grpcpp.h", "model/engine/synthesizer.h")
        self.write("model/cpu_engine/cpu_synthesizer.h", "model/engine/synthesizer.h")
        self.write("server/program/main.cc", "server/service/service.h",
                   "model/cpu_engine/cpu_synthesizer.h")
        self.write("model/evaluation/program/main.cc", "model/engine/synthesizer.h",
                   "model/evaluation/judge/judge.h")
        self.write("client/client.cc", "duet/v1/synthesis.grpc.pb.h", "model/motion/clip.h")

    def write(self, path, *includes):
        file = self.root / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text("".join(f"#include <{i}>\n" for i in includes), encoding="utf-8")

    def violations(self):
        return list(check_layers.check(self.root))

    def assert_violation(self, start, *parts):
        violations = self.violations()
        self.assertEqual(len(violations), 1, violations)
        self.assertTrue(violations[0].startswith(start), violations[0])
        for part in parts:
            self.assertIn(part, violations[0])

    def test_allowed_includes_pass(self):
        self.assertEqual(self.violations(), [])

    def test_what_a_layer_must_not_include_is_found(self):
        self.write("server/service/limits.h")
        for path, include, parts in (
                ("model/motion/inner.h", "model/engine/synthesizer.h", ('"motion"', '"engine"', "it sees base")),
                ("model/motion/wire.cc", "grpcpp/grpcpp.h", ("reaches rpc",)),
                ("model/motion/wire.cc", "duet/v1/motion.pb.h", ("reaches rpc",)),
                ("model/motion/limits.cc", "server/service/limits.h", ('"service"',)),
                ("server/service/warm_up.cc", "torch/torch.h", ("reaches torch",)),
                ("server/registry/registry.cc", "model/cpu_engine/cpu_synthesizer.h", ('"cpu engine"',)),
                ("server/program/torch.cc", "model/evaluation/judge/judge.h", ('"judge"',)),
                ("client/call.cc", "model/engine/synthesizer.h", ('"client"', '"engine"')),
                ("client/call.cc", "model/engine/made_while_building.h", ('"engine"',)),
                ("model/new_idea/idea.h", "cmath", ("expected a folder of a layer",)),
                ("model/formats/flat/csv.h", "model/formats/bvh/bvh_document.h", ('"flat formats"', '"bvh format"'))):
            with self.subTest(path=path, include=include):
                self.write(path, include)
                self.assert_violation(f"{path}:1:", *parts)
                (self.root / path).unlink()

    def test_torch_must_not_leak_through_a_header(self):
        self.write("model/evaluation/judge/judge.h", "model/network/generator.h")
        self.assertEqual([v.split(" reaches torch by ") for v in self.violations()], [
            ['model/evaluation/judge/judge.h:1: layer "judge"',
             "model/network/generator.h -> torch/torch.h"],
            ['model/evaluation/program/main.cc:2: layer "evaluation program"',
             "model/evaluation/judge/judge.h -> model/network/generator.h -> "
             "torch/torch.h"]])

    def test_a_source_may_reach_what_its_header_may_not(self):
        self.write("model/evaluation/judge/judge.h", "torch/torch.h")
        self.assertTrue(any(
            v.startswith('model/evaluation/judge/judge.h:1: layer "judge" reaches torch')
            for v in self.violations()))

    def test_namespace_is_the_folder_s_path(self):
        clip = self.root / "model/motion/clip.h"
        clip.write_text("namespace duet::motion {\n}\n", encoding="utf-8")
        self.assertEqual(self.violations(), [])
        clip.write_text("namespace duet::motion::HWY_NAMESPACE {\n}\n", encoding="utf-8")
        self.assertEqual(self.violations(), [])
        clip.write_text("#include <cmath>\nnamespace duet {\n}\n", encoding="utf-8")
        self.assert_violation("model/motion/clip.h:2:", "namespace: expected duet::motion, got duet")

    def test_a_tool_of_contrib_may_include_every_layer(self):
        self.write("contrib/load/tests/load_test.cc", "contrib/load/load.h", "tests/support/poses.h")
        load = self.root / "contrib/load/load.h"
        load.write_text("#include <torch/torch.h>\n#include <model/engine/synthesizer.h>\n"
                        "namespace duet::contrib::load {\n}\n", encoding="utf-8")
        self.assertEqual(self.violations(), [])
        load.write_text("namespace duet::load {\n}\n", encoding="utf-8")
        self.assert_violation("contrib/load/load.h:1:", "expected duet::contrib::load, got duet::load")

    def test_nothing_but_a_tool_includes_the_tool(self):
        self.write("contrib/load/load.h")
        for path in ("client/client.cc", "tests/client/client_test.cc", "benchmarks/call_cost.cc",
                     "contrib/capture/capture.cc"):
            self.write(path, "cmath", "contrib/load/load.h")
            self.assert_violation(f"{path}:2:", "includes contrib/load/load.h of contrib/load")
            (self.root / path).unlink()

    def test_exit_status(self):
        def run():
            return subprocess.run([sys.executable, CHECKER, self.root], capture_output=True,
                                  check=False, text=True)
        self.assertEqual(run().returncode, 0)
        self.write("server/service/warm_up.cc", "torch/torch.h")
        failed = run()
        self.assertEqual(failed.returncode, 1)
        self.assertIn("server/service/warm_up.cc:1:", failed.stderr)


if __name__ == "__main__":
    unittest.main()
