#include "method/series/recent_equations.hpp"

#include <cstring>
#include <type_traits>

namespace polhode {
namespace {

bool has_same_bits(const double* a, const double* b, std::size_t n) { return std::memcmp(a, b, n * sizeof *a) == 0; }

bool has_same_bits(const TorqueValue& a, const TorqueValue& b) {
  if (a.index() != b.index()) return false;
  if (const auto* one = std::get_if<double>(&a)) return has_same_bits(one, &std::get<double>(b), 1);
  if (const auto* one = std::get_if<Vector3d>(&a)) return has_same_bits(one->data(), std::get<Vector3d>(b).data(), 3);
  if (const auto* one = std::get_if<Matrix3d>(&a)) return has_same_bits(one->data(), std::get<Matrix3d>(b).data(), 9);
  return a == b;
}

bool have_same_law(const LastingTorque& a, const LastingTorque& b) {
  return a.index() == b.index() && std::visit([&]<class T>(const T& one) {
    const T& other = std::get<T>(b);
    if constexpr (std::is_same_v<T, torques::Formula>) {
      // Formulas of the same text may have their operations in another order.
      return &one.program() == &other.program() ||
             (one == other && formula::is_same(one.program(), other.program()));
    } else if constexpr (requires { one.values(); }) {
      const TorqueValues mine = one.values(), others = other.values();
      for (std::size_t i = 0; i < mine.size(); ++i)
        if (!has_same_bits(mine[i], others[i])) return false;
      return true;
    } else {
      return false;   // a Custom, which has no law
    }
  }, a);
}

}  // namespace

bool is_small(const formula::Table& table) { return table.count_picks() <= 2000; }

EquationsKey::EquationsKey(const Scene& scene, const BodySeries& frame) {
  for (const AnyTorque& torque : scene.torques()) add(drop_windows(torque));
  const SeriesTerms& terms = frame.terms();
  const Quat& q = frame.from_axes();
  for (const double number : {static_cast<double>(terms.variables), q.x, q.y, q.z, q.w}) add(number);
  add(terms.to_rates, 3), add(terms.product, 3), add(frame.moments().data(), 3), add(frame.axes().data(), 9);
  add(scene.inertia_B().matrix().data(), 9), add(scene.rotor_momentum().data(), 3);
}

bool operator==(const EquationsKey& a, const EquationsKey& b) {
  if (a.numbers_.size() != b.numbers_.size() || a.torques_.size() != b.torques_.size() ||
      !has_same_bits(a.numbers_.data(), b.numbers_.data(), a.numbers_.size()))
    return false;
  for (std::size_t i = 0; i < a.torques_.size(); ++i)
    if (!have_same_law(a.torques_[i], b.torques_[i])) return false;
  return true;
}

}  // namespace polhode
