// Radiance that varies from place to place, in lanes: a trilinear look-up of a field and, for a
// temperature, of the table of its radiance.

#if defined(FREEPATH_MEDIA_RADIANCE_FIELD_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FREEPATH_MEDIA_RADIANCE_FIELD_INL_H_
#undef FREEPATH_MEDIA_RADIANCE_FIELD_INL_H_
#else
#define FREEPATH_MEDIA_RADIANCE_FIELD_INL_H_
#endif

#include "freepath/base/lanes-inl.h"
#include "freepath/media/medium_view.h"

HWY_BEFORE_NAMESPACE();
namespace freepath::HWY_NAMESPACE {

/// The trilinear interpolant of a field at points [walk space], 0 in lanes that do not look.
HWY_INLINE VecF interpolate_field(const RadianceView& view, const VecF (&point)[3], MaskF lanes) {
  // Of the two voxels along each axis: where their bricks are in the index, and they in these.
  VecI brick[2][3];
  VecI within[2][3];
  VecF weight[2][3];
  const int brick_steps[3] = {view.brick_counts[1] * view.brick_counts[2], view.brick_counts[2], 1};
  for (int axis = 0; axis < 3; ++axis) {
    VecF position = set(view.walk_to_voxels.offset[axis] - 0.5F);
    for (int from = 0; from < 3; ++from) {
      position = mul_add(point[from], set(view.walk_to_voxels.linear[from][axis]), position);
    }
    const float last = static_cast<float>(view.brick_counts[axis] * BrickMap::kBrickSize - 2);
    // Maximum and minimum also keep idle lanes inside.
    position = hn::IfThenElseZero(lanes, hn::Min(hn::Max(position, hn::Zero(kFloat)), set(last)));
    const VecF base = hn::Floor(position);
    const VecI first = small_to_int(base);
    for (int next : {0, 1}) {
      const VecI voxel = hn::Add(first, hn::Set(kInt, next));
      const VecI number = hn::ShiftRight<3>(voxel);
      brick[next][axis] = axis == 2 ? number : hn::Mul(number, hn::Set(kInt, brick_steps[axis]));
      const VecI inside = hn::And(voxel, hn::Set(kInt, 7));
      within[next][axis] = axis == 0   ? hn::ShiftLeft<6>(inside)
                           : axis == 1 ? hn::ShiftLeft<3>(inside)
                                       : inside;
    }
    weight[1][axis] = hn::Sub(position, base);
    weight[0][axis] = hn::Sub(set(1.0F), weight[1][axis]);
  }
  const auto* index = reinterpret_cast<const int32_t*>(view.index);
  VecF sum = hn::Zero(kFloat);
  for (int corner = 0; corner < 8; ++corner) {
    const int cx = corner >> 2;
    const int cy = corner >> 1 & 1;
    const int cz = corner & 1;
    const VecI entry = hn::Add(hn::Add(brick[cx][0], brick[cy][1]), brick[cz][2]);
    const VecI voxel = hn::Or(hn::Or(within[cx][0], within[cy][1]), within[cz][2]);
    const VecI address = hn::Or(hn::ShiftLeft<9>(hn::GatherIndex(kInt, index, entry)), voxel);
    const VecF share = hn::Mul(hn::Mul(weight[cx][0], weight[cy][1]), weight[cz][2]);
    sum = mul_add(share, hn::GatherIndex(kFloat, view.voxels, address), sum);
  }
  return hn::IfThenElseZero(lanes, sum);
}

/// The radiance that a field's value stands for.
HWY_INLINE VecF radiance_of(const RadianceView& view, VecF value) {
  if (view.table == nullptr) return value;
  const VecF position = hn::Min(
      hn::Max(hn::Mul(hn::Sub(value, set(view.first)), set(view.per_step)), hn::Zero(kFloat)),
      set(view.last));
  const VecF base = hn::Floor(hn::Min(position, set(view.last - 1)));
  const VecI number = hn::ConvertTo(kInt, base);
  const VecF before = hn::GatherIndex(kFloat, view.table, number);
  const VecF after = hn::GatherIndex(kFloat, view.table, hn::Add(number, hn::Set(kInt, 1)));
  return mul_add(hn::Sub(position, base), hn::Sub(after, before), before);
}

/// Radiances of N channels at points; channels that share a field share the look-up.
/// @param channels that differ: those beyond repeat them
template <int N>
HWY_NOINLINE void radiance_at(const RadianceView* views, int channels, const VecF (&point)[3],
                              MaskF lanes, VecF (&radiance)[N]) {
  VecF value = hn::Zero(kFloat);
  for (int channel = 0; channel < N; ++channel) {
    if (channel >= channels) {
      radiance[channel] = radiance[channel - channels];
      continue;
    }
    const RadianceView& view = views[channel];
    if (channel == 0 || view.voxels != views[channel - 1].voxels) {
      value = interpolate_field(view, point, lanes);
    }
    radiance[channel] = radiance_of(view, value);
  }
}

}  // namespace freepath::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // FREEPATH_MEDIA_RADIANCE_FIELD_INL_H_
