#pragma once

// Between the wire's world (right-handed, z up, millimetres) and Unreal's (left-handed, z up,
// centimetres).
struct DuetAxes {
  static constexpr double kMillimetres = 10.0;  // in a centimetre

  static FVector ToUnreal(float X, float Y, float Z) {
    return FVector(X / kMillimetres, -Y / kMillimetres, Z / kMillimetres);
  }

  static FQuat ToUnreal(float X, float Y, float Z, float W) { return FQuat(-X, Y, -Z, W); }

  // Appends a joint's position in wire order: x, y, z in one flat list, frame by frame, and within
  // a frame joint by joint, in the order of joint_names.
  template <typename Floats>
  static void Append(const FVector& Position, Floats& Positions) {
    Positions.Add(static_cast<float>(Position.X * kMillimetres));
    Positions.Add(static_cast<float>(-Position.Y * kMillimetres));
    Positions.Add(static_cast<float>(Position.Z * kMillimetres));
  }
};
