// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <numbers>

#include "engine/clearance/friction_parameters.h"
#include "engine/math/dual.h"
#include "engine/math/exponential.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// Stribeck's curve g(|v|) = mu_k + (mu_s - mu_k) exp(-(v / v_s)^2). Beyond (v / v_s)^2 = 40 the exponential
/// is below rounding.
/// @param squared  (v / v_s)^2
template <typename V>
[[nodiscard]] RPSUP_INLINE V calc_stribeck_at(const FrictionParameters& p, const V& squared) {
  if (value_of(squared) > 40.0) return V(p.mu_k);
  return p.mu_k + (p.mu_s - p.mu_k) * exp(-squared);
}
template <int count>
[[nodiscard]] RPSUP_INLINE LaneBlock<count> calc_stribeck_at(const FrictionParameters& p,
                                                             const LaneBlock<count>& squared) {
  using Block = LaneBlock<count>;
  const Block most = Block::all(40.0), slid = Block::all(p.mu_k);
  if (all_below(choose_greater(squared, most, Block{}, Block::all(1.0)), 0.5)) return slid;
  const Block curve =
      p.mu_k + (p.mu_s - p.mu_k) * calc_exponentials(-choose_greater(squared, most, most, squared));
  return choose_greater(squared, most, slid, curve);
}
/// One number alone, to the bit as it would be beside others.
[[nodiscard]] RPSUP_INLINE double calc_stribeck_at(const FrictionParameters& p, double squared) {
  return calc_stribeck_at(p, LanePair::first(squared))[0];
}

template <typename V>
[[nodiscard]] RPSUP_INLINE V calc_stribeck_curve(const FrictionParameters& p, const V& speed) {
  const V ratio = speed / p.v_s;
  return calc_stribeck_at(p, ratio * ratio);
}

/// Rate at which a sliding bristle lets go: sigma_0 |v| / g(|v|), [1/s].
template <typename V>
[[nodiscard]] RPSUP_INLINE V calc_bristle_decay(const FrictionParameters& p, const V& speed) {
  return p.sigma_0 * speed / calc_stribeck_curve(p, speed);
}

/// Friction and bristle rate for one component of the sliding velocity.
template <typename V>
struct BristleResponse {
  /// Of the normal force, sigma_0 z + sigma_1 zd + sigma_2 v with bristles, [1]; it acts against v.
  V force_ratio;
  V rate;                            ///< zd = v - sigma_0 |v| z / g(|v|), [m/s]
};

template <typename V>
[[nodiscard]] RPSUP_INLINE BristleResponse<V> calc_bristle_response(const FrictionParameters& p,
                                                                    const V& decay, const V& v, const V& z) {
  const V rate = v - decay * z;
  return {p.sigma_0 * z + p.sigma_1 * rate + p.sigma_2 * v, rate};
}

/// Friction and bristle rates for both components.
template <typename V>
struct FrictionForce {
  BristleResponse<V> along_t, along_z;
};

/// Part of its decay that an elasto-plastic bristle has: none below its break-away and on its way back, all
/// of it at its steady deflection, half a sine between. Source: Dupont, Hayward, Armstrong, Altpeter, Single
/// state elastoplastic friction models (2002), Eq. (10).
/// @param ratio  deflection over the steady one
template <typename V>
[[nodiscard]] RPSUP_INLINE V calc_plastic_part(const FrictionParameters& p, const V& ratio) {
  if (value_of(ratio) <= p.break_away) return V(0.0);
  if (value_of(ratio) >= 1.0) return V(1.0);
  const double middle = 0.5 * (1.0 + p.break_away);
  return 0.5 + 0.5 * sin((std::numbers::pi / (1.0 - p.break_away)) * (ratio - middle));
}

template <typename V>
[[nodiscard]] RPSUP_INLINE V calc_plastic_decay(const FrictionParameters& p, const V& speed, const V& v_t,
                                                const V& v_z, const V& z_t, const V& z_z) {
  if (value_of(v_t) * value_of(z_t) + value_of(v_z) * value_of(z_z) <= 0.0) return V(0.0);
  const V curve = calc_stribeck_curve(p, speed);
  return p.sigma_0 * speed / curve * calc_plastic_part(p, p.sigma_0 * sqrt(z_t * z_t + z_z * z_z) / curve);
}

/// Friction over sliding speed of the laws without bristles, [s/m].
template <typename V>
[[nodiscard]] RPSUP_INLINE V calc_slip_factor(const FrictionParameters& p, const V& speed) {
  if (p.law == FrictionLaw::kCoulomb) return p.mu_k / sqrt(speed * speed + p.v_0 * p.v_0);
  if (value_of(speed) <= p.v_0) return V(0.0);
  if (value_of(speed) >= p.v_1) return p.mu_k / speed;
  return (p.mu_k / (p.v_1 - p.v_0)) * (speed - p.v_0) / speed;
}

/// @param v_t, v_z  sliding velocity  @param z_t, z_z  bristle
template <typename V>
[[nodiscard]] RPSUP_INLINE FrictionForce<V> calc_friction(const FrictionParameters& p, const V& v_t,
                                                          const V& v_z, const V& z_t, const V& z_z) {
  const V speed = sqrt(v_t * v_t + v_z * v_z);
  if (!has_bristles(p.law)) {
    const V factor = calc_slip_factor(p, speed);
    return {{factor * v_t, V(0.0)}, {factor * v_z, V(0.0)}};
  }
  const V decay = p.law == FrictionLaw::kElastoPlastic ? calc_plastic_decay(p, speed, v_t, v_z, z_t, z_z)
                                                       : calc_bristle_decay(p, speed);
  return {calc_bristle_response(p, decay, v_t, z_t), calc_bristle_response(p, decay, v_z, z_z)};
}

/// Friction at several contact points side by side; by laws with branches, at one point after the other.
template <int count>
[[nodiscard]] RPSUP_INLINE FrictionForce<LaneBlock<count>> calc_friction(const FrictionParameters& p,
                                                                         const LaneBlock<count>& v_t,
                                                                         const LaneBlock<count>& v_z,
                                                                         const LaneBlock<count>& z_t,
                                                                         const LaneBlock<count>& z_z) {
  if (p.law == FrictionLaw::kLuGre || p.law == FrictionLaw::kDahl) {
    const LaneBlock<count> decay = calc_bristle_decay(p, sqrt(v_t * v_t + v_z * v_z));
    return {calc_bristle_response(p, decay, v_t, z_t), calc_bristle_response(p, decay, v_z, z_z)};
  }
  FrictionForce<LaneBlock<count>> all{};
  for (int lane = 0; lane < count; ++lane) {
    const FrictionForce<double> one = calc_friction(p, v_t[lane], v_z[lane], z_t[lane], z_z[lane]);
    all.along_t.force_ratio.set(lane, one.along_t.force_ratio);
    all.along_t.rate.set(lane, one.along_t.rate);
    all.along_z.force_ratio.set(lane, one.along_z.force_ratio);
    all.along_z.rate.set(lane, one.along_z.rate);
  }
  return all;
}

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
