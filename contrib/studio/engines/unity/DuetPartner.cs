// A humanoid that answers another one while it moves. Put it on the follower, enforce the T pose in
// both avatars' configuration, and start the scene in that pose, facing +z.
using System.Collections.Generic;
using UnityEngine;

public sealed class DuetPartner : MonoBehaviour
{
    public Animator Leader, Follower;
    public string Url = "ws://localhost:8080/live";
    public string Reaction = "hug";
    public float FramesPerSecond = 30;
    public float LeastDistance = 0.3f;   // metres between the hips of both, on the floor
    public float MostAside = 70;         // degrees by which the leader may be aside of the follower's front
    public float TurnsPerSecond = 120;   // degrees
    public float HeadHeight = 0.1f;      // metres from the neck to the middle of the head

    // The last frame that is shown.
    public int Shown { get; private set; } = -1;

    // Joints of the model `sbu` and bones of a humanoid, parents first; `Turn` is the joint of the
    // rig whose rotation the bone takes.
    struct Part
    {
        public string Joint, Turn;
        public HumanBodyBones Bone;
        public Part(string joint, string turn, HumanBodyBones bone) { Joint = joint; Turn = turn; Bone = bone; }
    }
    static readonly Part[] Parts = {
        new Part("", "torso", HumanBodyBones.Hips),
        new Part("torso", "torso", HumanBodyBones.Spine),
        new Part("", "neck", HumanBodyBones.Chest),
        new Part("neck", "neck_to_head", HumanBodyBones.Neck),
        new Part("head", "neck_to_head", HumanBodyBones.Head),
        new Part("left_shoulder", "left_shoulder", HumanBodyBones.LeftUpperArm),
        new Part("left_elbow", "left_elbow", HumanBodyBones.LeftLowerArm),
        new Part("left_hand", "left_hand", HumanBodyBones.LeftHand),
        new Part("right_shoulder", "right_shoulder", HumanBodyBones.RightUpperArm),
        new Part("right_elbow", "right_elbow", HumanBodyBones.RightLowerArm),
        new Part("right_hand", "right_hand", HumanBodyBones.RightHand),
        new Part("left_hip", "left_hip", HumanBodyBones.LeftUpperLeg),
        new Part("left_knee", "left_knee", HumanBodyBones.LeftLowerLeg),
        new Part("left_foot", "left_foot", HumanBodyBones.LeftFoot),
        new Part("right_hip", "right_hip", HumanBodyBones.RightUpperLeg),
        new Part("right_knee", "right_knee", HumanBodyBones.RightLowerLeg),
        new Part("right_foot", "right_foot", HumanBodyBones.RightFoot),
    };

    readonly DuetLive live = new DuetLive();
    readonly List<string> joints = new List<string>();
    readonly Dictionary<HumanBodyBones, Quaternion> rest = new Dictionary<HumanBodyBones, Quaternion>();
    float restHeight, scale, turn, due;

    async void Start()
    {
        foreach (Part part in Parts)
        {
            if (part.Joint != "") joints.Add(part.Joint);
            Transform bone = Follower.GetBoneTransform(part.Bone);
            if (bone != null) rest[part.Bone] = bone.rotation;  // chest and neck are optional
        }
        restHeight = Follower.GetBoneTransform(HumanBodyBones.Hips).position.y;
        await live.Start(Url, joints, FramesPerSecond, new Dictionary<string, float> { { Reaction, 1 } });
    }

    void OnDestroy() { live.Dispose(); }

    void LateUpdate()
    {
        for (due += Time.deltaTime * FramesPerSecond; due >= 1; --due) live.Add(LeaderPose());
        DuetLive.Frames frames, newest = null;
        while (live.Answers.TryDequeue(out frames)) newest = frames;
        if (newest != null) Show(newest, newest.Count - 1);
        if (!string.IsNullOrEmpty(live.Ended)) Debug.LogWarning("Duet: " + live.Ended);
    }

    List<float> LeaderPose()
    {
        var positions = new List<float>();
        foreach (Part part in Parts)
        {
            if (part.Joint == "") continue;
            Transform bone = Leader.GetBoneTransform(part.Bone);
            if (bone == null) bone = Leader.GetBoneTransform(HumanBodyBones.Head);  // without a neck
            float up = part.Joint == "head" ? HeadHeight : 0;  // the bone begins at the neck
            DuetAxes.Append(bone.position + Vector3.up * up, positions);
        }
        return positions;
    }

    void Show(DuetLive.Frames frames, int frame)
    {
        Dictionary<string, Quaternion> world = Turns(frames, frame);
        Vector3 hips = (Joint(frames, frame, "left_hip") + Joint(frames, frame, "right_hip")) * 0.5f;
        if (scale == 0) scale = restHeight / hips.y;  // the first frame stands
        hips.y *= scale;
        Vector3 leader = Leader.GetBoneTransform(HumanBodyBones.Hips).position;
        hips = DuetPlacement.Apart(hips, leader, LeastDistance);
        float wanted = DuetPlacement.TurnToFace(hips, world["torso"] * Vector3.forward, leader, MostAside);
        turn = Mathf.MoveTowardsAngle(turn, wanted, TurnsPerSecond * Time.deltaTime);
        Quaternion about = Quaternion.AngleAxis(turn, Vector3.up);
        foreach (Part part in Parts)
        {
            Transform bone = Follower.GetBoneTransform(part.Bone);
            if (bone != null) bone.rotation = about * world[part.Turn] * rest[part.Bone];
        }
        Follower.GetBoneTransform(HumanBodyBones.Hips).position = hips;
        Shown = frames.First + frame;
    }

    Vector3 Joint(DuetLive.Frames frames, int frame, string name)
    {
        return DuetAxes.Read(frames.Positions, frame, joints.IndexOf(name), joints.Count);
    }

    // The rotations of the rig's joints in the world. On the wire they are relative to the parent.
    Dictionary<string, Quaternion> Turns(DuetLive.Frames frames, int frame)
    {
        var named = new Dictionary<string, Quaternion>();
        var world = new Quaternion[live.Rig.Count];
        for (int i = 0; i < world.Length; ++i)
        {
            int at = (frame * world.Length + i) * 4;
            float[] r = frames.Rotations;
            Quaternion local = DuetAxes.ToUnity(r[at], r[at + 1], r[at + 2], r[at + 3]);
            int parent = live.Rig[i].Parent;
            world[i] = parent < 0 ? local : world[parent] * local;
            named[live.Rig[i].Name] = world[i];
        }
        return named;
    }
}

public static class DuetPlacement
{
    // Moves the follower away from the leader until they are `least` metres apart on the floor.
    public static Vector3 Apart(Vector3 follower, Vector3 leader, float least)
    {
        Vector3 away = Flat(follower - leader);
        if (away.magnitude >= least || away.magnitude < 1e-4f) return follower;
        return follower + away.normalized * (least - away.magnitude);
    }

    // The degrees about +y by which the follower turns so that the leader is at most `most` degrees
    // aside of where it looks.
    public static float TurnToFace(Vector3 follower, Vector3 forward, Vector3 leader, float most)
    {
        float aside = Vector3.SignedAngle(Flat(forward), Flat(leader - follower), Vector3.up);
        return Mathf.Sign(aside) * Mathf.Max(0, Mathf.Abs(aside) - most);
    }

    static Vector3 Flat(Vector3 v) { return new Vector3(v.x, 0, v.z); }
}
