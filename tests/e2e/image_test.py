"""deploy/image/build.sh passes the right arguments to podman. A fake podman records them."""

import os
import pathlib
import tempfile
import unittest

import tools

SCRIPT = tools.SOURCE / "deploy" / "image" / "build.sh"
PODMAN = """#!/bin/sh
case "$1 $2" in
  "image exists") exit 1 ;;
  "image inspect") echo 76000000 ;;
  *) printf '%s\\n' "$@" >"$RECORD" ;;
esac
"""

if not (tools.SOURCE / ".git").exists():
    tools.skip("the sources are not a git repository, whose revision the image has as a label")


class ImageTest(unittest.TestCase):
    def build(self, *arguments):
        """The arguments of `podman build`, and what the script prints."""
        with tempfile.TemporaryDirectory() as folder:
            podman = pathlib.Path(folder) / "podman"
            podman.write_text(PODMAN, encoding="utf-8")
            podman.chmod(0o755)
            record = pathlib.Path(folder) / "record"
            result = tools.run(SCRIPT, *arguments, env={
                **os.environ, "PATH": f"{folder}:{os.environ['PATH']}", "RECORD": str(record)})
            self.assertEqual(result.returncode, 0, result.stderr)
            return record.read_text(encoding="utf-8").splitlines(), result.stdout

    def test_an_image_has_all_weights_by_default(self):
        arguments, output = self.build()
        self.assertIn("RESEARCH_WEIGHTS=ON", arguments)
        self.assertIn("localhost/duet:latest", arguments)
        self.assertRegex(output, r"localhost/duet:[\d.]+: 76 MB")

    def test_a_free_image_has_no_research_weights_and_another_name(self):
        for target, name in ((), "duet-free"), (("training",), "duet-training-free"):
            arguments, output = self.build("--free", *target)
            self.assertIn("RESEARCH_WEIGHTS=OFF", arguments)
            self.assertIn(f"localhost/{name}:latest", arguments)
            self.assertIn(f"localhost/{name}:", output)

    def test_flags_of_podman_follow_the_target(self):
        arguments, _ = self.build("--free", "server", "--build-arg", "RESEARCH_WEIGHTS=ON")
        values = [word for word in arguments if word.startswith("RESEARCH_WEIGHTS=")]
        self.assertEqual(values[-1], "RESEARCH_WEIGHTS=OFF", "the last one applies")


if __name__ == "__main__":
    tools.main()
