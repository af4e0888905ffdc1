"""The armature that leads, as Duet reads motion: where its bones are in every frame."""

import json

from .program import DuetError

# A line between two key frames may be off by so much before a further one is set.
LABEL_TOLERANCE = 0.01


class Recording:
    """Positions and label weights, frame by frame, in metres with z up."""

    def __init__(self, scene, armature):
        self.scene = scene
        self.armature = armature
        self.metres = scene.unit_settings.scale_length
        self.bones = [bone.name for bone in armature.pose.bones]
        self.head = self._head()
        self.frames = []
        self.weights = []  # [frames][labels]

    def _head(self):
        """A head's bone ends at the top of the head, which its name does not say."""
        named = [bone for bone in self.armature.pose.bones
                 if "head" in bone.name.lower() and not bone.children]
        return named[0].name if named else None

    def take(self):
        """A generator that goes through the scene's frames, one at each step, and back again."""
        scene = self.scene
        before, subframe = scene.frame_current, scene.frame_subframe
        try:
            for frame in range(scene.frame_start, scene.frame_end + 1):
                scene.frame_set(frame)
                self._take_frame()
                yield
        finally:
            scene.frame_set(before, subframe=subframe)

    def _take_frame(self):
        world, pose = self.armature.matrix_world, self.armature.pose.bones
        places = [world @ pose[name].head for name in self.bones]
        if self.head:
            places.append(world @ pose[self.head].tail)
        self.frames.append([[self.metres * value for value in place] for place in places])
        self.weights.append([label.weight for label in self.scene.duet.labels])

    def write(self, path):
        names = self.bones + (["HeadTop_End"] if self.head else [])
        motion = {"format": "duet-motion", "version": 1, "frame_rate_hz": frame_rate(self.scene),
                  "unit": "metres", "up_axis": "z-up", "joint_names": names, "leader": self.frames}
        with open(path, "w", encoding="utf-8") as file:
            json.dump(motion, file)

    def label_flags(self):
        """--label for weights that stay, --keyframe for weights that change."""
        names = [label.name for label in self.scene.duet.labels]
        if not any(any(weights) for weights in self.weights):
            raise DuetError("Every label is 0: move a slider")
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
        """--follower-start where the empty is, as high as the leader's middle if it is lower."""
        empty = self.scene.duet.place
        if empty is None:
            return []
        x, y, z = (self.metres * value for value in empty.matrix_world.translation)
        heights = [place[2] for place in self.frames[0]]
        middle = min(heights) + 0.62 * (max(heights) - min(heights))
        return ["--follower-start", f"{x:.4f},{max(z, middle):.4f},{-y:.4f}"]


def frame_rate(scene):
    return scene.render.fps / scene.render.fps_base


def simplified(rows):
    """Indices of rows between which the others lie on straight lines; only 0 where all are alike."""
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
