"""The extension module that reads motion files: the program's results and errors, memory, threads."""

import concurrent.futures
import gc
import json
import os
import pathlib
import random
import subprocess
import sys
import tempfile
import threading
import unittest
from unittest import mock

import motion_samples
import support
import duet_motion as duet
import numpy as np
from duet_motion import _file_extension, _file_program
from duet_motion._file_options import checked_options

PROGRAM = support.PROGRAMS / "duet"
HUG = support.SOURCE / "samples" / "hug.bvh"
MISSING = _file_extension.missing or ("" if PROGRAM.exists() else f"no program at {PROGRAM}")
# Damaged files of each sample.
DAMAGED = 24


def options(side=None, frame_rate_hz=None, unit="", up_axis="", metres_per_unit=None, joint_map=None,
            resample_hz=None, layout="", body_model=None):
    return checked_options(side, frame_rate_hz, unit, up_axis, metres_per_unit, joint_map, resample_hz,
                           layout, body_model)


def outcome(backend, path, arguments):
    """What reading a file comes to, to the bit. JSON has no -0."""
    try:
        people = backend.read(path, arguments)
    except duet.MotionFileError as error:
        return str(error)
    return [(person.positions.shape, (person.positions + 0).tobytes(), person.joint_names,
             person.frame_rate_hz, person.unit, person.up_axis) for person in people]


def memory_bytes():
    """Memory of this process that is in use."""
    gc.collect()
    pages = pathlib.Path("/proc/self/statm").read_text(encoding="ascii").split()[1]
    return int(pages) * os.sysconf("SC_PAGE_SIZE")


@unittest.skipIf(MISSING, f"{MISSING}; build the targets duet and duet_python_module")
class ExtensionTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        cls.enterClassContext(mock.patch.dict(os.environ, {"DUET_PROGRAM": str(PROGRAM)}))
        cls.samples = motion_samples.write_all(PROGRAM, cls.folder)

    def assert_equal_outcome(self, path, arguments):
        """Returns the common outcome of the extension and the program."""
        read = outcome(_file_extension, path, arguments)
        self.assertEqual(read, outcome(_file_program, path, arguments), path)
        return read

    def test_every_format_reads_as_in_the_program(self):
        samples = [*self.samples, *sorted((support.SOURCE / "samples").glob("*.bvh"))]
        self.assertEqual({path.suffix for path in samples},
                         {".bvh", ".amc", ".csv", ".glb", ".gltf", ".json", ".npy", ".txt"})
        for path in samples:
            known = motion_samples.options_of(path)
            for side in (None, "left", "right"):
                read = self.assert_equal_outcome(path, options(side, **known))
                self.assertIsInstance(read, list, read)
                self.assertEqual(len(read), 2 if path.stem == "pair" and side is None else 1)

    def test_every_argument_works_as_in_the_program(self):
        for path in self.samples:
            known = motion_samples.options_of(path)
            for arguments in ({"frame_rate_hz": 59.94}, {"resample_hz": 24}, {"resample_hz": 0.1},
                              {"resample_hz": 1000}, {"metres_per_unit": 0.0254}, {"unit": "metres"},
                              {"unit": "millimetres", "up_axis": "z-up"}, {"up_axis": "y-down"},
                              {"unit": "sbu-normalised"}, {"frame_rate_hz": 1e9},
                              {"resample_hz": 1e9}, {"metres_per_unit": 1e9},
                              {"joint_map": {"left_hand": "right_hand"}},
                              {"joint_map": {"left_hand": "nothing", "nobody": "head"}}):
                self.assert_equal_outcome(path, options(**{**known, **arguments}))

    def test_spline_beyond_the_limit_of_positions_has_the_programs_error(self):
        document = json.loads((self.folder / "one.json").read_text(encoding="utf-8"))
        frame = document["leader"][0]
        document["leader"] = [[[x, y, side * 1e7] for x, y, _ in frame] for side in (1, -1, -1, 1)]
        path = self.folder / "far.json"
        path.write_text(json.dumps(document), encoding="utf-8")
        self.assertIsInstance(self.assert_equal_outcome(path, options()), list)
        read = self.assert_equal_outcome(path, options(resample_hz=60))
        self.assertRegex(str(read), "^person: frame 3 head: expected a finite position")

    def test_damaged_files_have_the_programs_errors(self):
        chance = random.Random(5)
        failed = 0
        for path in self.samples:
            whole = path.read_bytes()
            for number in range(DAMAGED):
                content = bytearray(whole[:chance.randrange(len(whole))] if number % 2 else whole)
                for _ in range(number // 4):
                    if content:
                        content[chance.randrange(len(content))] = chance.randrange(256)
                damaged = self.folder / f"damaged{path.suffix}"
                damaged.write_bytes(content)
                read = self.assert_equal_outcome(damaged,
                                                 options(**motion_samples.options_of(path)))
                failed += isinstance(read, str)
        self.assertGreater(failed, len(self.samples) * DAMAGED / 2)

    def test_foreign_and_odd_files_have_the_programs_errors(self):
        (self.folder / "folder.bvh").mkdir()
        os.mkfifo(self.folder / "pipe.bvh")
        (self.folder / "locked.bvh").symlink_to(self.folder / "locked.bvh")
        (self.folder / "deep.json").write_text("[" * 100_000, encoding="ascii")
        (self.folder / "large.json").touch()
        os.truncate(self.folder / "large.json", (512 << 20) + 1)
        for name in ("e.fbx", "e", "empty.bvh", "empty.csv", "empty.json", "empty.glb", "empty.gltf",
                     "empty.npy", "empty.txt", "empty.amc"):
            (self.folder / name).touch()
        (self.folder / "other.npy").write_bytes(b"PK\x03\x04" * 100)
        (self.folder / "other.gltf").write_bytes(HUG.read_bytes())
        odd = os.fsdecode(b"odd\xff\n.bvh")
        (self.folder / odd).write_bytes(b"HIERARCHY\nROOT \xff\xfe\n")
        for name in ("absent.bvh", "folder.bvh", "pipe.bvh", "locked.bvh", "deep.json", "large.json",
                     "e.fbx", "e", "empty.bvh", "empty.csv", "empty.json", "empty.glb", "empty.gltf",
                     "empty.npy", "empty.txt", "empty.amc", "other.npy", "other.gltf", odd, ""):
            read = self.assert_equal_outcome(self.folder / name, options(frame_rate_hz=30))
            self.assertIsInstance(read, str, name)

    def test_every_format_is_written_as_by_the_program(self):
        for source in ("one.json", "pair.json"):
            document = (self.folder / source).read_text(encoding="utf-8")
            for name in ("w.bvh", "w.csv", "w.glb", "w.gltf", "w.json", "w.npy", "w.txt", "w.usda",
                         "w.amc", "w.html", "w", "no/w.csv", "folder.csv"):
                written = []
                for backend in (_file_extension, _file_program):
                    with tempfile.TemporaryDirectory(dir=self.folder) as folder:
                        (pathlib.Path(folder) / "folder.csv").mkdir()
                        written.append(self.written(backend, document, pathlib.Path(folder), name))
                self.assertEqual(*written, name)

    def written(self, backend, document, folder, name):
        try:
            backend.write(document, folder / name)
        except duet.MotionFileError as error:
            return str(error).replace(str(folder), "")
        return {path.name: path.read_bytes() for path in folder.iterdir() if path.is_file()}

    def test_unmapped_joints_cannot_be_written(self):
        motion = support.leader()
        errors = []
        for backend in (_file_extension, _file_program):
            with mock.patch.object(_file_extension, "missing", backend is _file_program):
                with self.assertRaisesRegex(duet.MotionFileError, "^motion: ") as caught:
                    duet.write_motion(self.folder / "unmapped.csv", motion)
            errors.append(str(caught.exception))
        self.assertEqual(*errors)

    def test_arrays_are_the_memory_that_was_read(self):
        person, = _file_extension._motion_files.read(
            HUG, side="", frame_rate_hz=None, unit="", up_axis="", metres_per_unit=None, joint_map={},
            resample_hz=None)
        self.assertTrue(np.shares_memory(np.asarray(person.positions), np.asarray(person.positions)))
        with mock.patch.object(_file_extension, "_motion_files") as module:
            module.read.return_value = [person]
            motion = duet.read_motion(HUG)
        self.assertTrue(np.shares_memory(motion.positions, np.asarray(person.positions)))
        self.assertFalse(motion.positions.flags.owndata)
        with self.assertRaises(ValueError):
            motion.positions[0] = 1
        with self.assertRaises(ValueError):
            motion.positions.setflags(write=True)

    def test_arrays_outlive_the_motion(self):
        positions = duet.read_motion(HUG).positions[5:]
        kept = positions.copy()
        for _ in range(50):  # would reuse the memory
            duet.read_motion(HUG)
        gc.collect()
        np.testing.assert_array_equal(positions, kept)

    def test_thousand_reads_keep_no_memory(self):
        broken = self.folder / "broken.bvh"
        broken.write_bytes(HUG.read_bytes()[:30_000])

        def use(times):
            for _ in range(times):
                duet.read_motion(HUG)
                with self.assertRaises(duet.MotionFileError):
                    duet.read_motion(broken)
                duet.write_motion(self.folder / "kept.npy", small)

        small = duet.read_motion(HUG).frames(0, 5)
        use(200)
        before = memory_bytes()
        use(1000)
        # A thousand arrays are 16 MB, a thousand texts of the file 60 MB.
        self.assertLess(memory_bytes() - before, 6 << 20)

    def test_threads_read_the_same_as_one(self):
        wanted = {path: outcome(_file_extension, path, options(**motion_samples.options_of(path)))
                  for path in self.samples}
        with concurrent.futures.ThreadPoolExecutor(8) as pool:
            jobs = {pool.submit(outcome, _file_extension, path,
                                options(**motion_samples.options_of(path))): path
                    for _ in range(12) for path in self.samples}
            for job, path in jobs.items():
                self.assertEqual(job.result(), wanted[path], path)

    def test_other_threads_run_during_a_read(self):
        interval = sys.getswitchinterval()
        self.addCleanup(sys.setswitchinterval, interval)
        sys.setswitchinterval(1e6)  # the interpreter never takes the lock from a thread
        read, began, stop = _file_extension._motion_files.read, threading.Event(), []

        def read_until_stopped():
            began.set()
            for _ in range(5000):
                if stop:
                    return True
                read(HUG, side="", frame_rate_hz=None, unit="", up_axis="", metres_per_unit=None,
                     joint_map={}, resample_hz=None)
            return False

        with concurrent.futures.ThreadPoolExecutor(1) as pool:
            reading = pool.submit(read_until_stopped)
            began.wait()
            stop.append(True)
            self.assertTrue(reading.result(), "a read does not release the lock of the interpreter")

    def test_other_threads_run_during_a_write(self):
        pipe = self.folder / "pipe.csv"
        os.mkfifo(pipe)
        # The thread waits for a reader of the pipe. A lock that it kept would stop the whole process.
        script = ("import pathlib, sys, threading\n"
                  "sys.path.insert(0, sys.argv[1])\n"
                  "import _motion_files as files\n"
                  "document = pathlib.Path(sys.argv[2]).read_text()\n"
                  "threading.Thread(target=files.write, args=(document, sys.argv[3])).start()\n"
                  "sys.stdout.write(pathlib.Path(sys.argv[3]).read_text())\n")
        document = self.folder / "one.json"
        written = subprocess.run([sys.executable, "-c", script, support.EXTENSION, document, pipe],
                                 capture_output=True, check=True, timeout=support.LONGEST_CALL).stdout
        self.assertEqual(written, (self.folder / "one.csv").read_bytes())

    def test_module_needs_only_abseil_and_the_system(self):
        module, = support.EXTENSION.glob("_motion_files.*.so")
        listed = subprocess.run(["readelf", "-d", module], check=True, capture_output=True, text=True)
        needed = {line.split("[")[1].rstrip("]") for line in listed.stdout.splitlines()
                  if "(NEEDED)" in line}
        self.assertLessEqual(
            {name for name in needed if not name.startswith(("libabsl_", "ld-linux"))},
            {"libc.so.6", "libgcc_s.so.1", "libm.so.6", "libstdc++.so.6", "libz.so.1"})

    def test_module_exports_only_its_initialisation(self):
        module, = support.EXTENSION.glob("_motion_files.*.so")
        listed = subprocess.run(["nm", "-D", "--defined-only", module], check=True,
                                capture_output=True, text=True)
        # Instances of the standard library's templates are the same everywhere.
        self.assertEqual([line.split()[2] for line in listed.stdout.splitlines()
                          if not line.split()[2].startswith(("_ZNSt", "_ZNKSt", "_ZSt"))],
                         ["PyInit__motion_files"])

    def test_module_works_beside_grpc(self):
        # Debian's grpcio loads the same libraries of abseil.
        script = ("import sys, grpc; grpc.insecure_channel('localhost:1').close()\n"
                  "sys.path.insert(0, sys.argv[1])\n"
                  "import _motion_files as files\n"
                  "print(len(files.read(sys.argv[2], side='', frame_rate_hz=None, unit='', up_axis='',"
                  " metres_per_unit=None, joint_map={}, resample_hz=None)))\n")
        used = subprocess.run([sys.executable, "-c", script, support.EXTENSION, HUG],
                              capture_output=True, text=True, check=False)
        self.assertEqual((used.stdout, used.stderr), ("1\n", ""))


if __name__ == "__main__":
    unittest.main()
