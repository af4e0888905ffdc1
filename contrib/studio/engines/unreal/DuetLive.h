// DuetLive.h: a live session with a Duet server, through the WebSocket of the gateway. Add
// "WebSockets" to the module's dependencies. Everything happens on the game thread.
#pragma once

#include "CoreMinimal.h"
#include "IWebSocket.h"
#include "WebSocketsModule.h"

// Writes the wire format of protobuf. The numbers of fields are in proto/duet/v1/live.proto.
struct FDuetMessage {
  TArray<uint8> Bytes;

  FDuetMessage& Number(int32 Field, uint64 Value) {
    Varint(static_cast<uint64>(Field) << 3);
    Varint(Value);
    return *this;
  }
  FDuetMessage& Double(int32 Field, double Value) { return Fixed(Field, 1, &Value, 8); }
  FDuetMessage& Float(int32 Field, float Value) { return Fixed(Field, 5, &Value, 4); }
  FDuetMessage& Text(int32 Field, const char* Value) {
    return Block(Field, Value, FCStringAnsi::Strlen(Value));
  }
  FDuetMessage& Nested(int32 Field, const FDuetMessage& Value) {
    return Block(Field, Value.Bytes.GetData(), Value.Bytes.Num());
  }
  FDuetMessage& Floats(int32 Field, const TArray<float>& Values) {
    return Block(Field, Values.GetData(), Values.Num() * 4);
  }

 private:
  void Varint(uint64 Value) {
    for (; Value >= 128; Value >>= 7) Bytes.Add(static_cast<uint8>((Value & 127) | 128));
    Bytes.Add(static_cast<uint8>(Value));
  }
  FDuetMessage& Fixed(int32 Field, int32 Type, const void* Value, int32 Size) {
    Varint(static_cast<uint64>((Field << 3) | Type));
    Bytes.Append(static_cast<const uint8*>(Value), Size);
    return *this;
  }
  FDuetMessage& Block(int32 Field, const void* Data, int32 Size) {
    Varint(static_cast<uint64>((Field << 3) | 2));
    Varint(static_cast<uint64>(Size));
    Bytes.Append(static_cast<const uint8*>(Data), Size);
    return *this;
  }
};

// Reads the fields of a message, one after the other.
struct FDuetFields {
  int32 Field = 0;
  uint64 Value = 0;  // of a number; the length of a block
  const uint8* Start = nullptr;

  FDuetFields(const uint8* Data, int64 Size) : At(Data), End(Data + Size) {}

  bool Next() {
    if (At >= End) return false;
    const uint64 Key = Varint();
    Field = static_cast<int32>(Key >> 3);
    const int32 Type = static_cast<int32>(Key & 7);
    if (Type == 0 || Type == 2) Value = Varint();
    Start = At;
    At += Type == 1 ? 8 : Type == 5 ? 4 : Type == 2 ? static_cast<int64>(Value) : 0;
    return true;
  }
  FDuetFields Nested() const { return FDuetFields(Start, static_cast<int64>(Value)); }
  FName Name() const {
    return FName(static_cast<int32>(Value), reinterpret_cast<const char*>(Start));
  }
  TArray<float> Floats() const {
    TArray<float> Values;
    Values.SetNumUninitialized(static_cast<int32>(Value / 4));
    FMemory::Memcpy(Values.GetData(), Start, Value);
    return Values;
  }

 private:
  uint64 Varint() {
    uint64 Result = 0;
    for (int32 Shift = 0; At < End; Shift += 7) {
      const uint8 Byte = *At++;
      Result |= static_cast<uint64>(Byte & 127) << Shift;
      if (Byte < 128) break;
    }
    return Result;
  }
  const uint8* At;
  const uint8* End;
};

class FDuetLive {
 public:
  // Final frames of the follower, [frames, joints, 3], and the rotations of its rig,
  // [frames, rig joints, 4].
  struct FFrames {
    int32 First = 0, Count = 0;
    TArray<float> Positions, Rotations;
  };
  struct FRigJoint {
    FName Name;
    int32 Parent = 0;
  };

  TFunction<void(const FFrames&)> OnFrames;
  TArray<FRigJoint> Rig;  // complete before the first frames
  FString Ended;          // why the session is over; empty before

  // Connects and starts the session. `Joints` are those of the model.
  void Start(const FString& Url, const TArray<const char*>& Joints, double FramesPerSecond,
             const char* Reaction) {
    FDuetMessage Leader;
    for (const char* Joint : Joints) Leader.Text(1, Joint);
    Leader.Double(2, FramesPerSecond).Number(3, 2).Number(4, 2);  // millimetres, z up
    const FDuetMessage Message = FDuetMessage().Nested(
        1, FDuetMessage().Nested(2, Leader).Nested(3, Weights(Reaction, 1)).Number(15, 1));
    Socket = FWebSocketsModule::Get().CreateWebSocket(Url, FString());
    Socket->OnConnected().AddLambda([this, Message] {
      Send(Message);
      bStarted = true;
    });
    Socket->OnConnectionError().AddLambda([this](const FString& Error) { Ended = Error; });
    Socket->OnClosed().AddLambda([this](int32, const FString& Reason, bool) {
      if (Ended.IsEmpty()) Ended = Reason;
    });
    Socket->OnRawMessage().AddLambda([this](const void* Data, SIZE_T Size, SIZE_T Remaining) {
      Received.Append(static_cast<const uint8*>(Data), static_cast<int32>(Size));
      if (Remaining > 0) return;
      Take();
      Received.Reset();
    });
    Socket->Connect();
  }
  ~FDuetLive() {
    if (!Socket.IsValid()) return;
    Socket->OnConnected().Clear();
    Socket->OnConnectionError().Clear();
    Socket->OnClosed().Clear();
    Socket->OnRawMessage().Clear();
    Socket->Close();
  }

  // Sends the leader's next frame, in Duet's axes (DuetAxes::Append).
  void Add(const TArray<float>& Positions) {
    if (!bStarted) return;
    Send(FDuetMessage().Nested(
        2,
        FDuetMessage().Number(1, static_cast<uint64>(Sent++)).Number(2, 1).Floats(3, Positions)));
  }

  // Requests another reaction, which applies in full after `EaseFrames` frames.
  void ChangeReaction(const char* Reaction, float Weight, int32 EaseFrames) {
    Send(FDuetMessage().Nested(3, FDuetMessage()
                                      .Nested(2, Weights(Reaction, Weight))
                                      .Number(3, static_cast<uint64>(EaseFrames))));
  }

 private:
  static FDuetMessage Weights(const char* Reaction, float Weight) {
    return FDuetMessage().Nested(1, FDuetMessage().Text(1, Reaction).Float(2, Weight));
  }
  void Send(const FDuetMessage& Message) {
    Socket->Send(Message.Bytes.GetData(), static_cast<SIZE_T>(Message.Bytes.Num()), true);
  }
  void Take() {
    if (Received.Num() > 0 && Received[0] == '{') {  // the last message is the status as JSON
      Ended = TEXT("the server has ended the session");
      return;
    }
    FDuetFields Response(Received.GetData(), Received.Num());
    while (Response.Next()) {
      if (Response.Field != 2) continue;  // frames; not the header, notices and the summary
      FFrames Frames;
      for (FDuetFields Fields = Response.Nested(); Fields.Next();) {
        if (Fields.Field == 1) Frames.First = static_cast<int32>(Fields.Value);
        if (Fields.Field == 2) Frames.Count = static_cast<int32>(Fields.Value);
        if (Fields.Field == 3) Frames.Positions = Fields.Floats();
        if (Fields.Field == 8) Rig.Add(RigJoint(Fields.Nested()));
        if (Fields.Field == 9) Frames.Rotations = Fields.Floats();
      }
      if (OnFrames) OnFrames(Frames);
    }
  }
  static FRigJoint RigJoint(FDuetFields Fields) {
    FRigJoint Joint;
    while (Fields.Next()) {
      if (Fields.Field == 1) Joint.Name = Fields.Name();
      if (Fields.Field == 2) Joint.Parent = static_cast<int32>(Fields.Value);
    }
    return Joint;
  }

  TSharedPtr<IWebSocket> Socket;
  TArray<uint8> Received;
  bool bStarted = false;
  int32 Sent = 0;
};
