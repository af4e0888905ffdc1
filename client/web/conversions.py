"""Motion files, read and written by the program `duet`: a few at a time, with bounds on the time
and the memory of each. It runs in a folder of its own and gets names within it, so that no message
shows where that lies."""

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
PROGRAM_SECONDS = 60         # of the processor, and of a conversion
PROGRAM_BYTES = 2**30
SYNTHESIS_SECONDS = 150      # of a call to the server, and what is written of it
CHUNK_BYTES = 2**18
MAX_NAME_BYTES = 150         # an ending is added to it, and a file system takes 255
MAX_SETTINGS_BYTES = 2**16
FILE_NAME = re.compile(r"[A-Za-z0-9_][\w@.+-]*", re.ASCII)
VALUE = re.compile(r"[^\0-\x1f\x7f]{1,200}")
POINT = re.compile(r"[-+0-9.eE]+(,[-+0-9.eE]+){2}")
FORMATS = {"glb": "model/gltf-binary", "gltf": "model/gltf+json", "usda": "text/plain",
           "bvh": "text/plain", "html": "text/html", "csv": "text/csv",
           "json": "application/json"}
# How a file is read: settings of the page as flags of `duet`.
READING = {"unit": "--unit", "up_axis": "--up-axis", "metres_per_unit": "--metres-per-unit",
           "frame_rate": "--frame-rate", "joint_map": "--joint-map"}
# What is asked of the server for a file.
ASKING = {"side": "--leader-side", **READING, "label": "--label", "keyframe": "--keyframe",
          "model": "--model", "seed": "--seed", "variety": "--variety",
          "follower_start": "--follower-start", "partner_direction": "--partner-direction",
          "clean_up": "--clean-up", "rig_joint_map": "--follower-rig-joint-map"}


class Duet:
    """The program `duet`. `server` are its flags that say which server it asks."""

    def __init__(self, server=()):
        name = os.environ.get("DUET_PROGRAM", "duet")
        self._program = shutil.which(name)
        if self._program is None:
            raise FileNotFoundError(f"DUET_PROGRAM: expected the program duet, got {name!r}, which "
                                    "is not there; put duet on the PATH, or name its place")
        self._program = os.path.abspath(self._program)
        self._server = server
        self._free = asyncio.Semaphore(PROGRAMS_AT_A_TIME)

    async def run(self, folder, *arguments, seconds=PROGRAM_SECONDS):
        """What the program prints, run in a folder.

        Raises:
            Refused: it failed, in its own words, or went beyond its bounds.
        """
        async with self._free:
            process = await asyncio.create_subprocess_exec(
                "prlimit", f"--data={PROGRAM_BYTES}", f"--cpu={PROGRAM_SECONDS}", "--core=0",
                self._program, *arguments, cwd=folder, stdin=asyncio.subprocess.DEVNULL,
                stdout=asyncio.subprocess.PIPE, stderr=asyncio.subprocess.PIPE,
                env={**os.environ, "DUET_CONFIG": "", "NO_COLOR": "1"})
            try:
                async with asyncio.timeout(seconds):
                    out, told = await process.communicate()
            except TimeoutError:
                raise Refused(422, f"file: expected one that takes at most {seconds} s, got one "
                                   "that takes longer") from None
            finally:
                if process.returncode is None:
                    process.kill()
                    await process.wait()
        if process.returncode < 0:
            raise Refused(422, f"file: expected one that needs at most {PROGRAM_BYTES >> 20} MiB "
                               f"and {PROGRAM_SECONDS} s, got one that needs more")
        if process.returncode != 0:
            raise Refused(422, told.decode(errors="replace").strip().removeprefix("duet: "))
        return out.decode()

    async def read(self, folder, name, settings):
        """Reads one person of the file `name`. Returns where it is as "duet-motion" JSON, and the
        program's notes on it."""
        flags = flags_of({"side": "left", **settings}, {"side": "--side", **READING})
        told = await self.run(folder, "convert", name, *flags, "--out", "leader.duet.json",
                              "--json")
        return folder / "leader.duet.json", json.loads(told).get("notes", [])

    async def write(self, folder, pair, kind, stem, resample):
        """Writes a pair of "duet-motion" JSON in another format. Returns the file."""
        out = folder / "out"
        out.mkdir()
        if resample:
            rate = flags_of({"resample": resample}, {"resample": "--resample"})
            await self.run(folder, "convert", pair, *rate, "--out", "resampled.json", "--quiet")
            pair = "resampled.json"
        if kind == "html":
            await self.run(folder, "view", f"{stem}={pair}", "--title", stem, "--out",
                           f"out/{stem}.html", "--quiet")
        else:
            await self.run(folder, "convert", pair, "--out", f"out/{stem}.{kind}", "--quiet")
        files = sorted(out.iterdir())
        return files[0] if len(files) == 1 else await asyncio.to_thread(packed, files, stem)

    async def write_on_rig(self, folder, leader, rig, kind, stem, settings, authorization):
        """Asks the server for a follower and writes it on a rig: `rig` is "leader" or a file.
        Returns the file."""
        out = folder / "out"
        out.mkdir()
        token = []
        if authorization.startswith("Bearer "):
            (folder / "token").touch(0o600)
            (folder / "token").write_text(authorization.removeprefix("Bearer "), encoding="utf-8")
            token = ["--token-file", "token"]
        await self.run(folder, "synthesize", *self._server, *token, f"--leader={leader}",
                       f"--follower-rig={rig}", *flags_of(settings, ASKING), "--out",
                       f"out/{stem}.{kind}", "--quiet", seconds=SYNTHESIS_SECONDS)
        return out / f"{stem}.follower.{kind}"


@contextlib.contextmanager
def workplace():
    """A folder for one request, removed with what is in it."""
    with tempfile.TemporaryDirectory(prefix="duet-gateway-") as folder:
        yield pathlib.Path(folder)


def file_name(name):
    """The name of a visitor's file, where it can be that of a file here."""
    if not isinstance(name, str) or len(name) > MAX_NAME_BYTES or not FILE_NAME.fullmatch(name):
        raise Refused(400, f"name: expected at most {MAX_NAME_BYTES} letters, digits and -._@+, a "
                           f"letter or digit first, got {shown(str(name))}")
    return name


def format_of(name):
    if name not in FORMATS:
        raise Refused(400, f"format: expected one of {', '.join(FORMATS)}, got {shown(str(name))}")
    return name


def flags_of(settings, table):
    """Settings, {name: value or list of values}, as flags. The program checks what they say."""
    flags = []
    for name, values in settings.items():
        if name not in table:
            raise Refused(400, f"settings: expected {', '.join(table)}, got {shown(str(name))}")
        for value in values if isinstance(values, list) else [values]:
            if not isinstance(value, str) or not VALUE.fullmatch(value):
                raise Refused(400, f"{name}: expected at most 200 printable characters, got "
                                   f"{shown(str(value))}")
            # The program would take anything else for the name of a file on this machine.
            if name == "follower_start" and not POINT.fullmatch(value):
                raise Refused(400, f"follower_start: expected X,Y,Z in metres, got {shown(value)}")
            flags.append(f"{table[name]}={value}")
    return flags


def packed(files, stem):
    """Several files as one."""
    archive = files[0].parent / f"{stem}.zip"
    with zipfile.ZipFile(archive, "w", zipfile.ZIP_DEFLATED) as out:
        for file in files:
            out.write(file, file.name)
    return archive


def take_apart(body, folder):
    """The settings in the first line of a body, and the files that follow it, which the settings
    name with their sizes: {"files": [{"name": NAME, "bytes": COUNT}, ...]}. Each file is put into a
    folder of its own. Returns the settings and the files' paths, relative to `folder`."""
    with open(body, "rb") as source:
        try:
            settings = json.loads(source.readline(MAX_SETTINGS_BYTES))
            wanted = [(file_name(file["name"]), int(file["bytes"])) for file in settings["files"]]
        except (ValueError, TypeError, KeyError, RecursionError) as error:
            raise Refused(400, "body: expected a line of JSON with files, name and bytes of each, "
                               f"got {type(error).__name__}") from None
        paths = []
        for index, (name, size) in enumerate(wanted[:2]):
            path = folder / str(index) / name
            path.parent.mkdir()
            with open(path, "wb") as out:
                out.write(source.read(max(size, 0)))
            if path.stat().st_size != size:
                raise Refused(400, f"files[{index}].bytes: expected what follows, got {size}")
            paths.append(str(path.relative_to(folder)))
    return settings, paths


async def send_file(request, path, kind, before=b"", after=b"", headers=()):
    """Answers with a file's contents, read as they are sent."""
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
