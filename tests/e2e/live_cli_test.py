"""duet live from a file and from lines of JSON, with a real server."""

import json
import signal
import subprocess
import time

import tools

FRAMES = 91  # of the sample


def frames_of(text):
    """The positions of each frame on standard output, in order and without gaps."""
    head, *frames = [json.loads(line) for line in text.splitlines()]
    assert head["rate"] == 30, head
    assert [frame["frame"] for frame in frames] == list(range(len(frames)))
    return [frame["positions"] for frame in frames]


def difference(a, b):
    """The largest one of two motions, in metres."""
    return max(abs(x - y) for p, q in zip(a, b) for u, v in zip(p, q) for x, y in zip(u, v))


def has_session(server):
    return 'duet_calls_in_flight{method="SynthesizeLive"} 1\n' in server.page("/metrics")[1]


def rest_of(process):
    """Output and errors until a process ends. After readline(), communicate() would lose the lines that
    the reader has buffered."""
    output, errors = process.stdout.read(), process.stderr.read()
    process.wait(tools.RUN_SECONDS)
    return output, errors


class LiveCliTest(tools.ServedTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        tools.duet("convert", tools.sample("hug"), "--out", cls.folder / "hug.json").check_returncode()
        motion = json.loads((cls.folder / "hug.json").read_text(encoding="utf-8"))
        cls.leader = [{"joints": motion["joint_names"], "rate": 30, "unit": "m", "up": "y"}]
        cls.leader += [{"positions": positions} for positions in motion["leader"]]

    def run_live(self, *arguments, lines=None):
        """Runs duet live, with lines of JSON as standard input."""
        text = None if lines is None else "".join(json.dumps(line) + "\n" for line in lines)
        result = tools.run(tools.PROGRAMS / "duet", "live", "--label", "hug=1", "--server", self.server.address,
                           *arguments, input=text)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result

    def test_a_file_is_played_in_real_time(self):
        follower = self.folder / "follower.bvh"
        page = follower.with_name("pair.html")
        begin = time.monotonic()
        result = self.run_live("--from", tools.sample("hug"), "--realtime", "--to", follower,
                               "--to", page)
        self.assertGreater(time.monotonic() - begin, (FRAMES - 1) / 30)
        self.assertIn(f"Frames: {FRAMES}\n", follower.read_text(encoding="utf-8"))
        self.assertIn("<html", page.read_text(encoding="utf-8"))
        self.assertIn(f"{FRAMES} follower frames", result.stdout)
        self.assertNotIn("losses", result.stdout)
        self.assertNotIn("resumed", result.stdout)
        self.assertEqual(result.stderr, "")

    def test_lines_of_json_are_answered_as_the_file_is(self):
        ours = frames_of(self.run_live("--from", "-", "--to", "-", lines=self.leader).stdout)
        theirs = frames_of(self.run_live("--from", tools.sample("hug"), "--to", "-").stdout)
        self.assertEqual((len(ours), len(theirs)), (FRAMES, FRAMES))
        self.assertLess(difference(ours, theirs), 0.001)

    def test_two_signals_at_once_end_the_motion_and_write_the_files(self):
        follower = self.folder / "twice.json"
        with subprocess.Popen(
                [tools.PROGRAMS / "duet", "live", "--server", self.server.address, "--label",
                 "hug=1", "--from", tools.sample("hug"), "--realtime", "--to", "-", "--to",
                 follower], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
            lines = [process.stdout.readline() for _ in range(11)]
            # Two numbers: the system would merge two equal ones that nobody has read.
            for number in (signal.SIGINT, signal.SIGTERM):
                process.send_signal(number)
            rest, errors = rest_of(process)
        self.assertEqual(process.returncode, 0, errors)
        frames = frames_of("".join(lines) + rest)
        self.assertTrue(10 <= len(frames) < FRAMES, len(frames))
        self.assertEqual(len(json.loads(follower.read_text(encoding="utf-8"))["leader"]), len(frames))

    def test_another_server_takes_over(self):
        first, second = (tools.Server(metrics="127.0.0.1:0") for _ in range(2))
        try:
            with subprocess.Popen(
                    [tools.PROGRAMS / "duet", "live", "--server",
                     f"ipv4:{first.address},{second.address}", "--label", "hug=1", "--from",
                     tools.sample("hug"), "--realtime", "--to", "-"],
                    stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
                lines = [process.stdout.readline() for _ in range(31)]
                # The one that has the session, which goes to either.
                next(filter(has_session, (first, second))).kill()
                rest, errors = rest_of(process)
            self.assertEqual(process.returncode, 0, errors)
            self.assertEqual(len(frames_of("".join(lines) + rest)), FRAMES)
            self.assertIn("resumed", errors)
        finally:
            first.kill()
            second.kill()


if __name__ == "__main__":
    tools.main()
