"""Records the leader's armature as a motion file."""

from . import pins
from .program import DuetError

# Maximum error of linear interpolation between label keyframes.
LABEL_TOLERANCE = 0.01
HEAD_TOP = "HeadTop_End"


class Recording:
    """Positions and label weights of each frame, in metres with y up.

    The head of each bone is a joint. A bone without children adds its tail, where rigs that end
    there have hands, feet and the top of the head.
    """

    def __init__(self, scene, armature):
        self.scene = scene
        self.armature = armature
        self.metres = metres_per_unit(scene)
        self.joints = []  # (name, index of the parent or -1, bone, is the bone's tail)
        for bone in armature.pose.bones:
            self._add(bone)
        self.frames = []  # [frames][joints][3]
        self.weights = []  # [frames][labels]
        self.pins = pins.Sampler(scene, self.metres)

    def _add(self, bone):
        parents = {name: index for index, (name, _, _, tail) in enumerate(self.joints) if not tail}
        parent = parents.get(bone.parent.name, -1) if bone.parent else -1
        self.joints.append((bone.name, parent, bone.name, False))
        if not bone.children:
            name = HEAD_TOP if "head" in bone.name.lower() else f"{bone.name}.end"
            self.joints.append((name, len(self.joints) - 1, bone.name, True))

    def take(self):
        """A generator that records one frame of the scene per step and then restores the frame."""
        scene = self.scene
        before, subframe = scene.frame_current, scene.frame_subframe
        try:
            for frame in range(scene.frame_start, scene.frame_end + 1):
                scene.frame_set(frame)
                self.frames.append(self.places())
                self.weights.append([label.weight for label in scene.duet.labels])
                self.pins.take(frame)
                yield
        finally:
            scene.frame_set(before, subframe=subframe)

    def places(self):
        """The places of the joints in the current frame."""
        world, pose = self.armature.matrix_world, self.armature.pose.bones
        frame = []
        for _, _, bone, tail in self.joints:
            x, y, z = world @ (pose[bone].tail if tail else pose[bone].head)
            frame.append([self.metres * x, self.metres * z, -self.metres * y])
        return frame

    def write(self, path):
        """Writes BVH, because its hierarchy helps `duet` to recognise the joints."""
        lines = ["HIERARCHY"]
        order = []
        roots = [index for index, joint in enumerate(self.joints) if joint[1] < 0]
        for root in roots:
            self._write_joint(root, 0, lines, order)
        lines += ["MOTION", f"Frames: {len(self.frames)}", f"Frame Time: {1 / frame_rate(self.scene):.9f}"]
        for frame in self.frames:
            lines.append(" ".join(f"{value:.6f}" for joint in order
                                  for value in self._from_parent(frame, joint)))
        with open(path, "w", encoding="utf-8") as file:
            file.write("\n".join(lines) + "\n")

    def _from_parent(self, frame, joint):
        parent = self.joints[joint][1]
        if parent < 0:
            return frame[joint]
        return [a - b for a, b in zip(frame[joint], frame[parent])]

    def _write_joint(self, joint, depth, lines, order):
        pad = "  " * depth
        order.append(joint)
        offset = [0, 0, 0] if depth == 0 else self._from_parent(self.frames[0], joint)
        lines += [f"{pad}{'JOINT' if depth else 'ROOT'} {self.joints[joint][0]}", f"{pad}{{",
                  f"{pad}  OFFSET {' '.join(f'{value:.6f}' for value in offset)}",
                  f"{pad}  CHANNELS 3 Xposition Yposition Zposition"]
        for child, (_, parent, _, _) in enumerate(self.joints):
            if parent == joint:
                self._write_joint(child, depth + 1, lines, order)
        lines.append(f"{pad}}}")

    def reading_flags(self):
        """Flags for reading the file: its unit and the user's choice of bones for joints."""
        return ["--metres-per-unit", "1", *joint_flags(self.scene.duet, "--joint-map")]

    def label_flags(self):
        """--label for constant weights, --keyframe for weights that change."""
        names = [label.name for label in self.scene.duet.labels]
        if not any(any(weights) for weights in self.weights):
            raise DuetError("Every label is 0. Move a slider.")
        keys = simplified(self.weights)
        if len(keys) == 1:
            return [word for name, weight in zip(names, self.weights[0]) if weight
                    for word in ("--label", f"{name}={weight:.4g}")]
        flags = []
        for key in keys:
            weights = ",".join(f"{name}={weight:.4g}"
                               for name, weight in zip(names, self.weights[key]))
            flags += ["--keyframe", f"{key}:{weights}"]
        return flags

    def place_flags(self):
        """--follower-start at the empty, raised to the height of the leader's middle if it is
        lower."""
        empty = self.scene.duet.place
        if empty is None:
            return []
        x, y, z = (self.metres * value for value in empty.matrix_world.translation)
        heights = [place[1] for place, (_, _, _, tail) in zip(self.frames[0], self.joints) if not tail]
        middle = min(heights) + 0.62 * (max(heights) - min(heights))
        return ["--follower-start", f"{x:.4f},{max(z, middle):.4f},{-y:.4f}"]


def joint_flags(settings, flag, field="bone"):
    """A flag for every joint whose bone the user chose. `field`: of DuetJoint."""
    chosen = [(joint.name, getattr(joint, field)) for joint in settings.joints]
    return [word for joint, bone in chosen if bone for word in (flag, f"{joint}={bone}")]


def metres_per_unit(scene):
    """The user's choice, or the scene's unit."""
    chosen = {"METRES": 1, "CENTIMETRES": 0.01, "MILLIMETRES": 0.001, "INCHES": 0.0254}
    return chosen.get(scene.duet.unit, scene.unit_settings.scale_length)


def frame_rate(scene):
    return scene.render.fps / scene.render.fps_base


def simplified(rows):
    """Indices of rows that reproduce the others by linear interpolation; only 0 if all are
    equal."""
    last = len(rows) - 1

    def off(start, end, row):
        share = (row - start) / (end - start)
        return max(abs(a + (b - a) * share - value)
                   for a, b, value in zip(rows[start], rows[end], rows[row]))

    kept, open_spans = {0, last}, [(0, last)]
    while open_spans:
        start, end = open_spans.pop()
        if end - start < 2:
            continue
        worst = max(range(start + 1, end), key=lambda row: off(start, end, row))
        if off(start, end, worst) > LABEL_TOLERANCE:
            kept.add(worst)
            open_spans += [(start, worst), (worst, end)]
    if kept == {0, last} and rows[0] == rows[last]:
        return [0]
    return sorted(kept)
