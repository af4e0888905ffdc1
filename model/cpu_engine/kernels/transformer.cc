#include "model/cpu_engine/kernels/transformer.h"

#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "model/cpu_engine/kernels/transformer.cc"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "model/cpu_engine/kernels/vector_math-inl.h"
// clang-format off: this must follow foreach_target.h.
#include <hwy/contrib/math/math-inl.h>
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace duet::cpu_engine::kernels::HWY_NAMESPACE {

// The number of values after `at` of `count`, at most one vector.
HWY_INLINE ptrdiff_t Left(ptrdiff_t count, ptrdiff_t at) { return HWY_MIN(count - at, Lanes()); }

void GeluInPlace(ptrdiff_t count, float* HWY_RESTRICT values) {
  const Tag d;
  const Vector half = hn::Set(d, 0.5f), root_half = hn::Set(d, 0.70710678118654752f);
  for (ptrdiff_t i = 0; i < count; i += Lanes()) {
    const Vector x = LoadFirst(Left(count, i), values + i);
    StoreFirst(Left(count, i), half * x * (hn::Set(d, 1.0f) + Erf(x * root_half)), values + i);
  }
}

void SiluInPlace(ptrdiff_t count, float* HWY_RESTRICT values) {
  for (ptrdiff_t i = 0; i < count; i += Lanes()) {
    const Vector x = LoadFirst(Left(count, i), values + i);
    StoreFirst(Left(count, i), x * Sigmoid(x), values + i);
  }
}

void Norm(const NormRow& row) {
  const Tag d;
  Vector sum = hn::Zero(d);
  for (int i = 0; i < row.width; i += Lanes()) sum = sum + LoadFirst(row.width - i, row.x + i);
  const float width = static_cast<float>(row.width);
  const Vector mean = hn::Set(d, hn::GetLane(hn::SumOfLanes(d, sum)) / width);
  Vector squares = hn::Zero(d);
  for (int i = 0; i < row.width; i += Lanes()) {
    const auto valid = hn::FirstN(d, static_cast<size_t>(HWY_MIN(row.width - i, Lanes())));
    const Vector from_mean = hn::IfThenElseZero(valid, LoadFirst(row.width - i, row.x + i) - mean);
    squares = hn::MulAdd(from_mean, from_mean, squares);
  }
  const float variance = hn::GetLane(hn::SumOfLanes(d, squares)) / width;
  const Vector factor = hn::Set(d, 1 / std::sqrt(variance + 1e-5f));
  const Vector offset = hn::Set(d, row.scale_offset);
  for (int i = 0; i < row.width; i += Lanes()) {
    const int valid = row.width - i;
    const Vector normal = (LoadFirst(valid, row.x + i) - mean) * factor;
    const Vector scale = LoadFirst(valid, row.scale + i) + offset;
    StoreFirst(valid, hn::MulAdd(normal, scale, LoadFirst(valid, row.shift + i)), row.out + i);
  }
}

// Rows of a tile: the sums of three vectors of columns each fit the registers besides the factors.
constexpr int kRows = HWY_TARGET <= HWY_AVX3 ? 8 : 4;

// A window's head with its scratch. The lanes of vectors are queries, so that the largest score
// and the sum of a query are lane by lane.
struct Head {
  const SelfAttention& in;
  ptrdiff_t stride;  // queries, rounded up to whole vectors of any instruction set
  float* queries;    // [size, stride], transposed
  float* weights;    // [frames, stride]: of the keys, a column for each query
  float* distance;   // [frames + stride]: in.distance backwards
};

HWY_INLINE Vector LoadPart(ptrdiff_t valid, const float* from) {
  if constexpr (kMasksMemory) {
    const Tag d;
    return hn::MaskedLoad(hn::FirstN(d, static_cast<size_t>(valid)), d, from);
  } else {
    return LoadFirst(valid, from);
  }
}

// A product whose rows and inputs may lie any distance apart:
// y[r, c] = sum over k of x[r * x_row + k * x_step] * w[k * w_stride + c].
struct Product {
  int rows, inputs;
  const float* x;
  ptrdiff_t x_row, x_step;
  const float* w;
  ptrdiff_t w_stride;
  float* y;
  ptrdiff_t y_stride;
};

// Computes kVectors vectors of columns, of which the last has `last` columns. Requires kCount rows.
template <int kCount, int kVectors>
HWY_NOINLINE void Tiles(const Product& p, ptrdiff_t last) {
  const Tag d;
  for (int first = 0; first < p.rows; first += kCount) {
    // The last tile ends at the last row: it computes some rows again.
    const ptrdiff_t row = HWY_MIN(first, p.rows - kCount);
    Vector sums[kCount][kVectors];
    for (int r = 0; r < kCount; ++r) {
      for (int v = 0; v < kVectors; ++v) sums[r][v] = hn::Zero(d);
    }
    const float* HWY_RESTRICT x = p.x + row * p.x_row;
    const float* HWY_RESTRICT w = p.w;
    const ptrdiff_t x_row = p.x_row;
    for (int k = 0; k < p.inputs; ++k, x += p.x_step, w += p.w_stride) {
      Vector by[kVectors];
      for (int v = 0; v < kVectors - 1; ++v) by[v] = hn::LoadU(d, w + v * Lanes());
      by[kVectors - 1] = LoadPart(last, w + (kVectors - 1) * Lanes());
      for (int r = 0; r < kCount; ++r) {
        const Vector value = hn::Set(d, x[r * x_row]);
        for (int v = 0; v < kVectors; ++v) sums[r][v] = hn::MulAdd(value, by[v], sums[r][v]);
      }
    }
    for (int r = 0; r < kCount; ++r) {
      float* const y = p.y + (row + r) * p.y_stride;
      for (int v = 0; v < kVectors - 1; ++v) hn::StoreU(sums[r][v], d, y + v * Lanes());
      StoreFirst(last, sums[r][kVectors - 1], y + (kVectors - 1) * Lanes());
    }
  }
}

template <int kVectors>
void TilesOf(const Product& p, ptrdiff_t last) {
  (p.rows < kRows ? Tiles<1, kVectors> : Tiles<kRows, kVectors>)(p, last);
}

void Multiply(Product p, ptrdiff_t columns) {
  while (columns > 0) {
    const ptrdiff_t vectors = HWY_MIN((columns + Lanes() - 1) / Lanes(), ptrdiff_t{3});
    const ptrdiff_t last = HWY_MIN(columns - (vectors - 1) * Lanes(), Lanes());
    (vectors == 1 ? TilesOf<1> : vectors == 2 ? TilesOf<2> : TilesOf<3>)(p, last);
    columns -= vectors * Lanes();
    p.w += vectors * Lanes();
    p.y += vectors * Lanes();
  }
}

// Turns the products of all keys with a vector of queries into weights.
void Weigh(const Head& head, ptrdiff_t column) {
  const Tag d;
  const ptrdiff_t frames = head.in.frames, stride = head.stride;
  const Vector factor = hn::Set(d, 1 / std::sqrt(static_cast<float>(head.in.size)));
  float* const weights = head.weights + column;
  const float* const distance = head.distance + frames - 1 + column;
  Vector largest = hn::Set(d, -3e38f), sum = hn::Zero(d);
  for (ptrdiff_t key = 0; key < frames; ++key) {
    const Vector bias = hn::LoadU(d, distance - key);
    const Vector score = hn::MulAdd(factor, hn::LoadU(d, weights + key * stride), bias);
    largest = hn::Max(largest, score);
    hn::StoreU(score, d, weights + key * stride);
  }
  for (ptrdiff_t key = 0; key < frames; ++key) {
    const Vector e = Exp(hn::LoadU(d, weights + key * stride) - largest);
    sum = sum + e;
    hn::StoreU(e, d, weights + key * stride);
  }
  const Vector share = hn::Set(d, 1.0f) / sum;
  for (ptrdiff_t key = 0; key < frames; ++key) {
    hn::StoreU(hn::LoadU(d, weights + key * stride) * share, d, weights + key * stride);
  }
}

void Attend(const SelfAttention& in) {
  const ptrdiff_t frames = in.frames, stride = SelfAttentionStride(in.frames);
  const Head head{in, stride, in.scratch, in.scratch + in.size * stride,
                  in.scratch + (in.size + frames) * stride};
  for (ptrdiff_t i = 0; i < frames; ++i) {
    const float* const query = in.queries + i * in.in_stride;
    for (ptrdiff_t k = 0; k < in.size; ++k) head.queries[k * stride + i] = query[k];
  }
  for (ptrdiff_t k = 0; k < in.size; ++k) {
    std::fill(head.queries + k * stride + frames, head.queries + (k + 1) * stride, 0.0f);
  }
  std::reverse_copy(in.distance, in.distance + 2 * frames - 1, head.distance);
  std::fill(head.distance + 2 * frames - 1, head.distance + frames + stride, 0.0f);
  Multiply(
      {in.frames, in.size, in.keys, in.in_stride, 1, head.queries, stride, head.weights, stride},
      stride);
  for (ptrdiff_t column = 0; column < frames; column += Lanes()) Weigh(head, column);
  Multiply({in.frames, in.frames, head.weights, 1, stride, in.values, in.in_stride, in.out,
            in.out_stride},
           in.size);
}

using DoubleTag = hn::CappedTag<double, 8>;

HWY_INLINE hn::Vec<DoubleTag> Normals(const double* uniform) {
  const DoubleTag d;
  hn::Vec<DoubleTag> radius, angle;
  hn::LoadInterleaved2(d, uniform, radius, angle);
  radius = hn::Sqrt(hn::Set(d, -2.0) * hn::Log(d, radius));
  return radius * hn::Cos(d, hn::Set(d, 6.283185307179586) * angle);
}

void BoxMuller(ptrdiff_t count, const double* uniform, float* out) {
  const DoubleTag d;
  constexpr size_t kMost = hn::MaxLanes(d);
  const ptrdiff_t lanes = static_cast<ptrdiff_t>(hn::Lanes(d));
  HWY_ALIGN double pairs[2 * kMost];
  HWY_ALIGN double normals[kMost];
  for (ptrdiff_t i = 0; i < count; i += lanes) {
    const ptrdiff_t size = count - i < lanes ? count - i : lanes;
    const double* from = uniform + 2 * i;
    if (size < lanes) {
      for (ptrdiff_t k = 0; k < 2 * lanes; ++k) pairs[k] = k < 2 * size ? from[k] : 0.5;
      from = pairs;
    }
    hn::Store(Normals(from), d, normals);
    for (ptrdiff_t k = 0; k < size; ++k) out[i + k] = static_cast<float>(normals[k]);
  }
}

}  // namespace duet::cpu_engine::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace duet::cpu_engine::kernels {

HWY_EXPORT(GeluInPlace);
HWY_EXPORT(SiluInPlace);
HWY_EXPORT(Norm);
HWY_EXPORT(Attend);
HWY_EXPORT(BoxMuller);

void Gelu(std::ptrdiff_t count, float* values) { HWY_DYNAMIC_DISPATCH(GeluInPlace)(count, values); }
void Silu(std::ptrdiff_t count, float* values) { HWY_DYNAMIC_DISPATCH(SiluInPlace)(count, values); }
void LayerNorm(const NormRow& row) { HWY_DYNAMIC_DISPATCH(Norm)(row); }
void AttendToSelf(const SelfAttention& attention) { HWY_DYNAMIC_DISPATCH(Attend)(attention); }
void StandardNormals(std::ptrdiff_t count, const double* uniform, float* out) {
  HWY_DYNAMIC_DISPATCH(BoxMuller)(count, uniform, out);
}

}  // namespace duet::cpu_engine::kernels
#endif
