"""The messages of a plan (plans.py)."""

import random

import live_clients
from live_clients import live_pb2, motion_pb2
from live_fuzz import labels, leaders, mistakes

UNITS = {"metres": motion_pb2.LENGTH_UNIT_METRES, "millimetres": motion_pb2.LENGTH_UNIT_MILLIMETRES,
         "sbu_normalised": motion_pb2.LENGTH_UNIT_SBU_NORMALISED}
AXES = {"y_up": motion_pb2.UP_AXIS_Y_UP, "z_up": motion_pb2.UP_AXIS_Z_UP, "y_down": motion_pb2.UP_AXIS_Y_DOWN}


class Messages:
    """`joints`: names of the model's joints, `root` that of its root."""

    def __init__(self, made, joints, root):
        self._plan = made
        self._joints = list(joints)
        if made["joint_order"] is not None:
            random.Random(made["joint_order"]).shuffle(self._joints)
        self._root = root
        self.leader = leaders.leader_of(made, self._joints)

    def start(self):
        made, history = self._plan, self._plan["history"]
        start = self._bare_start(made["labels"], made["as_vector"])
        self._set_follower_start(start)
        first = history["first_frame"] if history else 0
        self._set_leader(start, first, made["lead_in"])
        if history:
            follower = leaders.follower_of(made, self._joints, history["kind"])
            self._set_history(start, first, follower.frames(first, history["frames"]), follower.frame(0))
        return self._with_mistake(live_pb2.SynthesizeLiveRequest(start=start))

    def resumed(self, first, leader_frames, follower, follower_begin, keyframes):
        """The start of a session that goes on: `follower` are its frames from `first` on, `follower_begin` is its
        frame 0, `leader_frames` the number of the leader's from `first` on, `keyframes` its labels."""
        start = self._bare_start(labels.still_apply(keyframes, first), as_vector=False)
        self._set_leader(start, first, leader_frames)
        self._set_history(start, first, follower, follower_begin)
        return live_pb2.SynthesizeLiveRequest(start=start)

    def step(self, step, sent):
        """The message of a step other than a wait. `sent`: the index of the next leader frame."""
        if step[0] == "frames":
            return live_clients.frames_message(step[1], self.leader.frames(step[1], step[2]), step[1])
        if step[0] == "label":
            return self._change(*step[1:])
        return self._mistake(mistakes.LATER_MESSAGES[step[1]], sent)

    def _bare_start(self, keyframes, as_vector):
        made = self._plan
        start = live_pb2.LiveStart()
        start.model.name = made["model"]
        start.leader.joint_names.extend(self._joints)
        start.leader.frame_rate_hz = made["rate"]
        start.leader.unit, start.leader.up_axis = UNITS[made["unit"]], AXES[made["axis"]]
        for name, value in made["start"].items():
            if isinstance(value, list):
                x, y, z = leaders.AXES[made["axis"]](*value)
                getattr(start, name).CopyFrom(motion_pb2.Direction(x=x, y=y, z=z))
            else:
                setattr(start, name, value)
        if as_vector:
            _set_weights(start.label_vector, keyframes[0][1])
        else:
            for frame, weights in keyframes:
                _set_weights(start.label_keyframes.add(frame=frame).label_vector, weights)
        return start

    def _set_follower_start(self, start):
        kind = self._plan["follower_start"]
        pose = leaders.follower_of(self._plan, self._joints).frame(0)
        if kind == "pose":
            start.follower_start.pose.positions.extend(pose)
        elif kind == "root":
            at = 3 * self._joints.index(self._root)
            root = start.follower_start.root_position
            root.x, root.y, root.z = pose[at:at + 3]

    def _set_leader(self, start, first, count):
        start.leader.frame_count = count
        for frame in self.leader.frames(first, count):
            start.leader.positions.extend(frame)

    def _set_history(self, start, first, follower, follower_begin):
        start.history.first_frame = first
        start.history.follower_frame_count = len(follower)
        for frame in follower:
            start.history.follower_positions.extend(frame)
        if start.reply_rotations:
            start.history.rig_leader_positions.extend(self.leader.frame(0))
            start.history.rig_follower_positions.extend(follower_begin)

    @staticmethod
    def _change(frame, ease, weights):
        change = live_pb2.LabelChange(ease_frames=ease)
        if frame is not None:
            change.frame = frame
        _set_weights(change.label_vector, weights)
        return live_pb2.SynthesizeLiveRequest(label_change=change)

    def _mistake(self, mistake, sent):
        if mistake["kind"] == "start":
            return self.start()
        if mistake["kind"] == "change":
            return self._change(mistake.get("frame"), mistake.get("ease", 0), mistake["weights"])
        if mistake["kind"] == "nothing":
            return live_pb2.SynthesizeLiveRequest()
        first = min(sent + mistake["ahead"], mistakes.LARGEST)
        message = live_clients.frames_message(first, self.leader.frames(sent, mistake["count"]))
        positions = message.frames.positions
        if mistake["drop"]:
            del positions[max(0, len(positions) - mistake["drop"]):]
        if mistake["value"] is not None:
            positions[len(positions) // 2] = mistake["value"]
        return message

    def _with_mistake(self, message):
        for path, value in mistakes.START_CHANGES.get(self._plan["start_mistake"], {}).items():
            _set(message.start, path.split("."), value)
        return message


def _set_weights(vector, weights):
    vector.SetInParent()
    for name, weight in weights.items():
        vector.weights.add(interaction_class=name, weight=weight)


def _set(message, path, value):
    """Sets a field, an element of a list, or appends a class's weight or a keyframe to one."""
    name, rest = path[0], path[1:]
    if rest == ["append"]:
        if isinstance(value, tuple):
            getattr(message, name).add(interaction_class=value[0], weight=value[1])
        else:
            keyframe = getattr(message, name).add(frame=value)
            _set_weights(keyframe.label_vector, {"kick": 1})
    elif rest and rest[0].isdigit():
        getattr(message, name)[int(rest[0])] = value
    elif rest:
        getattr(message, name).SetInParent()
        _set(getattr(message, name), rest, value)
    else:
        setattr(message, name, value)
