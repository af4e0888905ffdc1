"""What a server tells of itself: to promtool, and to whoever reads its log."""

import re
import shutil
import unittest

import tools
from stubs import grpc, synthesis_pb2, synthesis_pb2_grpc

RULES = tools.SOURCE / "deploy" / "prometheus"
TRACE, PARENT = "4bf92f3577b34da6a3ce929d0e0e4736", "00f067aa0ba902b7"  # the W3C's own example
NEEDS_PROMTOOL = unittest.skipIf(shutil.which("promtool") is None, "no promtool; install the package prometheus")


class ObservabilityTest(tools.FolderTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.server = tools.Server(metrics="127.0.0.1:0")
        cls.addClassCleanup(cls.server.stop)
        tools.duet("synthesize", "--server", cls.server.address, "--leader", tools.sample("kick"), "--label", "kick=1",
                   "--out", cls.folder / "pair.csv", "--quiet").check_returncode()
        cls.metrics = cls.server.page("/metrics")[1]
        cls.told = {line.split()[2] for line in cls.metrics.splitlines() if line.startswith("# TYPE ")}

    @NEEDS_PROMTOOL
    def test_promtool_finds_nothing_wrong_with_the_metrics(self):
        checked = tools.run("promtool", "check", "metrics", input=self.metrics)
        self.assertEqual((checked.returncode, checked.stdout, checked.stderr), (0, "", ""))

    @NEEDS_PROMTOOL
    def test_promtool_finds_nothing_wrong_with_the_rules(self):
        for arguments in (("check", "rules", RULES / "rules.yml"),
                          ("check", "config", RULES / "prometheus.yml"),
                          ("test", "rules", RULES / "rules_test.yml")):
            checked = tools.run("promtool", *arguments)
            self.assertEqual(checked.returncode, 0, checked.stdout + checked.stderr)

    def test_queried_metrics_exist(self):
        asked = set()
        for file in ("prometheus/rules.yml", "grafana/duet.json",
                     "kubernetes/components/scale_by_keda/scaled_object.yaml"):
            text = (tools.SOURCE / "deploy" / file).read_text(encoding="utf-8")
            text = re.sub(r"^\s*-? *(name|as): .*$", "", text, flags=re.MULTILINE)
            # A colon stands in what rules record.
            names = set(re.findall(r"(?<![:\w])(?:duet|grpc_server)_\w+(?![:\w])", text))
            self.assertGreater(len(names), 0, file)
            asked |= {re.sub(r"_(bucket|count|sum)$", "", name) for name in names}
        # These two are there once a call was refused, and with TLS.
        self.assertEqual(asked - self.told, {
            "duet_refusals_total", "duet_tls_certificate_expiry_timestamp_seconds"})

    def test_every_metric_is_in_the_document(self):
        document = (tools.SOURCE / "docs" / "metrics.md").read_text(encoding="utf-8")
        self.assertEqual({name for name in self.told if f"`{name}`" not in document}, set())

    def test_a_callers_trace_is_in_its_line_and_comes_back(self):
        channel = grpc.insecure_channel(self.server.address)
        self.addCleanup(channel.close)
        stub = synthesis_pb2_grpc.MotionSynthesisStub(channel)
        given = f"00-{TRACE}-{PARENT}-01"

        def returned(metadata):
            _, call = stub.ListModels.with_call(synthesis_pb2.ListModelsRequest(),
                                                timeout=tools.RUN_SECONDS, metadata=metadata)
            return dict(call.trailing_metadata()).get("traceparent")

        self.assertEqual(returned((("traceparent", given),)), given)
        self.assertIsNone(returned(None))
        self.assertIsNone(returned((("traceparent", given[:-1]),)), "malformed")

        def logged():
            return [(line.get("trace_id"), line.get("traceparent")) for line in self.server.events("call")
                    if line["method"] == "ListModels"]
        tools.wait_until(lambda: len(logged()) == 3, "the calls are logged")
        self.assertEqual(logged(), [(TRACE, given), (None, None), (None, None)])


if __name__ == "__main__":
    tools.main()
