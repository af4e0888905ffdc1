"""Motion files in every format that Duet reads, for tests."""

import json
import pathlib
import subprocess

SAMPLES = pathlib.Path(__file__).parents[3] / "samples"

# The bones of a person: name, parent, direction, length in inches.
_BONES = (
    ("lhipjoint", "root", (0.6, -0.8, 0), 4), ("lfemur", "lhipjoint", (0.3, -0.95, 0), 16),
    ("ltibia", "lfemur", (0.3, -0.95, 0), 16), ("lfoot", "ltibia", (0, -0.3, 0.95), 4),
    ("rhipjoint", "root", (-0.6, -0.8, 0), 4), ("rfemur", "rhipjoint", (-0.3, -0.95, 0), 16),
    ("rtibia", "rfemur", (-0.3, -0.95, 0), 16), ("rfoot", "rtibia", (0, -0.3, 0.95), 4),
    ("lowerback", "root", (0, 1, 0), 5), ("upperback", "lowerback", (0, 1, 0), 5),
    ("thorax", "upperback", (0, 1, 0), 5), ("lowerneck", "thorax", (0, 1, 0), 4),
    ("head", "lowerneck", (0, 1, 0), 4), ("lclavicle", "thorax", (1, 0.3, 0), 4),
    ("lhumerus", "lclavicle", (1, 0, 0), 11), ("lradius", "lhumerus", (1, 0, 0), 9),
    ("lhand", "lradius", (1, 0, 0), 3), ("rclavicle", "thorax", (-1, 0.3, 0), 4),
    ("rhumerus", "rclavicle", (-1, 0, 0), 11), ("rradius", "rhumerus", (-1, 0, 0), 9),
    ("rhand", "rradius", (-1, 0, 0), 3))


def write_all(program, folder):
    """Writes a motion in every format, of one person and, where the format has two, of two. Returns
    the files."""
    files = [_copy(SAMPLES / "hug.bvh", folder / "hug.bvh"), _acclaim(folder)]
    for name in ("one.csv", "one.glb", "one.gltf", "one.json", "one.npy"):
        files.append(_convert(program, files[0], folder / name))
    pair = folder / "pair.json"
    pair.write_text(_pair(folder / "one.json"), encoding="utf-8")
    files.append(pair)
    for name in ("pair.csv", "pair.glb", "pair.npy", "pair.txt"):
        files.append(_convert(program, pair, folder / name))
    return files


def options_of(file):
    """The arguments without which a file cannot be read."""
    return {"frame_rate_hz": 30} if file.suffix == ".npy" else {}


def _copy(source, target):
    target.write_bytes(source.read_bytes())
    return target


def _convert(program, source, target):
    subprocess.run([program, "convert", source, "--out", target, "--quiet"], check=True)
    return target


def _pair(one):
    """A document of one person twice."""
    document = json.loads(one.read_text(encoding="utf-8"))
    document["follower"] = [[[x + 1, y, z] for x, y, z in frame] for frame in document["leader"]]
    return json.dumps(document)


def _acclaim(folder):
    """An .amc file, beside its skeleton."""
    lines = [":version 1.10", ":name person", ":units", "  mass 1.0", "  length 0.45", "  angle deg",
             ":root", "  order TX TY TZ RX RY RZ", "  axis XYZ", "  position 0 0 0",
             "  orientation 0 0 0", ":bonedata"]
    for number, (name, _, direction, length) in enumerate(_BONES, start=1):
        lines += ["  begin", f"    id {number}", f"    name {name}",
                  f"    direction {direction[0]} {direction[1]} {direction[2]}",
                  f"    length {length * 0.45}", "    axis 0 0 0 XYZ", "    dof rx ry rz",
                  "    limits (-180 180)", "           (-180 180)", "           (-180 180)", "  end"]
    lines += [":hierarchy", "  begin"]
    for parent in ("root", *(name for name, *_ in _BONES)):
        children = [name for name, above, *_ in _BONES if above == parent]
        if children:
            lines.append(f"  {parent} {' '.join(children)}")
    lines.append("  end")
    (folder / "person.asf").write_text("\n".join(lines) + "\n", encoding="utf-8")
    frames = ["#!OML:ASF person.asf", ":FULLY-SPECIFIED", ":DEGREES"]
    for frame in range(1, 5):
        frames += [str(frame), f"root 0 {17 + 0.1 * frame} {frame} 0 {frame} 0"]
        frames += [f"{name} {frame} {2 * frame} {3 * frame}" for name, *_ in _BONES]
    (folder / "person.amc").write_text("\n".join(frames) + "\n", encoding="utf-8")
    return folder / "person.amc"
