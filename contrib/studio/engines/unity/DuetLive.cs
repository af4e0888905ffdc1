// A live session with a Duet server, through the WebSocket of the gateway (ws://HOST:8080/live).
using System;
using System.Collections.Concurrent;
using System.Collections.Generic;
using System.IO;
using System.Net.WebSockets;
using System.Text;
using System.Threading;
using System.Threading.Tasks;

public sealed class DuetLive : IDisposable
{
    // Final frames of the follower, [frames, joints, 3], and the rotations of its rig,
    // [frames, rig joints, 4].
    public sealed class Frames
    {
        public int First, Count;
        public float[] Positions = new float[0], Rotations = new float[0];
    }

    public struct RigJoint { public string Name; public int Parent; }

    // Filled by a background thread; empty it in Update. The rig is complete before the first frames.
    public readonly ConcurrentQueue<Frames> Answers = new ConcurrentQueue<Frames>();
    public readonly List<RigJoint> Rig = new List<RigJoint>();
    // Why the session has ended, or null. "" after Finish, if all went well.
    public string Ended { get; private set; }
    public Task Reading { get; private set; }  // until the session has ended

    readonly ClientWebSocket socket = new ClientWebSocket();
    readonly CancellationTokenSource stop = new CancellationTokenSource();
    Task sending;
    int sent;

    // Connects and starts the session. `joints` are those of the model (GetModel, or `duet models`),
    // `weights` the interaction classes with their weights.
    public async Task Start(string url, IList<string> joints, float framesPerSecond,
                            IDictionary<string, float> weights)
    {
        try { await socket.ConnectAsync(new Uri(url), stop.Token); }
        catch (Exception error) { Ended = error.Message; return; }
        var leader = new Message();
        foreach (string joint in joints) leader.Text(1, joint);
        leader.Double(2, framesPerSecond).Number(3, 1).Number(4, 1);  // metres, y up
        sending = Send(new Message().Nested(1, new Message()
            .Nested(2, leader).Nested(3, Vector(weights)).Number(15, 1)));  // with rotations
        Reading = Read();
    }

    // Sends the leader's next frame: x, y, z of each joint, in Duet's axes (DuetAxes.Append). Before
    // the session has started, it does nothing.
    public void Add(IList<float> positions)
    {
        if (sending == null) return;
        Enqueue(new Message().Nested(2, new Message()
            .Number(1, (ulong)sent++).Number(2, 1).Floats(3, positions)));
    }

    // Changes the weights within `easeFrames` frames.
    public void ChangeLabels(IDictionary<string, float> weights, int easeFrames)
    {
        Enqueue(new Message().Nested(3, new Message()
            .Nested(2, Vector(weights)).Number(3, (ulong)easeFrames)));
    }

    // Ends the leader: the frames that are due still arrive.
    public void Finish() { Enqueue(new Message()); }

    public void Dispose()
    {
        stop.Cancel();
        socket.Dispose();
    }

    // A socket sends one message at a time.
    void Enqueue(Message message)
    {
        if (sending != null) sending = SendAfter(sending, message);
    }

    async Task SendAfter(Task before, Message message)
    {
        await before;
        await Send(message);
    }

    async Task Send(Message message)
    {
        try
        {
            await socket.SendAsync(new ArraySegment<byte>(message.Bytes()),
                                   WebSocketMessageType.Binary, true, stop.Token);
        }
        catch (Exception) { }  // Read finds out why
    }

    async Task Read()
    {
        var part = new byte[1 << 16];
        var whole = new MemoryStream();
        try
        {
            while (Ended == null)
            {
                WebSocketReceiveResult got = await socket.ReceiveAsync(new ArraySegment<byte>(part),
                                                                       stop.Token);
                if (got.MessageType == WebSocketMessageType.Close)
                {
                    Ended = got.CloseStatusDescription ?? "the gateway has closed the session";
                    return;
                }
                whole.Write(part, 0, got.Count);
                if (!got.EndOfMessage) continue;
                byte[] bytes = whole.ToArray();
                whole.SetLength(0);
                if (got.MessageType == WebSocketMessageType.Binary) Take(new Fields(bytes));
                else Ended = StatusIn(Encoding.UTF8.GetString(bytes));
            }
        }
        catch (Exception error) { Ended = error.Message; }
    }

    // The last message is the status as JSON: {"code": 0, "message": "", ...}.
    static string StatusIn(string json) { return json.Contains("\"code\": 0,") ? "" : json; }

    void Take(Fields response)
    {
        while (response.Next())
        {
            if (response.Number != 2) continue;  // frames; the header, notices and the summary are left out
            var frames = new Frames();
            for (Fields field = response.Nested(); field.Next();)
            {
                if (field.Number == 1) frames.First = (int)field.Value;
                else if (field.Number == 2) frames.Count = (int)field.Value;
                else if (field.Number == 3) frames.Positions = field.Floats();
                else if (field.Number == 8) Rig.Add(RigJointIn(field.Nested()));
                else if (field.Number == 9) frames.Rotations = field.Floats();
            }
            Answers.Enqueue(frames);
        }
    }

    static RigJoint RigJointIn(Fields fields)
    {
        var joint = new RigJoint();
        while (fields.Next())
        {
            if (fields.Number == 1) joint.Name = fields.Text();
            else if (fields.Number == 2) joint.Parent = (int)(long)fields.Value;
        }
        return joint;
    }

    static Message Vector(IDictionary<string, float> weights)
    {
        var vector = new Message();
        foreach (KeyValuePair<string, float> weight in weights)
            vector.Nested(1, new Message().Text(1, weight.Key).Float(2, weight.Value));
        return vector;
    }

    // Writes the wire format of protobuf. The numbers of fields are in proto/duet/v1/live.proto.
    sealed class Message
    {
        readonly MemoryStream stream = new MemoryStream();

        public byte[] Bytes() { return stream.ToArray(); }

        public Message Number(int field, ulong value)
        {
            Varint((ulong)field << 3);
            Varint(value);
            return this;
        }

        public Message Double(int field, double value) { return Fixed(field, 1, BitConverter.GetBytes(value)); }
        public Message Float(int field, float value) { return Fixed(field, 5, BitConverter.GetBytes(value)); }
        public Message Text(int field, string value) { return Block(field, Encoding.UTF8.GetBytes(value)); }
        public Message Nested(int field, Message value) { return Block(field, value.Bytes()); }

        public Message Floats(int field, IList<float> values)
        {
            var bytes = new byte[4 * values.Count];
            for (int i = 0; i < values.Count; ++i) BitConverter.GetBytes(values[i]).CopyTo(bytes, 4 * i);
            return Block(field, bytes);
        }

        Message Fixed(int field, int type, byte[] bytes)
        {
            Varint((ulong)(field << 3 | type));
            stream.Write(bytes, 0, bytes.Length);
            return this;
        }

        Message Block(int field, byte[] bytes)
        {
            Varint((ulong)(field << 3 | 2));
            Varint((ulong)bytes.Length);
            stream.Write(bytes, 0, bytes.Length);
            return this;
        }

        void Varint(ulong value)
        {
            for (; value >= 128; value >>= 7) stream.WriteByte((byte)(value & 127 | 128));
            stream.WriteByte((byte)value);
        }
    }

    // Reads the fields of a message, one after the other.
    sealed class Fields
    {
        readonly byte[] bytes;
        readonly int end;
        int at, start;

        public int Number { get; private set; }
        public ulong Value { get; private set; }  // of a number; the length of a block

        public Fields(byte[] bytes) : this(bytes, 0, bytes.Length) { }
        Fields(byte[] bytes, int at, int end) { this.bytes = bytes; this.at = at; this.end = end; }

        public bool Next()
        {
            if (at >= end) return false;
            ulong key = Varint();
            Number = (int)(key >> 3);
            int type = (int)(key & 7);
            if (type == 0 || type == 2) Value = Varint();
            start = at;
            at += type == 1 ? 8 : type == 5 ? 4 : type == 2 ? (int)Value : 0;
            return true;
        }

        public Fields Nested() { return new Fields(bytes, start, at); }
        public string Text() { return Encoding.UTF8.GetString(bytes, start, at - start); }

        public float[] Floats()
        {
            var values = new float[(at - start) / 4];
            Buffer.BlockCopy(bytes, start, values, 0, at - start);
            return values;
        }

        ulong Varint()
        {
            ulong value = 0;
            for (int shift = 0; ; shift += 7)
            {
                byte next = bytes[at++];
                value |= (ulong)(next & 127) << shift;
                if (next < 128) return value;
            }
        }
    }
}
