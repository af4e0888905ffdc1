"""The Blender add-on plays live, on a clock that the test turns."""

import json
import pathlib
import shutil
import threading
import time

import tools

BLENDER = shutil.which("blender")
LIVE = pathlib.Path(__file__).parent / "in_blender" / "live.py"
FRAMES = 70
REACHED = 0.001  # metres


class BlenderLiveTest(tools.FolderTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        leader = cls.folder / "leader.glb"
        done = tools.duet("convert", tools.sample("hug"), "--out", leader)
        assert done.returncode == 0, done.stderr
        mortal, port = tools.Server(), tools.free_port()
        cls.addClassCleanup(mortal.kill)  # Blender's script does it earlier
        starting = threading.Thread(target=cls.start_second, args=(port,))
        starting.start()
        done = tools.run(BLENDER, "--background", "--factory-startup", "--python-exit-code", "1",
                         "--python", LIVE, "--", tools.SOURCE / "contrib" / "blender", leader,
                         f"{mortal.address},127.0.0.1:{port}", mortal.pid, tools.PROGRAMS / "duet",
                         cls.folder, timeout=2 * tools.RUN_SECONDS)
        (cls.folder / "wanted").touch()  # if Blender failed before
        starting.join()
        assert done.returncode == 0, done.stdout + done.stderr
        cls.state = json.loads((cls.folder / "state.json").read_text(encoding="utf-8"))
        cls.undisturbed = tools.run(
            tools.PROGRAMS / "duet", "live", "--server", cls.second.address, "--from", "-", "--to",
            "-", "--label", "hug=1",
            input="".join(json.dumps(line) + "\n" for line in cls.state["lines"]))
        assert cls.undisturbed.returncode == 0, cls.undisturbed.stderr

    @classmethod
    def start_second(cls, port):
        """Starts the second server when Blender's script wants it, after its session has begun."""
        while not (cls.folder / "wanted").exists():
            time.sleep(0.05)
        cls.second = tools.Server(port=port)
        cls.addClassCleanup(cls.second.stop)
        (cls.folder / "started").touch()

    def test_failures_to_begin_are_reported(self):
        self.assertIn("Every label is 0", self.state["no_label"])
        self.assertIn("no-such-program", self.state["no_program"])
        self.assertIn("UNAVAILABLE", self.state["no_server"])
        self.assertFalse(self.state["after_failure"])

    def test_panel_shows_the_delay_and_the_button_that_stops(self):
        self.assertEqual(self.state["panel"], ["delay", "duet.stop_live"])

    def test_only_one_session_plays_at_a_time(self):
        self.assertIn("Stop it first", self.state["second"])
        self.assertTrue(self.state["react"])

    def test_every_joint_of_the_partner_is_where_the_answer_has_it(self):
        self.assertEqual(self.state["shown"], FRAMES)
        self.assertLess(self.state["heads"], REACHED)

    def test_bones_of_the_partner_point_to_the_next_joint(self):
        self.assertLess(self.state["tails"], 0.03)

    def test_answers_are_the_same_although_a_server_died(self):
        frames = [json.loads(line) for line in self.undisturbed.stdout.splitlines()][1:]
        self.assertEqual(self.state["frames"], [FRAMES, FRAMES])
        self.assertEqual(len(frames), FRAMES)
        for ours, theirs in zip(self.state["answers"], frames):
            flat = [value for place in theirs["positions"] for value in place]
            self.assertLess(max(abs(a - b) for a, b in zip(ours, flat, strict=True)), 1e-4)

    def test_panel_states_latency_and_resumption(self):
        self.assertRegex(self.state["playing"],
                         r"^Live, 3 s: answers after \d+ ms, shown after \d+ ms, resumed once$")
        self.assertEqual(self.state["ended"], f"Duet follower: {FRAMES} frames played live")

    def test_moved_sliders_are_sent(self):
        labels = [line["labels"] for line in self.state["lines"] if "labels" in line]
        self.assertEqual([(one["hug"], one["push"]) for one in labels], [(0, 1)])

    def test_partner_keeps_the_motion(self):
        first, last = self.state["keys"]
        self.assertAlmostEqual(first, 11, delta=0.01)
        self.assertAlmostEqual(last, 80, delta=0.01)
        self.assertLess(self.state["kept"], REACHED)
        self.assertEqual(self.state["frame_now"], 75)

    def test_frames_that_blender_missed_are_interpolated(self):
        short, long = self.state["gaps"]
        self.assertEqual((short, long), (6, 1))
        steps = self.state["steps"][-7:-1]
        self.assertGreater(min(steps), 0.005)
        self.assertLess(max(steps) - min(steps), 1e-4)

    def test_a_session_ends_with_its_partner_and_its_file(self):
        self.assertIn("was removed", self.state["removed"])
        self.assertEqual(self.state["after_load"], [False, True])


if __name__ == "__main__":
    if not BLENDER:
        tools.skip("no blender; install the package blender")
    tools.main()
