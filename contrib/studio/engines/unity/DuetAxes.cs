// Between Duet's world (right-handed, y up, metres) and Unity's (left-handed, y up, metres).
using System.Collections.Generic;
using UnityEngine;

public static class DuetAxes
{
    public static Vector3 ToUnity(float x, float y, float z) => new Vector3(-x, y, z);

    public static Quaternion ToUnity(float x, float y, float z, float w) =>
        new Quaternion(x, -y, -z, w);

    // Appends a joint's position in wire order: x, y, z in one flat list, frame by frame, and within
    // a frame joint by joint, in the order of joint_names.
    public static void Append(Vector3 position, ICollection<float> positions)
    {
        positions.Add(-position.x);
        positions.Add(position.y);
        positions.Add(position.z);
    }

    // The position of a joint in one frame of a reply. `joints` is the number of joints per frame.
    public static Vector3 Read(IList<float> positions, int frame, int joint, int joints)
    {
        int at = (frame * joints + joint) * 3;
        return ToUnity(positions[at], positions[at + 1], positions[at + 2]);
    }
}
