// Drives the live partner of the page for Unity against a gateway: `URL FRAMES`, the leader's frames
// as lines of numbers in the order of DuetPartner's joints. Writes what it shows, line by line.
using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Linq;
using System.Reflection;
using System.Threading;
using UnityEngine;

public static class Program
{
    const BindingFlags Hidden = BindingFlags.Instance | BindingFlags.NonPublic;
    static readonly CultureInfo Invariant = CultureInfo.InvariantCulture;

    // A person in the T pose who faces +z, with bones of different axes, and without a neck.
    static Animator Person()
    {
        var person = new Animator();
        Action<HumanBodyBones, HumanBodyBones, float, float, float> add = (bone, parent, x, y, z) =>
            person.Bones[bone] = new Transform(person.GetBoneTransform(parent), new Vector3(x, y, z),
                                               Quaternion.AngleAxis(37 * (int)bone, new Vector3(1, 2, 3)));
        person.Bones[HumanBodyBones.Hips] = new Transform(null, new Vector3(0, 0.95f, 0), Quaternion.identity);
        add(HumanBodyBones.Spine, HumanBodyBones.Hips, 0, 0.12f, 0);
        add(HumanBodyBones.Chest, HumanBodyBones.Spine, 0, 0.2f, 0);
        add(HumanBodyBones.Head, HumanBodyBones.Chest, 0, 0.3f, 0);
        foreach (int side in new[] { -1, 1 })
        {
            string name = side < 0 ? "Left" : "Right";
            Func<string, HumanBodyBones> bone = part =>
                (HumanBodyBones)Enum.Parse(typeof(HumanBodyBones), name + part);
            add(bone("UpperArm"), HumanBodyBones.Chest, 0.18f * side, 0.15f, 0);
            add(bone("LowerArm"), bone("UpperArm"), 0.28f * side, 0, 0);
            add(bone("Hand"), bone("LowerArm"), 0.25f * side, 0, 0);
            add(bone("UpperLeg"), HumanBodyBones.Hips, 0.09f * side, -0.05f, 0);
            add(bone("LowerLeg"), bone("UpperLeg"), 0, -0.42f, 0);
            add(bone("Foot"), bone("LowerLeg"), 0, -0.4f, 0);
        }
        return person;
    }

    static void Call(DuetPartner partner, string method)
    {
        typeof(DuetPartner).GetMethod(method, Hidden).Invoke(partner, null);
    }

    static void Write(string name, Vector3 v)
    {
        Console.WriteLine(string.Format(Invariant, "{0} {1:R} {2:R} {3:R}", name, v.x, v.y, v.z));
    }

    static int Placement()
    {
        Write("apart", DuetPlacement.Apart(new Vector3(0, 1, 0.1f), new Vector3(0, 2, 0), 0.3f));
        Write("apart", DuetPlacement.Apart(new Vector3(3, 1, 0), new Vector3(0, 2, 0), 0.3f));
        foreach (float most in new[] { 30f, 120f })
            Write("turn", new Vector3(DuetPlacement.TurnToFace(
                new Vector3(0, 1, 0), Vector3.forward, new Vector3(2, 1, 0), most), 0, 0));
        Write("turn", new Vector3(DuetPlacement.TurnToFace(
            new Vector3(0, 1, 0), Vector3.forward, new Vector3(-2, 1, 0), 30), 0, 0));
        return 0;
    }

    public static int Main(string[] words)
    {
        if (words.Length == 0) return Placement();
        var partner = new DuetPartner { Url = words[0], Follower = Person(), Leader = new Animator(),
                                        LeastDistance = 0, MostAside = 180, HeadHeight = 0 };
        string[] lines = File.ReadAllLines(words[1]);
        var bones = new[] { "Spine", "Neck", "Head", "LeftUpperArm", "LeftLowerArm", "LeftHand", "RightUpperArm",
                            "RightLowerArm", "RightHand", "LeftUpperLeg", "LeftLowerLeg", "LeftFoot",
                            "RightUpperLeg", "RightLowerLeg", "RightFoot" }
            .Select(name => (HumanBodyBones)Enum.Parse(typeof(HumanBodyBones), name)).ToArray();
        foreach (HumanBodyBones bone in bones.Concat(new[] { HumanBodyBones.Hips }))
            partner.Leader.Bones[bone] = new Transform(null, new Vector3(), Quaternion.identity);
        Call(partner, "Start");
        for (int frame = 0; frame < lines.Length; ++frame)
        {
            float[] at = lines[frame].Split(' ').Select(word => float.Parse(word, Invariant)).ToArray();
            for (int i = 0; i < bones.Length; ++i)
                partner.Leader.Bones[bones[i]].position = new Vector3(-at[3 * i], at[3 * i + 1], at[3 * i + 2]);
            // The session may not have started yet: the first frame is sent until it is answered.
            while (partner.Shown < frame)
            {
                bool isSent = Sent(partner) > frame;
                Time.deltaTime = isSent ? 0 : 1 / partner.FramesPerSecond * 1.001f;
                Call(partner, "LateUpdate");
                Thread.Yield();
                if (Live(partner).Ended != null) throw new Exception("ended: " + Live(partner).Ended);
            }
            Console.WriteLine("frame " + frame);
            foreach (KeyValuePair<HumanBodyBones, Transform> bone in partner.Follower.Bones)
                Write(bone.Key.ToString(), bone.Value.position);
        }
        Call(partner, "OnDestroy");
        return 0;
    }

    static int Sent(DuetPartner partner)
    {
        return (int)typeof(DuetLive).GetField("sent", Hidden).GetValue(Live(partner));
    }

    static DuetLive Live(DuetPartner partner)
    {
        return (DuetLive)typeof(DuetPartner).GetField("live", Hidden).GetValue(partner);
    }
}
