"""The generated stubs match the proto files."""

import pathlib
import shutil
import subprocess
import tempfile
import unittest

import support

SCRIPT = support.SOURCE / "scripts" / "python_stubs.sh"


def stubs_below(folder):
    return {path.relative_to(folder).as_posix(): path.read_text(encoding="utf-8")
            for path in pathlib.Path(folder).rglob("*_pb2*.py*") if path.suffix in (".py", ".pyi")}


class StubsTest(unittest.TestCase):
    @unittest.skipIf(shutil.which("grpc_python_plugin") is None,
                     "no grpc_python_plugin; install the package protobuf-compiler-grpc")
    def test_stubs_match_the_proto_files(self):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([SCRIPT, folder], check=True)
            fresh = stubs_below(folder)
        kept = stubs_below(support.PACKAGE)
        self.assertEqual(sorted(kept), sorted(fresh))
        for name, text in fresh.items():
            self.assertEqual(kept[name], text, f"{name}: run scripts/python_stubs.sh")


if __name__ == "__main__":
    unittest.main()
