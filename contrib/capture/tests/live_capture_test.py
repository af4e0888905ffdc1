"""The bridge from capture protocols to VMC, with a real server and senders made from the published layouts."""

import math
import os
import pathlib
import re
import signal
import socket
import subprocess
import sys
import threading
import time

import senders
import tools

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import osc  # noqa: E402

BRIDGE = tools.SOURCE / "contrib" / "capture" / "duet_capture.py"
RATE = 30


class Session:
    """A running bridge; its port for the sender, once it waits."""

    def __init__(self, *arguments):
        self.process = subprocess.Popen(
            [str(word) for word in (sys.executable, "-B", BRIDGE, *arguments)],
            stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
            env={**os.environ, "PYTHONPATH": str(tools.SOURCE / "client" / "python")})
        self.errors = []
        self.waits = threading.Event()
        self.port = None
        self.reader = threading.Thread(target=self._read, daemon=True)
        self.reader.start()

    def _read(self):
        for line in self.process.stderr:
            self.errors.append(line)
            if found := re.search(r"waiting for frames at \w+://\S*:(\d+)", line):
                self.port = int(found[1])
                self.waits.set()
        self.waits.set()

    def wait_for_port(self):
        self.waits.wait(tools.RUN_SECONDS)
        if self.port is None:
            raise AssertionError(f"the bridge did not wait for frames: {self.errors}")
        return self.port

    def interrupt(self):
        """Ctrl-C; the exit code and standard output."""
        self.process.send_signal(signal.SIGINT)
        out, _ = self.wait()
        return self.process.returncode, out

    def wait(self):
        try:
            out = self.process.stdout.read()
            self.process.wait(tools.RUN_SECONDS)
        finally:
            self.process.kill()
            self.process.wait()
            self.reader.join()
            self.process.stdout.close()
            self.process.stderr.close()
        return out, self.errors


def send(port, protocol, seconds, change=lambda frame, datagrams: datagrams):
    """Sends frames in real time. `change` gives the datagrams that are sent in place of a frame's."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
        begin = time.monotonic()
        for frame in range(int(seconds * RATE)):
            time.sleep(max(0, begin + frame / RATE - time.monotonic()))
            for datagram in change(frame, protocol(frame, frame / RATE)):
                sender.sendto(datagram, ("127.0.0.1", port))


class Receiver:
    """Receives VMC; the transforms of every frame's bones."""

    def __init__(self):
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.bind(("127.0.0.1", 0))
        self.socket.settimeout(0.2)
        self.frames = []
        self.ended = False
        self.thread = threading.Thread(target=self._read, daemon=True)
        self.thread.start()

    @property
    def port(self):
        return self.socket.getsockname()[1]

    def _read(self):
        while True:
            try:
                datagram = self.socket.recv(65536)
            except socket.timeout:
                if self.ended:
                    return
                continue
            for address, types, data in osc.messages(datagram):
                arguments = osc.arguments(types, data)
                if address == "/VMC/Ext/T":
                    self.frames.append({"T": arguments[0]})
                elif address == "/VMC/Ext/Bone/Pos":
                    self.frames[-1][arguments[0]] = arguments[1:]

    def finish(self):
        """Reads what has arrived, and stops."""
        self.ended = True
        self.thread.join()
        self.socket.close()
        return self.frames


class LiveCaptureTest(tools.ServedTest):
    def start(self, address, *flags):
        return Session("--from", address, "--label", "hug=1", "--server", self.server.address, *flags)

    def test_a_captured_leader_is_answered_in_vmc(self):
        receiver = Receiver()
        self.addCleanup(receiver.finish)
        session = self.start("vmc://127.0.0.1:0", "--frame-rate", RATE,
                             "--to", f"vmc://127.0.0.1:{receiver.port}")
        last = []

        def spoil(frame, datagrams):  # lost, doubled and swapped frames, and silence
            if 60 < frame < 80:
                return []
            if frame % 20 == 10:
                return []
            if frame % 20 == 15:
                return datagrams + datagrams
            if frame % 20 == 5:
                last[:] = datagrams
                return []
            if frame % 20 == 6:
                return datagrams + last
            return datagrams

        send(session.wait_for_port(), senders.vmc, 4, spoil)
        code, out = session.interrupt()
        self.assertEqual(code, 0, session.errors)
        self.assertIn("duplicates", out)
        self.assertIn("interpolated", out)
        self.assertIn("held", out)
        self.assertTrue(any("frames arrive again" in line for line in session.errors))
        frames = receiver.finish()
        self.assertGreater(len(frames), 3.5 * RATE)
        for before, after in zip(frames, frames[1:]):
            self.assertAlmostEqual(after["T"] - before["T"], 1 / RATE, places=4)
        for frame in frames:
            self.assertEqual(len(frame), 18)
            for bone, values in frame.items():
                if bone != "T":
                    self.assertTrue(all(map(math.isfinite, values)))
                    self.assertAlmostEqual(math.hypot(*values[3:]), 1, places=3)
            x, y, z = frame["Hips"][:3]
            self.assertTrue(0.5 < y < 1.4 and math.hypot(x, z) < 4, frame["Hips"])

    def test_xsens_and_rokoko_lead_too(self):
        for scheme in ("xsens", "rokoko"):
            with self.subTest(scheme):
                receiver = Receiver()
                self.addCleanup(receiver.finish)
                session = self.start(f"{scheme}://127.0.0.1:0", "--to", f"vmc://127.0.0.1:{receiver.port}")
                send(session.wait_for_port(), getattr(senders, scheme), 3)
                code, _ = session.interrupt()
                self.assertEqual(code, 0, session.errors)
                # The first second measures the rate.
                frames = receiver.finish()
                self.assertGreater(len(frames), 1.5 * RATE)
                self.assertAlmostEqual(frames[1]["T"] - frames[0]["T"], 1 / RATE, places=4)

    def test_an_interrupt_before_the_first_frame_ends_it(self):
        session = self.start("vmc://127.0.0.1:0", "--to", "vmc://127.0.0.1:9")
        session.wait_for_port()
        code, _ = session.interrupt()
        self.assertNotEqual(code, 0)

    def test_what_arrives_in_another_protocol_is_named(self):
        session = self.start("rokoko://127.0.0.1:0", "--to", "vmc://127.0.0.1:9")
        send(session.wait_for_port(), senders.xsens, 0.2)
        tools.wait_until(lambda: any("JSON v3" in line for line in session.errors), "the hint")
        session.interrupt()

    def test_a_port_in_use_is_an_error(self):
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
            other.bind(("127.0.0.1", 0))
            port = other.getsockname()[1]
            session = self.start(f"vmc://127.0.0.1:{port}", "--to", "vmc://127.0.0.1:9")
            _, errors = session.wait()
        self.assertIn("in use", "".join(errors))

    def test_an_address_to_send_to_needs_a_host(self):
        session = self.start("vmc://", "--to", "vmc://:39540")
        _, errors = session.wait()
        self.assertIn("expected vmc://HOST[:PORT]", "".join(errors))


if __name__ == "__main__":
    tools.main()
