"""What a server tells of itself: to promtool and a real Prometheus, to a collector of traces, and to
whoever reads its log."""

import concurrent.futures
import json
import pathlib
import re
import shutil
import struct
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
                     "kubernetes/components/scale_by_adapter/adapter_rules.yaml",
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

    def test_autoscalers_count_the_queue_and_live_sessions(self):
        components = tools.SOURCE / "deploy/kubernetes/components"
        adapter, autoscaler, keda = (
            (components / file).read_text(encoding="utf-8")
            for file in ("scale_by_adapter/adapter_rules.yaml", "scale_by_adapter/autoscaler.yaml",
                         "scale_by_keda/scaled_object.yaml"))
        provided = re.findall(r'as: "(\w+)"', adapter)
        self.assertEqual(re.findall(r"name: (duet_\w+)", autoscaler), provided)
        for text in (adapter, keda):
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


def fields(message):
    """The fields of a protobuf message by number, read without any schema."""
    found, at = {}, 0

    def varint(start):
        value = shift = 0
        while True:
            byte = message[start]
            value |= (byte & 127) << shift
            start, shift = start + 1, shift + 7
            if byte < 128:
                return value, start

    while at < len(message):
        tag, at = varint(at)
        kind = tag & 7
        if kind == 0:
            value, at = varint(at)
        elif kind == 1:
            value, at = struct.unpack_from("<q", message, at)[0], at + 8
        else:
            assert kind == 2, kind
            size, at = varint(at)
            value, at = message[at:at + size], at + size
        found.setdefault(tag >> 3, []).append(value)
    return found


class Collector:
    """An OpenTelemetry collector as far as a test needs one. It knows OTLP's field numbers by heart,
    and no schema of ours."""

    def __init__(self):
        self.spans = []
        self._server = grpc.server(concurrent.futures.ThreadPoolExecutor(2))
        handler = grpc.unary_unary_rpc_method_handler(self._export)
        self._server.add_generic_rpc_handlers((grpc.method_handlers_generic_handler(
            "opentelemetry.proto.collector.trace.v1.TraceService", {"Export": handler}),))
        self.port = self._server.add_insecure_port("127.0.0.1:0")
        self._server.start()

    def _export(self, request, _):
        for resource_spans in fields(request)[1]:
            outer = fields(resource_spans)
            service = self._attributes(fields(outer[1][0])[1])["service.name"]
            for scope_spans in outer[2]:
                self.spans += [self._span(service, span) for span in fields(scope_spans)[2]]
        return b""

    @staticmethod
    def _attributes(encoded):
        """KeyValue: 1 key, 2 value; of it 1 string, 2 bool, 3 int, 4 double."""
        attributes = {}
        for pair in map(fields, encoded):
            (number, (value,)), = fields(pair[2][0]).items()
            if number == 1:
                value = value.decode()
            elif number == 4:
                value = struct.unpack("<d", struct.pack("<q", value))[0]
            attributes[pair[1][0].decode()] = value
        return attributes

    def _span(self, service, encoded):
        span = fields(encoded)
        return {"service": service, "trace": span[1][0].hex(), "id": span[2][0].hex(),
                "parent": span.get(4, [b""])[0].hex(), "name": span[5][0].decode(),
                "kind": span[6][0], "start": span[7][0], "end": span[8][0],
                "attributes": self._attributes(span[9]),
                "events": [fields(event)[2][0].decode() for event in span.get(11, [])],
                "failed": 15 in span}

    def stop(self):
        self._server.stop(None).wait()


class TraceTest(unittest.TestCase):
    def setUp(self):
        self.collector = Collector()
        self.addCleanup(self.collector.stop)

    def start(self, *flags):
        server = tools.Server(*flags, metrics="127.0.0.1:0")
        self.addCleanup(server.stop)
        channel = grpc.insecure_channel(server.address)
        self.addCleanup(channel.close)
        return server, synthesis_pb2_grpc.MotionSynthesisStub(channel)

    def exporting(self, *flags):
        return self.start("--otlp-endpoint", f"http://127.0.0.1:{self.collector.port}", *flags)

    @staticmethod
    def returned(stub, traceparent=None):
        """The traceparent that comes back with a reply."""
        metadata = (("traceparent", traceparent),) if traceparent else None
        _, call = stub.ListModels.with_call(synthesis_pb2.ListModelsRequest(),
                                            timeout=tools.RUN_SECONDS, metadata=metadata)
        return dict(call.trailing_metadata()).get("traceparent")

    def test_trace_passes_through_the_server(self):
        server, stub = self.exporting()
        begin = time.time_ns()
        came = self.returned(stub, f"00-{TRACE}-{PARENT}-01")
        tools.wait_until(lambda: self.collector.spans, "a span")
        span, = self.collector.spans
        self.assertEqual((span["service"], span["trace"], span["parent"], span["name"]),
                         ("duet-server", TRACE, PARENT, "duet.v1.MotionSynthesis/ListModels"))
        self.assertEqual(came, f"00-{TRACE}-{span['id']}-01")
        self.assertEqual(span["kind"], 2)  # SPAN_KIND_SERVER
        self.assertLess(begin, span["end"])
        self.assertLessEqual(span["start"], span["end"])
        self.assertLess(span["end"] - begin, 60e9)
        self.assertEqual(span["attributes"]["rpc.system"], "grpc")
        self.assertEqual(span["attributes"]["rpc.grpc.status_code"], 0)
        self.assertFalse(span["failed"])
        call, = server.events("call")
        self.assertEqual((call["trace_id"], call["span_id"], call["traceparent"]),
                         (TRACE, span["id"], f"00-{TRACE}-{PARENT}-01"))
        tools.wait_until(
            lambda: "duet_spans_sent_total 1\n" in get(server.metrics_port, "/metrics"),
            "the count of spans")

    def test_the_caller_decides_what_is_sampled(self):
        _, stub = self.exporting()
        self.assertEqual(self.returned(stub, f"00-{TRACE}-{PARENT}-00")[-2:], "00")
        self.returned(stub, f"00-{TRACE}-{PARENT}-01")
        tools.wait_until(lambda: self.collector.spans, "a span")
        self.assertEqual(len(self.collector.spans), 1)

    def test_call_without_a_trace_starts_one(self):
        _, stub = self.exporting()
        came = self.returned(stub)
        tools.wait_until(lambda: self.collector.spans, "a span")
        span, = self.collector.spans
        self.assertEqual(came, f"00-{span['trace']}-{span['id']}-01")
        self.assertEqual(span["parent"], "")

    def test_synthesize_span_has_the_time_of_the_first_chunk(self):
        server, _ = self.exporting()
        answer = tools.duet("synthesize", "--server", server.address, "--leader",
                            tools.sample("kick"), "--label", "kick=1", "--out", "-",
                            "--output-format", "csv")
        self.assertEqual(answer.returncode, 0, answer.stderr)
        self.named = lambda: [span for span in self.collector.spans
                              if span["name"].endswith("/Synthesize")]
        tools.wait_until(self.named, "a span")
        span, = self.named()
        self.assertEqual(span["events"], ["first_chunk"])
        self.assertEqual(span["attributes"]["duet.model"], "sbu")
        self.assertGreater(span["attributes"]["duet.frames"], 0)
        self.assertGreater(span["attributes"]["duet.compute_seconds"], 0)

    def test_trace_is_propagated_without_a_collector(self):
        _, stub = self.start()
        came = self.returned(stub, f"00-{TRACE}-{PARENT}-01")
        self.assertRegex(came, f"^00-{TRACE}-[0-9a-f]{{16}}-01$")
        self.assertNotIn(PARENT, came)
        self.assertIsNone(self.returned(stub))
        self.assertEqual(self.collector.spans, [])

    def test_absent_collector_loses_only_spans(self):
        server, stub = self.exporting()
        self.collector.stop()
        for _ in range(5):
            self.assertIsNotNone(self.returned(stub))
        tools.wait_until(
            lambda: "duet_spans_dropped_total 5\n" in get(server.metrics_port, "/metrics"),
            "the count of lost spans")
        self.assertIn("duet_spans_sent_total 0\n", get(server.metrics_port, "/metrics"))

    def test_invalid_endpoint_prevents_the_start(self):
        wrong = tools.run(tools.PROGRAMS / "duet-server", "--listen", "127.0.0.1:0",
                          "--metrics-listen", "off", "--otlp-endpoint", "collector:4317")
        self.assertNotEqual(wrong.returncode, 0)
        self.assertIn("otlp_endpoint: expected", wrong.stderr)


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

    def test_share_of_successes_is_logged(self):
        server, stub = self.start("--log-success-ratio", "0.1")
        for _ in range(40):
            stub.ListModels(synthesis_pb2.ListModelsRequest(), timeout=tools.RUN_SECONDS)
        server.stop()
        self.assertEqual(len(server.events("call")), 4)
        self.assertEqual(server.events("call")[0]["sampled_ratio"], 0.1)

    def test_text_log_is_readable(self):
        server = subprocess.Popen(
            [tools.PROGRAMS / "duet-server", "--listen", "127.0.0.1:0", "--metrics-listen", "off",
             "--log-format", "text"], stderr=subprocess.PIPE, text=True)
        lines = []
        for line in server.stderr:
            lines.append(line)
            if " serving " in line:
                break
        server.terminate()
        server.communicate(timeout=tools.STOP_SECONDS)
        for line in lines:
            self.assertRegex(line, r"^\d{4}-\d\d-\d\dT[\d:.]+Z (INFO   |WARNING|ERROR  ) \w+ ")
        self.assertRegex(lines[-1], r" serving port=\d+ ")

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
