"""Poses the partner's armature by the places of its joints."""

from mathutils import Matrix, Quaternion, Vector

_SIDES = ("left_", "right_")


def basis(left, right, low, high):
    """A rotation whose x points from right to left, and z upwards."""
    x = (left - right).normalized()
    z = high - low
    z = (z - x * z.dot(x)).normalized()
    return Matrix((x, z.cross(x), z)).transposed()


def _swing(rest, now):
    """The shortest rotation from one direction to another."""
    if rest.length == 0 or now.length == 0:
        return Quaternion()
    return rest.rotation_difference(now)


class Puppet:
    """An armature of a partner: bones named as joints, with their heads at the joints, and between
    some of them bones "JOINT_to_JOINT".

    A bone of a limb turns by the shortest rotation. A joint that has children on both sides, such as
    the middle of the hips, turns with the line between them."""

    def __init__(self, armature, joints):
        self.armature = armature
        self._joints = {name: index for index, name in enumerate(joints)}
        self._bones = list(armature.data.bones)  # parents first
        self._rest = {bone.name: bone.head_local.copy() for bone in self._bones}
        self._ends = {bone.name: self._end(bone) for bone in self._bones}
        for bone in armature.pose.bones:
            bone.rotation_mode = "QUATERNION"

    def _end(self, bone):
        """The joints by which a bone turns: (start, end), (left, right, low, high) or nothing."""
        start = self._start(bone)
        after = [joint for child in bone.children for joint in self._below(child)]
        pairs = [(f"left_{joint[5:]}", f"right_{joint[5:]}") for joint in after
                 if joint.startswith("left_") and f"right_{joint[5:]}" in after]
        if pairs and len(after) > 1:
            above = [joint for joint in after if not joint.startswith(_SIDES)]
            before = self._start(bone.parent) if bone.parent else None
            if before and before != start:
                return (*pairs[0], before, start)
            if above:
                return (*pairs[0], start, above[0])
        return (start, after[0]) if after else ()

    def _start(self, bone):
        """The joint at a bone's head."""
        return bone.name if bone.name in self._joints else bone.name.partition("_to_")[0]

    def _below(self, bone):
        """The first joints at or below a bone."""
        if bone.name in self._joints:
            return [bone.name]
        return [joint for child in bone.children for joint in self._below(child)]

    def pose(self, points):
        """Moves every joint to its place: [joints] vectors in the world."""
        inverse = self.armature.matrix_world.inverted()
        now = {name: inverse @ points[index] for name, index in self._joints.items()}
        turns, poses = {}, {}
        for bone in self._bones:
            parent = bone.parent
            turn = turns[bone.name] = self._turn(
                bone.name, turns[parent.name] if parent else Quaternion(), now)
            wanted = (Matrix.Translation(now[self._start(bone)]) @ turn.to_matrix().to_4x4()
                      @ bone.matrix_local.to_3x3().to_4x4())
            poses[bone.name] = wanted
            above = bone.matrix_local
            if parent:
                above = poses[parent.name] @ parent.matrix_local.inverted() @ bone.matrix_local
            place, rotation, _ = (above.inverted() @ wanted).decompose()
            posed = self.armature.pose.bones[bone.name]
            posed.location, posed.rotation_quaternion = place, rotation

    def _turn(self, bone, above, now):
        """The rotation of a bone from its rest pose, in the armature's space."""
        end = self._ends[bone]
        if len(end) == 4:
            rest, moved = (basis(*(places[joint] for joint in end)) for places in (self._rest, now))
            return (moved @ rest.inverted()).to_quaternion()
        if len(end) == 2:
            rest = Vector(self._rest[end[1]] - self._rest[end[0]])
            return _swing(above @ rest, now[end[1]] - now[end[0]]) @ above
        return above
