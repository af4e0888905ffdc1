"""Reads and writes motion files with the program `duet`: a few at a time, with limits on time and
memory of each. It runs in a temporary folder and gets relative names, so that no message reveals
the folder's path."""

import asyncio
import contextlib
import json
import os
import pathlib
import re
import shutil
import tempfile
import zipfile

from aiohttp import web
from serving import HEADERS, Refused, shown

PROGRAMS_AT_A_TIME = 4
PROGRAM_SECONDS = 60         # processor time, and time of a conversion
PROGRAM_BYTES = 2**30
CHUNK_BYTES = 2**18
MAX_NAME_BYTES = 150         # without the extension; file systems allow 255
MAX_JOINTS = 300
JOINT = re.compile(r"([^\0-\x1f\x7f:,]{1,64}):([0-9]{0,3})")
MODEL_FILE = "skeleton of the model"  # no visitor's file has a name with a blank
FILE_NAME = re.compile(r"[A-Za-z0-9_][\w@.+-]*", re.ASCII)
VALUE = re.compile(r"[^\0-\x1f\x7f]{1,200}")
FORMATS = {"glb": "model/gltf-binary", "gltf": "model/gltf+json",
           "bvh": "text/plain", "html": "text/html", "csv": "text/csv",
           "json": "application/json"}
# The page's settings for reading a file, as flags of `duet`.
READING = {"unit": "--unit", "up_axis": "--up-axis", "metres_per_unit": "--metres-per-unit",
           "frame_rate": "--frame-rate", "joint_map": "--joint-map"}
# The page's settings for a rig's file, as flags of `duet convert`.
RIG = {"side": "--rig-side", "up_axis": "--rig-up-axis",
       "metres_per_unit": "--rig-metres-per-unit", "joint_map": "--rig-joint-map",
       "resample": "--resample"}


# The last line of an error, which names a flag.
HINT = re.compile(r"\nSpecify it with (--[\w-]+).*\Z", re.DOTALL)


def in_the_page(message):
    """Replaces the hint about a flag of the program by one about the page's settings."""
    def hint(found):
        readable = found[1] in READING.values()
        return '\nSpecify it under "How the file is read".' if readable else ""
    return HINT.sub(hint, message.strip().removeprefix("duet: "))


class Duet:
    """Runs the program `duet`."""

    def __init__(self):
        name = os.environ.get("DUET_PROGRAM", "duet")
        self._program = shutil.which(name)
        if self._program is None:
            raise FileNotFoundError(f"DUET_PROGRAM: expected the program duet, got {name!r}, which "
                                    "does not exist; put duet on the PATH, or set its path")
        self._program = os.path.abspath(self._program)
        self._free = asyncio.Semaphore(PROGRAMS_AT_A_TIME)

    async def run(self, folder, *arguments):
        """Runs the program in a folder and returns its output.

        Raises:
            Refused: the program failed (with its message) or exceeded a limit.
        """
        async with self._free:
            process = await asyncio.create_subprocess_exec(
                "prlimit", f"--data={PROGRAM_BYTES}", f"--cpu={PROGRAM_SECONDS}", "--core=0",
                self._program, *arguments, cwd=folder, stdin=asyncio.subprocess.DEVNULL,
                stdout=asyncio.subprocess.PIPE, stderr=asyncio.subprocess.PIPE,
                env={**os.environ, "NO_COLOR": "1"})
            try:
                async with asyncio.timeout(PROGRAM_SECONDS):
                    out, told = await process.communicate()
            except TimeoutError:
                raise Refused(422, f"file: expected one that takes at most {PROGRAM_SECONDS} s, "
                                   "got one that takes longer") from None
            finally:
                if process.returncode is None:
                    process.kill()
                    await process.wait()
        if process.returncode < 0:
            raise Refused(422, f"file: expected one that needs at most {PROGRAM_BYTES >> 20} MiB "
                               f"and {PROGRAM_SECONDS} s, got one that needs more")
        if process.returncode != 0:
            raise Refused(422, in_the_page(told.decode(errors="replace")))
        return out.decode()

    async def read(self, folder, name, settings):
        """Reads one person from the file `name`, in the joints of the setting `skeleton` if there is
        one. Returns the path of its "duet-motion" JSON and the program's notes."""
        skeleton = settings.pop("skeleton", None)
        if skeleton is not None:
            (folder / MODEL_FILE).write_text(json.dumps(skeleton_of(skeleton[0])), encoding="utf-8")
        flags = flags_of({"side": "left", **settings}, {"side": "--side", **READING})
        if skeleton is not None:
            flags.append(f"--skeleton={MODEL_FILE}")
        told = await self.run(folder, "convert", name, *flags, "--out", "leader.duet.json",
                              "--json")
        return folder / "leader.duet.json", json.loads(told).get("notes", [])

    async def write(self, folder, pair, kind, stem, resample, joints):
        """Converts a pair in "duet-motion" JSON to another format. Returns the file. `joints`: flags
        of `own_joints`."""
        out = folder / "out"
        out.mkdir()
        if resample:
            rate = flags_of({"resample": resample}, {"resample": "--resample"})
            await self.run(folder, "convert", pair, *rate, *joints, "--out", "resampled.json",
                           "--quiet")
            pair = "resampled.json"
        if kind == "html":
            await self.run(folder, "view", f"{stem}={pair}", "--title", stem, *joints, "--out",
                           f"out/{stem}.html", "--quiet")
        else:
            await self.run(folder, "convert", pair, *joints, "--out", f"out/{stem}.{kind}",
                           "--quiet")
        files = sorted(out.iterdir())
        return files[0] if len(files) == 1 else await asyncio.to_thread(packed, files, stem)

    async def write_on_rig(self, folder, pair, rig, kind, stem, settings):
        """Converts the follower of a pair in "duet-motion" JSON, with all of its joints, to a file on
        a rig. Returns it."""
        out = folder / "out"
        out.mkdir()
        file = f"out/{stem}.follower.{kind}"
        await self.run(folder, "convert", pair, *own_joints("own", pair), "--side", "right",
                       f"--rig={rig}", *flags_of(settings, RIG), "--out", file, "--quiet")
        return folder / file


@contextlib.contextmanager
def workplace():
    """Yields a temporary folder for one request."""
    with tempfile.TemporaryDirectory(prefix="duet-gateway-") as folder:
        yield pathlib.Path(folder)


def file_name(name):
    """Returns the name of a visitor's file if it is a safe file name, else raises Refused."""
    if not isinstance(name, str) or len(name) > MAX_NAME_BYTES or not FILE_NAME.fullmatch(name):
        raise Refused(400, f"name: expected at most {MAX_NAME_BYTES} letters, digits and -._@+, a "
                           f"letter or digit first, got {shown(str(name))}")
    return name


def format_of(name):
    if name not in FORMATS:
        raise Refused(400, f"format: expected one of {', '.join(FORMATS)}, got {shown(str(name))}")
    return name


def skeleton_of(text):
    """Converts joints as NAME:PARENT,... to a skeleton for `duet convert --skeleton`. The parent is
    an index; the root has none."""
    joints = [JOINT.fullmatch(item) for item in text.split(",")]
    if len(joints) > MAX_JOINTS or not all(joints):
        raise Refused(400, f"skeleton: expected at most {MAX_JOINTS} joints as NAME:PARENT,..., got "
                           f"{shown(text)}")
    return {"joint_names": [joint[1] for joint in joints],
            "bones": [[int(joint[2]), child] for child, joint in enumerate(joints) if joint[2]]}


def own_joints(skeleton, pair):
    """Flags for reading a pair with its own joints and bones (skeleton "own"), or with those of sbu
    ("")."""
    if skeleton not in ("", "own"):
        raise Refused(400, f"skeleton: expected own, got {shown(str(skeleton))}")
    return [f"--skeleton={pair}"] if skeleton else []


def flags_of(settings, table):
    """Converts settings, {name: value or list of values}, to flags. The program checks the
    values."""
    flags = []
    for name, values in settings.items():
        if name not in table:
            raise Refused(400, f"settings: expected {', '.join(table)}, got {shown(str(name))}")
        for value in values if isinstance(values, list) else [values]:
            if not isinstance(value, str) or not VALUE.fullmatch(value):
                raise Refused(400, f"{name}: expected at most 200 printable characters, got "
                                   f"{shown(str(value))}")
            flags.append(f"{table[name]}={value}")
    return flags


def packed(files, stem):
    """Packs several files into a zip file."""
    archive = files[0].parent / f"{stem}.zip"
    with zipfile.ZipFile(archive, "w", zipfile.ZIP_DEFLATED) as out:
        for file in files:
            out.write(file, file.name)
    return archive


def take_apart(body, pair, rig):
    """Splits a body into its first line, a pair as JSON, and the rig's file that follows."""
    with open(body, "rb") as source, open(pair, "wb") as first, open(rig, "wb") as second:
        while (piece := source.readline(CHUNK_BYTES)) and not piece.endswith(b"\n"):
            first.write(piece)
        first.write(piece)
        shutil.copyfileobj(source, second)


async def send_file(request, path, kind, before=b"", after=b"", headers=()):
    """Answers with a file, which is read while it is sent."""
    size = len(before) + path.stat().st_size + len(after)
    response = web.StreamResponse(headers={**HEADERS, "Content-Type": kind,
                                           "Content-Length": str(size), **dict(headers)})
    await response.prepare(request)
    await response.write(before)
    with open(path, "rb") as file:
        while data := file.read(CHUNK_BYTES):
            await response.write(data)
    await response.write(after)
    return response
