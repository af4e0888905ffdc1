"""The build of the images gets every file that it reads."""

import fnmatch
import pathlib
import re
import shutil

import tools

# What the image for training installs: without other components, such as the server's unit.
INSTALLED = re.compile(r'if\(CMAKE_INSTALL_COMPONENT STREQUAL "training".*?endif', re.DOTALL)

if not (tools.SOURCE / ".git").exists():
    tools.skip("the sources are not a git repository, whose revision the image has as a label")


def sent():
    """The paths of the repository that .dockerignore lets into the build; the last line that matches decides."""
    lines = (tools.SOURCE / ".dockerignore").read_text(encoding="utf-8").splitlines()
    rules = [(not line.startswith("!"), line.lstrip("!").rstrip("/")) for line in lines
             if line and not line.startswith("#")]
    listed = tools.run("git", "-c", f"safe.directory={tools.SOURCE}", "ls-files", cwd=tools.SOURCE).stdout.splitlines()
    for name in listed:
        path = pathlib.PurePosixPath(name)
        parts = [str(part) for part in (path, *path.parents)]
        ignored = False
        for ignores, rule in rules:
            if any(fnmatch.fnmatch(f"/{part}", f"/{rule}".replace("/**/", "*/")) for part in parts):
                ignored = ignores
        if not ignored:
            yield name


class ContextTest(tools.FolderTest):
    def test_the_build_gets_every_file_that_it_reads_or_installs(self):
        names = set(sent())
        self.assertIn("server/CMakeLists.txt", names)
        self.assertFalse({"README.md", "tests/CMakeLists.txt", "client/python/README.md"} & names)
        for name in names:
            (self.folder / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(tools.SOURCE / name, self.folder / name)
        training = tools.run(tools.SOURCE / "scripts/with_training.sh").stdout.strip()
        done = tools.run("cmake", "--preset", "release", "-DDUET_BUILD_TESTS=OFF", "-DDUET_BUILD_BENCHMARKS=OFF",
                         f"-DDUET_TRAINING={training}", cwd=self.folder,
                         timeout=600)  # a busy machine needs minutes
        self.assertEqual(done.returncode, 0, done.stderr)
        for script in (self.folder / "build").rglob("cmake_install.cmake"):
            for block in INSTALLED.findall(script.read_text(encoding="utf-8")):
                for file in re.findall(rf'"{self.folder}/(?!build/)([^"]+)"', block):
                    self.assertTrue((self.folder / file).exists(), file)


if __name__ == "__main__":
    tools.main()
