// DuetPartner.h: an actor whose mesh answers another one while it moves. Place it at the origin of
// the level, without a rotation, and give `Follower` a mannequin.
#pragma once

#include "Components/PoseableMeshComponent.h"
#include "Components/SkeletalMeshComponent.h"
#include "CoreMinimal.h"
#include "DuetAxes.h"
#include "DuetLive.h"
#include "GameFramework/Actor.h"

// clang-format off: Unreal wants this one last.
#include "DuetPartner.generated.h"
// clang-format on

struct DuetPlacement {
  // Moves the follower away from the leader until they are `Least` centimetres apart on the floor.
  static FVector Apart(const FVector& Follower, const FVector& Leader, double Least) {
    const FVector Away(Follower.X - Leader.X, Follower.Y - Leader.Y, 0);
    const double Distance = Away.Size();
    if (Distance >= Least || Distance < 0.01) return Follower;
    return Follower + Away * ((Least - Distance) / Distance);
  }

  // The degrees of yaw by which the follower turns so that the leader is at most `Most` degrees
  // aside of where it looks.
  static double TurnToFace(const FVector& Follower, const FVector& Forward, const FVector& Leader,
                           double Most) {
    const FVector To = Leader - Follower;
    const double Aside = FMath::RadiansToDegrees(
        FMath::Atan2(Forward.X * To.Y - Forward.Y * To.X, Forward.X * To.X + Forward.Y * To.Y));
    return FMath::Sign(Aside) * FMath::Max(0.0, FMath::Abs(Aside) - Most);
  }
};

UCLASS()
class ADuetPartner : public AActor {
  GENERATED_BODY()

 public:
  UPROPERTY(EditAnywhere) USkeletalMeshComponent* Leader = nullptr;
  UPROPERTY(EditAnywhere) UPoseableMeshComponent* Follower = nullptr;
  UPROPERTY(EditAnywhere) FString Url = TEXT("ws://localhost:8080/live");
  UPROPERTY(EditAnywhere) double FramesPerSecond = 30;
  UPROPERTY(EditAnywhere) double LeastDistance = 30;    // centimetres between the hips of both
  UPROPERTY(EditAnywhere) double MostAside = 70;        // degrees from the follower's front
  UPROPERTY(EditAnywhere) double TurnsPerSecond = 120;  // degrees
  UPROPERTY(EditAnywhere) double HeadHeight = 10;  // centimetres from neck to middle of the head

  ADuetPartner() {
    PrimaryActorTick.bCanEverTick = true;
    Follower = CreateDefaultSubobject<UPoseableMeshComponent>(TEXT("Follower"));
  }

  void BeginPlay() override {
    Super::BeginPlay();
    TArray<const char*> Joints;
    for (const FPart& Part : Parts()) {
      if (Part.Joint != nullptr) Joints.Add(Part.Joint);
      Rest.Add(RestOf(Part));
    }
    RestHeight = Place("pelvis").Z;
    Live.OnFrames = [this](const FDuetLive::FFrames& Frames) { Show(Frames, Frames.Count - 1); };
    Live.Start(Url, Joints, FramesPerSecond, "hug");
  }

  void Tick(float Seconds) override {
    Super::Tick(Seconds);
    Elapsed = Seconds;
    for (Due += Seconds * FramesPerSecond; Due >= 1; --Due) Live.Add(LeaderPose());
  }

 private:
  // A joint of the model `sbu`, the joint of the rig whose rotation the bone takes, the bone, and
  // the bone at its other end with the direction to it in the rest pose of the rig.
  struct FPart {
    const char *Joint, *Turn, *Bone, *End;
    FVector Direction;
  };

  // Parents come before children.
  static const TArray<FPart>& Parts() {
    static const FVector Left(1, 0, 0), Right(-1, 0, 0), Down(0, 0, -1), None(0, 0, 0);
    static const TArray<FPart> All = {
        {nullptr, "torso", "pelvis", nullptr, None},
        {"torso", "torso", "spine_02", nullptr, None},
        {nullptr, "neck", "spine_03", nullptr, None},
        {"neck", "neck_to_head", "neck_01", nullptr, None},
        {"head", "neck_to_head", "head", nullptr, None},
        {"left_shoulder", "left_shoulder", "upperarm_l", "lowerarm_l", Left},
        {"left_elbow", "left_elbow", "lowerarm_l", "hand_l", Left},
        {"left_hand", "left_hand", "hand_l", nullptr, Left},
        {"right_shoulder", "right_shoulder", "upperarm_r", "lowerarm_r", Right},
        {"right_elbow", "right_elbow", "lowerarm_r", "hand_r", Right},
        {"right_hand", "right_hand", "hand_r", nullptr, Right},
        {"left_hip", "left_hip", "thigh_l", "calf_l", Down},
        {"left_knee", "left_knee", "calf_l", "foot_l", Down},
        {"left_foot", "left_foot", "foot_l", nullptr, None},
        {"right_hip", "right_hip", "thigh_r", "calf_r", Down},
        {"right_knee", "right_knee", "calf_r", "foot_r", Down},
        {"right_foot", "right_foot", "foot_r", nullptr, None},
    };
    return All;
  }

  // The rotation of a bone in the rest pose of the rig, arms stretched out sideways. Mannequins
  // rest with lowered arms: the bone turns from where it points to where the rig's points.
  FQuat RestOf(const FPart& Part) {
    const FQuat Own = Turned(Part.Bone);
    if (Part.End == nullptr) {
      // A hand turns with its forearm.
      return Part.Direction.IsZero() ? Own : Straightened * Own;
    }
    Straightened = FQuat::FindBetweenVectors(Place(Part.End) - Place(Part.Bone), Part.Direction);
    return Straightened * Own;
  }

  FVector Place(const char* Bone) const {
    return Follower->GetBoneTransformByName(Bone, EBoneSpaces::ComponentSpace).GetLocation();
  }
  FQuat Turned(const char* Bone) const {
    return Follower->GetBoneTransformByName(Bone, EBoneSpaces::ComponentSpace).GetRotation();
  }

  TArray<float> LeaderPose() const {
    TArray<float> Positions;
    for (const FPart& Part : Parts()) {
      if (Part.Joint == nullptr) continue;
      FVector At = Leader->GetSocketLocation(Part.Bone);
      if (FCStringAnsi::Strcmp(Part.Joint, "head") == 0) At.Z += HeadHeight;
      DuetAxes::Append(At, Positions);
    }
    return Positions;
  }

  void Show(const FDuetLive::FFrames& Frames, int32 Frame) {
    const TMap<FName, FQuat> World = Turns(Frames, Frame);
    FVector Hips = (Joint(Frames, Frame, "left_hip") + Joint(Frames, Frame, "right_hip")) * 0.5;
    if (Scale == 0) Scale = RestHeight / Hips.Z;  // the first frame stands
    Hips.Z *= Scale;
    const FVector To = Leader->GetSocketLocation("pelvis");
    Hips = DuetPlacement::Apart(Hips, To, LeastDistance);
    const FVector Forward = World["torso"].RotateVector(FVector(0, 1, 0));
    const double Wanted = DuetPlacement::TurnToFace(Hips, Forward, To, MostAside);
    Turn = FMath::FInterpConstantTo(Turn, Wanted, Elapsed, TurnsPerSecond);
    const FQuat About(FVector(0, 0, 1), FMath::DegreesToRadians(Turn));
    for (int32 i = 0; i < Parts().Num(); ++i) {
      const FPart& Part = Parts()[i];
      FTransform Bone = Follower->GetBoneTransformByName(Part.Bone, EBoneSpaces::ComponentSpace);
      Bone.SetRotation(About * World[Part.Turn] * Rest[i]);
      if (i == 0) Bone.SetLocation(Hips);
      Follower->SetBoneTransformByName(Part.Bone, Bone, EBoneSpaces::ComponentSpace);
    }
  }

  static FVector Joint(const FDuetLive::FFrames& Frames, int32 Frame, const char* Name) {
    int32 Index = 0, Count = 0;
    for (const FPart& Part : Parts()) {
      if (Part.Joint == nullptr) continue;
      if (FCStringAnsi::Strcmp(Part.Joint, Name) == 0) Index = Count;
      ++Count;
    }
    const float* At = Frames.Positions.GetData() + (Frame * Count + Index) * 3;
    return DuetAxes::ToUnreal(At[0], At[1], At[2]);
  }

  // The rotations of the rig's joints in the world. On the wire they are relative to the parent.
  TMap<FName, FQuat> Turns(const FDuetLive::FFrames& Frames, int32 Frame) const {
    TMap<FName, FQuat> Named;
    TArray<FQuat> World;
    const int32 Count = Live.Rig.Num();
    for (int32 i = 0; i < Count; ++i) {
      const float* Q = Frames.Rotations.GetData() + (Frame * Count + i) * 4;
      const FQuat Local = DuetAxes::ToUnreal(Q[0], Q[1], Q[2], Q[3]);
      const int32 Parent = Live.Rig[i].Parent;
      World.Add(Parent < 0 ? Local : World[Parent] * Local);
      Named.Add(Live.Rig[i].Name, World[i]);
    }
    return Named;
  }

  FDuetLive Live;
  TArray<FQuat> Rest;  // of each part
  FQuat Straightened = FQuat(0, 0, 0, 1);
  double RestHeight = 0, Scale = 0, Turn = 0, Due = 0, Elapsed = 0;
};
