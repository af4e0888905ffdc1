"""The wire fuzzer (wire_fuzzer.py): that it finds what it is for, can be repeated, and finds nothing in the
server.

    wire_fuzz_test.py BUILD     $DUET_WIRE_SECONDS of fuzzing, 30 if absent"""

import contextlib
import io
import json
import os
import pathlib
import signal
import sys
import tempfile
import unittest
import unittest.mock

import fuzzing
import http2_client as http2
import tools
import wire_fuzzer
from wire import calls, corpus, judge, mutation, player, protobuf, rounds, target

BUILD = sys.argv[1]
SECONDS = os.environ.get("DUET_WIRE_SECONDS", "30")
del sys.argv[1]
METHODS = [(rounds.ADMIN if method.startswith(corpus.ADMIN) else rounds.SERVICE, method, requests)
           for method, requests in corpus.requests_of_methods(tools.SOURCE).items()]
REQUEST = corpus.requests_of_methods(tools.SOURCE)[corpus.SYNTHESIZE][1]


def fuzz(*words):
    """Exit status and what was printed."""
    with contextlib.redirect_stdout(io.StringIO()) as printed:
        status = wire_fuzzer.main([BUILD, *words])
    return status, printed.getvalue()


class InputsTest(unittest.TestCase):
    def test_message_survives_splitting_and_joining(self):
        fields = protobuf.parse(REQUEST)
        self.assertEqual([field.number for field in fields], [2, 3, 5, 6, 8, 9, 10, 11, 16])
        self.assertEqual(protobuf.encode(fields), REQUEST)
        self.assertIsNone(protobuf.parse(REQUEST[:-1]))
        self.assertEqual(protobuf.varint(300), b"\xac\x02")

    def test_simple_changes_cover_each_field_and_kind(self):
        changes = set(mutation.systematic(REQUEST))
        for field in protobuf.parse(REQUEST):
            self.assertIn(field.encoded(), changes)
            self.assertIn(field.encoded() * 2, changes)
        leader = protobuf.values(REQUEST, 2)[0]
        for number in range(1, 7):  # every field of Motion, alone in a leader alone
            alone = next(field for field in protobuf.parse(leader) if field.number == number)
            self.assertIn(protobuf.message(f2=alone.encoded()), changes)
        for change in (b"", b"\x00", REQUEST * 2, REQUEST):
            self.assertIn(change, changes)
        self.assertTrue(any(0 < len(change) < len(REQUEST) and REQUEST.startswith(change)
                            for change in changes))

    def test_a_round_is_a_function_of_its_seed_and_number(self):
        one, same, other = (rounds.Rounds(seed, METHODS) for seed in (1, 1, 2))
        begin = one.systematic_count
        for number in (0, begin - 1, *range(begin, begin + 50)):
            self.assertEqual(one[number], same[number], number)
        self.assertNotEqual([one[begin + i] for i in range(5)], [other[begin + i] for i in range(5)])


class CorpusTest(unittest.TestCase):
    """That the server accepts the real requests: mutations of others reach no code behind its checks."""

    @classmethod
    def setUpClass(cls):
        cls.target = target.Target()
        cls.addClassCleanup(cls.target.kill)
        cls.requests = corpus.requests_of_methods(tools.SOURCE)

    def accepted(self, method, *messages):
        """The answers to a call that must end well."""
        connection = http2.Connection(self.target.ports[rounds.SERVICE], window=2**20)
        self.addCleanup(connection.close)
        stream = connection.open("/" + method)
        connection.socket.sendall(
            calls.data(stream, b"".join(map(http2.message, messages)), end=True))
        body = b""
        for kind, flags, _, payload in connection.frames():
            if kind == http2.DATA:
                body += payload
            elif kind == http2.HEADERS and flags & http2.END_STREAM:
                self.assertEqual(judge.grpc_status(payload), "0", payload)
                return judge.messages_in(body)
        raise AssertionError("the call has no end")

    def test_sessions_are_answered(self):
        *starts, frames, change = self.requests[corpus.LIVE]
        for start in starts:
            self.accepted(corpus.LIVE, start)
        resumed, *others = corpus.openings(corpus.LIVE, self.requests[corpus.LIVE])
        self.assertEqual(len(others), 3)
        for opening in others:
            self.accepted(corpus.LIVE, opening, change, frames)
        answers = self.accepted(corpus.LIVE, resumed, change, frames)
        self.assertEqual(protobuf.values(protobuf.values(answers[-1], 4)[0], 1), [2])  # frames
        rotations = [part for answer in answers for frames in protobuf.values(answer, 2)
                     for part in protobuf.values(frames, 9)]
        self.assertTrue(rotations)


class FindingsTest(unittest.TestCase):
    """That each judge finds what it looks for: a server is made to fail, or its answer to differ."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.patch(fuzzing, "REPORT_SECONDS", 1)

    def find(self, *words, patience="60"):
        status, printed = fuzz("--out", self.folder, "--from", "1", "--rounds", "3", "--patience",
                               patience, *words)
        self.assertEqual(status, 1, printed)
        return printed

    def during_the_second_round(self, action):
        """Has something happen to the server before the second round."""
        real, played = player.Player.play, []

        def play(one, connections):
            played.append(connections)
            if len(played) == 2:
                action(self.targets[0].server)
            real(one, connections)
        self.patch(player.Player, "play", play)
        self.targets = []
        real_target = target.Target

        def start(*arguments):
            self.targets.append(real_target(*arguments))
            return self.targets[0]
        self.patch(target, "Target", start)

    def patch(self, *arguments):
        patched = unittest.mock.patch.object(*arguments)
        patched.start()
        self.addCleanup(patched.stop)

    def test_dead_server_is_reported(self):
        self.during_the_second_round(lambda server: os.kill(server.pid, signal.SIGABRT))
        printed = self.find("--seed", "5")
        self.assertIn("ended with -6", printed)
        self.assertIn("--seed 5 --from 1 --rounds 2", printed)
        kept = json.loads((pathlib.Path(self.folder) / "rounds.json").read_text())
        self.assertEqual((kept["seed"], kept["numbers"]), (5, [1, 2]))

    def test_hanging_server_is_reported(self):
        self.during_the_second_round(lambda server: os.kill(server.pid, signal.SIGSTOP))
        self.assertIn("goes on, hangs", self.find(patience="1"))

    def test_changed_answer_is_reported(self):
        real, seen = judge.call, set()

        def call(port, method, request, patience):
            status, messages = real(port, method, request, patience)
            if method == corpus.SYNTHESIZE:
                if request in seen:  # its first answer is the one that the others must equal
                    messages[1] = messages[1][:-1] + bytes((messages[1][-1] ^ 1,))
                seen.add(request)
            return status, messages
        self.patch(judge, "call", call)
        self.assertIn("Synthesize: a good call was answered differently", self.find())

    def test_sanitizer_report_is_reported(self):
        report = "==1==ERROR: AddressSanitizer: heap-use-after-free\n"
        self.during_the_second_round(lambda server: server.log.append({"text": report}))
        self.assertIn(report, self.find())



class ServerTest(unittest.TestCase):
    def test_server_withstands_the_traffic(self):
        status = wire_fuzzer.main([BUILD, "--seconds", SECONDS, "--memory",
                                   str(600 * tools.MEMORY_FACTOR), "--out", f"{BUILD}/wire"])
        self.assertEqual(status, 0)


if __name__ == "__main__":
    tools.main()
