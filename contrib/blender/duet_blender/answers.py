"""Answers to the leader: requests them, keeps their files, and shows one as the partner."""

import json
import os
import shutil
import tempfile

import bpy

from . import leader, partner, pins, program
from .program import DuetError

GALLERY_SIZE = 8
_LARGEST_SEED = 2 ** 31 - 1  # of a field in Blender
_FAULTS = ("twist", "overlap", "slide")


class DuetAnswer(bpy.types.PropertyGroup):
    """One answer, whose file lasts until Blender ends."""

    seed: bpy.props.StringProperty()  # up to 2^64 - 1
    file: bpy.props.StringProperty()
    grade: bpy.props.StringProperty()  # such as "slide 12 %"
    faults: bpy.props.FloatProperty()  # the sum by which answers are sorted
    pins: bpy.props.StringProperty()   # what remains of the pins


def faults_of(grade):
    """The shares of frames that a viewer would fault, by name."""
    slide = max(0, grade["skating"] - grade["leader_skating"])
    return dict(zip(_FAULTS, (grade["twisted"], grade["overlapping"], slide)))


def describe_grade(grade):
    """The worst fault of a grade, or "no faults" if all are below 1 %."""
    name, share = max(faults_of(grade).items(), key=lambda fault: fault[1])
    return f"{name} {100 * share:.0f} %" if share >= 0.005 else "no faults"


def _folder(scene):
    """An empty folder for the scene's answers. The files of earlier answers are removed."""
    for answer in scene.duet.answers:
        shutil.rmtree(os.path.dirname(answer.file), ignore_errors=True)
    scene.duet.answers.clear()
    return tempfile.mkdtemp(prefix="duet_answers_", dir=bpy.app.tempdir or None)


def request(scene, count):
    """A generator that requests `count` answers with consecutive seeds and lists them, best first. The first seed is
    the panel's or the server's choice."""
    duet = scene.duet
    program.find(duet.program)
    duet.state = "Reading the leader"
    recording = leader.Recording(scene, duet.leader)
    yield from recording.take()
    flags = [*recording.reading_flags(), *recording.label_flags(), *recording.place_flags()]
    with tempfile.TemporaryDirectory() as work:
        if recording.pins.constraints:
            pinned = os.path.join(work, "pins.textproto")
            with open(pinned, "w", encoding="utf-8") as file:
                file.write("\n".join(recording.pins.constraints))
            flags += ["--request", pinned]
        motion = os.path.join(work, "leader.bvh")
        recording.write(motion)
        duet.state = "Waiting for the server"
        summaries = []
        seed = duet.seed if duet.own_seed else None
        for index in range(count):
            output = yield from program.run(
                duet, "synthesize", "--server", duet.server, "--leader", motion, *flags,
                *(["--model", duet.model] if duet.model else []),
                *([] if seed is None else ["--seed", str(seed)]), "--variety", f"{duet.variety:.4g}", "--candidates", str(duet.candidates),
                "--json", "--out", os.path.join(work, f"{index}.json"))
            summaries.append(json.loads(output))
            seed = summaries[-1]["seed"] + 1
        _list(scene, summaries, work)


def _list(scene, summaries, work):
    """Lists the answers of summaries, and moves their files out of `work`."""
    found = []
    folder = _folder(scene)
    for summary in summaries:
        file = os.path.join(folder, f"{summary['seed']}.json")
        shutil.move(os.path.join(work, summary["files"][0]), file)
        found.append((summary, file))
    found.sort(key=lambda one: sum(faults_of(one[0]["grade"]).values()) if "grade" in one[0] else 0)
    for summary, file in found:
        answer = scene.duet.answers.add()
        answer.seed, answer.file = str(summary["seed"]), file
        if "grade" in summary:
            answer.grade = describe_grade(summary["grade"])
            answer.faults = sum(faults_of(summary["grade"]).values())
        answer.pins = pins.describe(summary.get("constraints", []), scene.frame_start)


def show(scene, index):
    """A generator that shows an answer in place of the last partner."""
    duet = scene.duet
    if not 0 <= index < len(duet.answers):
        raise DuetError(f"answer: expected one of {len(duet.answers)}, got {index}")
    answer = duet.answers[index]
    if not os.path.isfile(answer.file):
        raise DuetError("The answers of an earlier session are gone. Press React again.")
    with tempfile.TemporaryDirectory() as work:
        file = os.path.join(work, "follower.glb")
        yield from program.run(duet, "convert", answer.file, "--side", "right", "--skeleton", answer.file,
                               *_body_flags(scene, os.path.join(work, "rig.glb")), "--out", file, "--quiet")
        partner.remove_last(scene)
        partner.add(scene, file, scene.unit_settings.scale_length / leader.metres_per_unit(scene))
    duet.chosen = index
    duet.seed = min(int(answer.seed), _LARGEST_SEED)
    duet.state = ", ".join(filter(None, (f"{partner.NAME}: seed {answer.seed}", answer.pins)))


def _body_flags(scene, file):
    """The flags for the partner's body. Writes the armature whose copy the partner is to `file`."""
    duet = scene.duet
    if duet.body == "MANNEQUIN":
        return []
    if duet.body == "LEADER":
        partner.export_rig(scene, duet.leader, leader.metres_per_unit(scene), file)
        return ["--rig", file, *leader.joint_flags(duet, "--rig-joint-map")]
    if duet.target is None:
        raise DuetError("Choose your armature under Body: the partner becomes a copy of it.")
    partner.export_rig(scene, duet.target, scene.unit_settings.scale_length, file)
    return ["--rig", file, *leader.joint_flags(duet, "--rig-joint-map", "rig_bone")]


register, unregister = bpy.utils.register_classes_factory((DuetAnswer,))
