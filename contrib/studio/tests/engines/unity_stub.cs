// What the page for Unity uses of UnityEngine, with the same conventions, and a skeleton of bones.
namespace UnityEngine
{
    using System;
    using System.Collections.Generic;

    public struct Vector3
    {
        public float x, y, z;
        public Vector3(float x, float y, float z) { this.x = x; this.y = y; this.z = z; }
        public static Vector3 up { get { return new Vector3(0, 1, 0); } }
        public static Vector3 forward { get { return new Vector3(0, 0, 1); } }
        public float magnitude { get { return (float)Math.Sqrt(Dot(this, this)); } }
        public Vector3 normalized { get { return this * (1 / magnitude); } }
        public static Vector3 operator +(Vector3 a, Vector3 b) { return new Vector3(a.x + b.x, a.y + b.y, a.z + b.z); }
        public static Vector3 operator -(Vector3 a, Vector3 b) { return new Vector3(a.x - b.x, a.y - b.y, a.z - b.z); }
        public static Vector3 operator *(Vector3 a, float f) { return new Vector3(a.x * f, a.y * f, a.z * f); }
        public static float Dot(Vector3 a, Vector3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
        public static Vector3 Cross(Vector3 a, Vector3 b)
        {
            return new Vector3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
        }
        public static float SignedAngle(Vector3 from, Vector3 to, Vector3 axis)
        {
            Vector3 cross = Cross(from, to);
            double angle = Math.Atan2(cross.magnitude, Dot(from, to)) * 180 / Math.PI;
            return (float)(Dot(axis, cross) < 0 ? -angle : angle);
        }
    }

    public struct Quaternion
    {
        public float x, y, z, w;
        public Quaternion(float x, float y, float z, float w) { this.x = x; this.y = y; this.z = z; this.w = w; }
        public static Quaternion identity { get { return new Quaternion(0, 0, 0, 1); } }
        public static Quaternion Inverse(Quaternion q) { return new Quaternion(-q.x, -q.y, -q.z, q.w); }
        public static Quaternion AngleAxis(float degrees, Vector3 axis)
        {
            double half = degrees * Math.PI / 360;
            Vector3 v = axis.normalized * (float)Math.Sin(half);
            return new Quaternion(v.x, v.y, v.z, (float)Math.Cos(half));
        }
        public static Quaternion operator *(Quaternion a, Quaternion b)
        {
            Vector3 u = new Vector3(a.x, a.y, a.z), v = new Vector3(b.x, b.y, b.z);
            Vector3 r = v * a.w + u * b.w + Vector3.Cross(u, v);
            return new Quaternion(r.x, r.y, r.z, a.w * b.w - Vector3.Dot(u, v));
        }
        public static Vector3 operator *(Quaternion q, Vector3 v)
        {
            Vector3 u = new Vector3(q.x, q.y, q.z);
            return v + Vector3.Cross(u, Vector3.Cross(u, v) + v * q.w) * 2;
        }
    }

    public static class Mathf
    {
        public static float Abs(float f) { return Math.Abs(f); }
        public static float Max(float a, float b) { return Math.Max(a, b); }
        public static float Sign(float f) { return f >= 0 ? 1 : -1; }
        public static float MoveTowardsAngle(float now, float to, float most)
        {
            float left = (to - now) % 360;
            left = left > 180 ? left - 360 : left < -180 ? left + 360 : left;
            return Abs(left) <= most ? to : now + Sign(left) * most;
        }
    }

    public static class Time { public static float deltaTime; }
    public static class Debug { public static void LogWarning(object text) { Console.Error.WriteLine(text); } }
    public class MonoBehaviour { }

    public enum HumanBodyBones
    {
        Hips, Spine, Chest, Neck, Head, LeftUpperArm, LeftLowerArm, LeftHand, RightUpperArm, RightLowerArm,
        RightHand, LeftUpperLeg, LeftLowerLeg, LeftFoot, RightUpperLeg, RightLowerLeg, RightFoot
    }

    // A bone: rotations and the positions of roots are set; other positions follow from the parent.
    public class Transform
    {
        readonly Transform parent;
        readonly Quaternion rest;
        readonly Vector3 offset;  // from the parent at rest, in the world
        Vector3 placed;
        public Transform(Transform parent, Vector3 offset, Quaternion rest)
        {
            this.parent = parent;
            this.offset = placed = offset;
            this.rest = rotation = rest;
        }
        public Quaternion rotation { get; set; }
        public Vector3 position
        {
            get
            {
                if (parent == null) return placed;
                return parent.position + parent.rotation * (Quaternion.Inverse(parent.rest) * offset);
            }
            set { placed = value; }
        }
    }

    public class Animator
    {
        public readonly Dictionary<HumanBodyBones, Transform> Bones = new Dictionary<HumanBodyBones, Transform>();
        public Transform GetBoneTransform(HumanBodyBones bone)
        {
            Transform found;
            return Bones.TryGetValue(bone, out found) ? found : null;
        }
    }
}
