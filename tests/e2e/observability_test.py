"""What a server tells of itself: to promtool and a real Prometheus, and to whoever reads its log."""

import json
import pathlib
import re
import shutil
import subprocess
import tempfile
import time
import unittest
import urllib.request

import tools

try:
    import grpc
except ImportError as error:
    tools.skip(f"{error}; install the package python3-grpcio")

PROTOS = ("duet/v1/model.proto", "duet/v1/motion.proto", "duet/v1/reaction.proto",
          "duet/v1/live.proto", "duet/v1/synthesis.proto")
RULES = tools.SOURCE / "deploy" / "prometheus"
TRACE, PARENT = "4bf92f3577b34da6a3ce929d0e0e4736", "00f067aa0ba902b7"  # the W3C's own example


def get(port, path):
    with urllib.request.urlopen(f"http://127.0.0.1:{port}{path}",
                                timeout=tools.RUN_SECONDS) as answer:
        return answer.read().decode()


def needs(program, package="prometheus"):
    return unittest.skipIf(shutil.which(program) is None,
                           f"no {program}; install the package {package}")


class MetricsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.server = tools.Server(metrics="127.0.0.1:0")
        cls.addClassCleanup(cls.server.stop)
        answer = tools.duet("synthesize", "--server", cls.server.address, "--leader",
                            tools.sample("kick"), "--label", "kick=1", "--out",
                            pathlib.Path(cls.new_folder()) / "pair.csv", "--quiet")
        assert answer.returncode == 0, answer.stderr

    @classmethod
    def new_folder(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        return folder.name

    @needs("promtool")
    def test_promtool_finds_nothing_wrong_with_the_metrics(self):
        checked = tools.run("promtool", "check", "metrics",
                            input=get(self.server.metrics_port, "/metrics"))
        self.assertEqual((checked.returncode, checked.stdout, checked.stderr), (0, "", ""))

    @needs("promtool")
    def test_promtool_finds_nothing_wrong_with_the_rules(self):
        for arguments in (("check", "rules", RULES / "rules.yml"),
                          ("check", "config", RULES / "prometheus.yml"),
                          ("test", "rules", RULES / "rules_test.yml")):
            checked = tools.run("promtool", *arguments)
            self.assertEqual(checked.returncode, 0, checked.stdout + checked.stderr)

    def told(self):
        """The metrics that the server has once it has answered a call."""
        text = get(self.server.metrics_port, "/metrics")
        return {line.split()[2] for line in text.splitlines() if line.startswith("# TYPE ")}

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
        self.assertEqual(asked - self.told(), {
            "duet_refusals_total", "duet_tls_certificate_expiry_timestamp_seconds"})

    def test_the_autoscaler_counts_the_queue_and_live_sessions(self):
        text = (tools.SOURCE / "deploy/kubernetes/components/scale_by_keda/scaled_object.yaml").read_text(encoding="utf-8")
        for metric in ("duet_queued_windows", "duet_places_in_use", "duet_max_calls"):
            self.assertIn(metric + "{", text)

    def test_every_metric_is_in_the_document(self):
        told = self.told()
        document = (tools.SOURCE / "docs" / "metrics.md").read_text(encoding="utf-8")
        self.assertEqual({name for name in told if f"`{name}`" not in document}, set())

    @needs("prometheus")
    def test_a_real_prometheus_scrapes_and_evaluates(self):
        folder = pathlib.Path(self.new_folder())
        shutil.copy(RULES / "rules.yml", folder)
        (folder / "prometheus.yml").write_text(json.dumps({
            "global": {"scrape_interval": "1s", "evaluation_interval": "1s"},
            "rule_files": ["rules.yml"],
            "scrape_configs": [{"job_name": "duet", "static_configs": [
                {"targets": [f"127.0.0.1:{self.server.metrics_port}"]}]}]}))
        port = tools.free_port()
        prometheus = subprocess.Popen(
            ["prometheus", f"--config.file={folder / 'prometheus.yml'}",
             f"--storage.tsdb.path={folder / 'data'}", f"--web.listen-address=127.0.0.1:{port}"],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

        def ask(path):
            try:
                return json.loads(get(port, path))["data"]
            except OSError:
                return None

        def value(query):
            data = ask(f"/api/v1/query?query={query}")
            return float(data["result"][0]["value"][1]) if data and data["result"] else None

        try:
            tools.wait_until(lambda: value("up") == 1, "a scrape")
            self.assertEqual(value("duet_build_info"), 1)
            self.assertGreater(value("duet_frames_total"), 0)
            self.assertGreater(value("process_resident_memory_bytes"), 1e7)
            tools.wait_until(lambda: value("instance:duet_calls:saturation") is not None,
                             "an evaluation of the rules")
            self.assertEqual(value("instance:duet_calls:saturation"), 0)
            tools.wait_until(
                lambda: {rule["health"] for group in ask("/api/v1/rules")["groups"]
                         for rule in group["rules"]} == {"ok"}, "every rule's evaluation")
            self.assertEqual(ask("/api/v1/alerts")["alerts"], [])
        finally:
            prometheus.terminate()
            prometheus.wait(timeout=tools.STOP_SECONDS)


class LogTest(unittest.TestCase):
    def start(self, *flags):
        server = tools.Server(*flags)
        self.addCleanup(server.stop)
        channel = grpc.insecure_channel(server.address)
        self.addCleanup(channel.close)
        return server, synthesis_pb2_grpc.MotionSynthesisStub(channel)

    def test_flood_of_rejections_is_counted_not_logged(self):
        server, stub = self.start("--log-refusals-per-second", "2")
        request = synthesis_pb2.GetModelRequest()
        request.model.name = "nobody"
        begin = time.monotonic()
        for _ in range(300):
            with self.assertRaises(grpc.RpcError):
                stub.GetModel(request, timeout=tools.RUN_SECONDS)
        seconds = time.monotonic() - begin

        def counted():
            return len(server.events("call")) + sum(
                line["calls"] for line in server.events("calls_not_logged"))

        tools.wait_until(lambda: counted() == 300, "every call's line or count")
        self.assertLessEqual(len(server.events("call")), 2 * (int(seconds) + 1))
        self.assertEqual({line["code"] for line in server.events("calls_not_logged")},
                         {"NOT_FOUND"})

    def test_a_callers_trace_is_in_its_line_and_comes_back(self):
        server, stub = self.start()
        given = f"00-{TRACE}-{PARENT}-01"

        def returned(metadata):
            _, call = stub.ListModels.with_call(synthesis_pb2.ListModelsRequest(),
                                                timeout=tools.RUN_SECONDS, metadata=metadata)
            return dict(call.trailing_metadata()).get("traceparent")

        self.assertEqual(returned((("traceparent", given),)), given)
        self.assertIsNone(returned(None))
        self.assertIsNone(returned((("traceparent", given[:-1]),)), "malformed")
        tools.wait_until(lambda: len(server.events("call")) == 3, "the calls are logged")
        self.assertEqual([(line.get("trace_id"), line.get("traceparent"))
                          for line in server.events("call")],
                         [(TRACE, given), (None, None), (None, None)])

    def test_level_omits_less_severe_lines(self):
        process = tools.run(tools.PROGRAMS / "duet-server", "--listen", "127.0.0.1:0",
                            "--metrics-listen", "off", "--log-level", "error",
                            "--model-repository", "/nowhere")
        self.assertEqual(process.returncode, 1)
        events = [json.loads(line)["event"] for line in process.stderr.splitlines()]
        self.assertEqual(events, ["cannot_serve"])


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as stubs:
        tools.generate_stubs(stubs, *PROTOS)
        from duet.v1 import synthesis_pb2, synthesis_pb2_grpc
        tools.main()
