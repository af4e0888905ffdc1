// What the page for Unreal uses of the engine, with the same conventions. Strings are ASCII.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <initializer_list>
#include <map>
#include <memory>
#include <string>
#include <vector>

using uint8 = std::uint8_t;
using int32 = std::int32_t;
using int64 = std::int64_t;
using uint64 = std::uint64_t;
using SIZE_T = std::size_t;
#define TEXT(text) text
#define UCLASS(...)
#define UPROPERTY(...)
#define GENERATED_BODY()

template <typename T>
struct TArray : std::vector<T> {
  using std::vector<T>::vector;
  int32 Num() const { return static_cast<int32>(this->size()); }
  void Add(const T& value) { this->push_back(value); }
  void Append(const T* values, int32 count) { this->insert(this->end(), values, values + count); }
  void Reset() { this->clear(); }
  void SetNumUninitialized(int32 count) { this->resize(static_cast<SIZE_T>(count)); }
  T* GetData() { return this->data(); }
  const T* GetData() const { return this->data(); }
  T& operator[](int32 i) { return this->at(static_cast<SIZE_T>(i)); }
  const T& operator[](int32 i) const { return this->at(static_cast<SIZE_T>(i)); }
};

struct FString : std::string {
  using std::string::string;
  bool IsEmpty() const { return empty(); }
};
struct FName : std::string {
  using std::string::string;
  FName(int32 count, const char* text) : std::string(text, static_cast<SIZE_T>(count)) {}
};
template <typename K, typename V>
struct TMap : std::map<K, V> {
  void Add(const K& key, const V& value) { (*this)[key] = value; }
  const V& operator[](const K& key) const { return this->at(key); }
  V& operator[](const K& key) { return std::map<K, V>::operator[](key); }
};
template <typename F>
using TFunction = std::function<F>;
template <typename T>
struct TSharedPtr : std::shared_ptr<T> {
  using std::shared_ptr<T>::shared_ptr;
  bool IsValid() const { return this->get() != nullptr; }
};

struct FCStringAnsi {
  static int32 Strlen(const char* text) { return static_cast<int32>(std::strlen(text)); }
  static int32 Strcmp(const char* a, const char* b) { return std::strcmp(a, b); }
};
struct FMemory {
  static void Memcpy(void* to, const void* from, SIZE_T size) { std::memcpy(to, from, size); }
};
struct FMath {
  static constexpr double kDegrees = 57.29577951308232;
  static double RadiansToDegrees(double a) { return a * kDegrees; }
  static double DegreesToRadians(double a) { return a / kDegrees; }
  static double Atan2(double y, double x) { return std::atan2(y, x); }
  static double Abs(double a) { return std::abs(a); }
  static double Max(double a, double b) { return a > b ? a : b; }
  static double Sign(double a) { return a > 0 ? 1 : a < 0 ? -1 : 0; }
  static double FInterpConstantTo(double now, double to, double seconds, double speed) {
    const double most = seconds * speed, left = to - now;
    return std::abs(left) <= most ? to : now + (left > 0 ? most : -most);
  }
};

struct FVector {
  double X, Y, Z;
  FVector() : X(0), Y(0), Z(0) {}
  FVector(double x, double y, double z) : X(x), Y(y), Z(z) {}
  FVector operator+(const FVector& b) const { return {X + b.X, Y + b.Y, Z + b.Z}; }
  FVector operator-(const FVector& b) const { return {X - b.X, Y - b.Y, Z - b.Z}; }
  FVector operator*(double f) const { return {X * f, Y * f, Z * f}; }
  double Size() const { return std::sqrt(X * X + Y * Y + Z * Z); }
  bool IsZero() const { return X == 0 && Y == 0 && Z == 0; }
  static FVector Cross(const FVector& a, const FVector& b) {
    return {a.Y * b.Z - a.Z * b.Y, a.Z * b.X - a.X * b.Z, a.X * b.Y - a.Y * b.X};
  }
  static double Dot(const FVector& a, const FVector& b) {
    return a.X * b.X + a.Y * b.Y + a.Z * b.Z;
  }
};
struct FQuat {
  double X, Y, Z, W;
  FQuat() : FQuat(0, 0, 0, 1) {}
  FQuat(double x, double y, double z, double w) : X(x), Y(y), Z(z), W(w) {}
  FQuat(const FVector& axis, double radians)
      : X(axis.X * std::sin(radians / 2)),
        Y(axis.Y * std::sin(radians / 2)),
        Z(axis.Z * std::sin(radians / 2)),
        W(std::cos(radians / 2)) {}
  FQuat Inverse() const { return {-X, -Y, -Z, W}; }
  FQuat operator*(const FQuat& b) const {
    const FVector u(X, Y, Z), v(b.X, b.Y, b.Z), r = v * W + u * b.W + FVector::Cross(u, v);
    return {r.X, r.Y, r.Z, W * b.W - FVector::Dot(u, v)};
  }
  FVector RotateVector(const FVector& v) const {
    const FVector u(X, Y, Z);
    return v + FVector::Cross(u, FVector::Cross(u, v) + v * W) * 2;
  }
  // Not for opposite vectors.
  static FQuat FindBetweenVectors(const FVector& a, const FVector& b) {
    const FVector axis = FVector::Cross(a, b);
    const double w = a.Size() * b.Size() + FVector::Dot(a, b);
    const double norm = std::sqrt(FVector::Dot(axis, axis) + w * w);
    return {axis.X / norm, axis.Y / norm, axis.Z / norm, w / norm};
  }
};
class FTransform {
 public:
  FTransform(const FQuat& rotation, const FVector& location)
      : rotation_(rotation), location_(location) {}
  FQuat GetRotation() const { return rotation_; }
  FVector GetLocation() const { return location_; }
  void SetRotation(const FQuat& rotation) { rotation_ = rotation; }
  void SetLocation(const FVector& location) { location_ = location; }

 private:
  FQuat rotation_;
  FVector location_;
};

struct EBoneSpaces {
  enum Type { WorldSpace, ComponentSpace };
};
// A mesh at the origin. The location of a bone follows from its parent; only a root's is set.
class UPoseableMeshComponent {
 public:
  struct Bone {
    FName parent;
    FVector offset;  // from the parent at rest, in the component
    FQuat rest, now;
  };
  std::map<FName, Bone> bones;

  FTransform GetBoneTransformByName(FName name, EBoneSpaces::Type) {
    const Bone& bone = bones.at(name);
    if (bone.parent.empty()) return {bone.now, bone.offset};
    const FTransform parent = GetBoneTransformByName(bone.parent, EBoneSpaces::ComponentSpace);
    const FVector local = bones.at(bone.parent).rest.Inverse().RotateVector(bone.offset);
    return {bone.now, parent.GetLocation() + parent.GetRotation().RotateVector(local)};
  }
  void SetBoneTransformByName(FName name, const FTransform& transform, EBoneSpaces::Type) {
    Bone& bone = bones.at(name);
    bone.now = transform.GetRotation();
    if (bone.parent.empty()) bone.offset = transform.GetLocation();
  }
};
class USkeletalMeshComponent {
 public:
  std::map<FName, FVector> places;
  FVector GetSocketLocation(FName name) const { return places.at(name); }
};

class AActor {
 public:
  using Super = AActor;
  virtual ~AActor() = default;
  virtual void BeginPlay() {}
  virtual void Tick(float) {}

 protected:
  struct {
    bool bCanEverTick = false;
  } PrimaryActorTick;
  template <typename T>
  T* CreateDefaultSubobject(const char*) {
    static T object;
    return &object;
  }
};

template <typename... A>
class TEvent {
 public:
  void AddLambda(std::function<void(A...)> function) { functions_.push_back(std::move(function)); }
  void Clear() { functions_.clear(); }
  void Broadcast(A... values) {
    for (const auto& function : functions_) function(values...);
  }

 private:
  std::vector<std::function<void(A...)>> functions_;
};
class IWebSocket {
 public:
  void Connect() {}
  void Close() {}
  void Send(const void* data, SIZE_T size, bool) {
    sent.emplace_back(static_cast<const char*>(data), size);
  }
  TEvent<>& OnConnected() { return connected_; }
  TEvent<const FString&>& OnConnectionError() { return failed_; }
  TEvent<int32, const FString&, bool>& OnClosed() { return closed_; }
  TEvent<const void*, SIZE_T, SIZE_T>& OnRawMessage() { return received_; }
  std::vector<std::string> sent;

 private:
  TEvent<> connected_;
  TEvent<const FString&> failed_;
  TEvent<int32, const FString&, bool> closed_;
  TEvent<const void*, SIZE_T, SIZE_T> received_;
};
class FWebSocketsModule {
 public:
  static FWebSocketsModule& Get() {
    static FWebSocketsModule module;
    return module;
  }
  TSharedPtr<IWebSocket> CreateWebSocket(const FString&, const FString&) { return socket; }
  TSharedPtr<IWebSocket> socket{new IWebSocket};
};
