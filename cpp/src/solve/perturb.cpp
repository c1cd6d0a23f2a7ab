#include "solve/perturb.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "solve/pieces.hpp"

namespace polhode {
namespace {

/// Vigna's splitmix64 (public domain, as an idea): a fair coin that is the same on every machine.
class Coin {
 public:
  explicit Coin(std::uint64_t seed = 2026) : state_(seed) {}

  bool toss() {
    state_ += 0x9e3779b97f4a7c15u;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return ((z ^ (z >> 31)) & 1) != 0;
  }
  double move(double x) {
    const double end = toss() ? std::numeric_limits<double>::infinity() : -std::numeric_limits<double>::infinity();
    return x == 0.0 ? x : std::nextafter(std::nextafter(x, end), end);
  }
  void operator()(double& x) { x = move(x); }
  void operator()(Vector3d& v) {
    for (int i = 0; i < 3; ++i) v[i] = move(v[i]);
  }
  void operator()(Matrix3d& m) {
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) m(i, j) = move(m(i, j));
  }
  void operator()(std::string&) {}

 private:
  std::uint64_t state_;
};

template <class Torque>
Torque perturb_torque(const Torque& torque, Coin& coin) {
  return std::visit(
      [&]<class T>(const T& kind) -> Torque {
        if constexpr (std::is_same_v<T, torques::During>) {
          return T(perturb_torque(kind.torque(), coin), kind.windows());
        } else if constexpr (requires { kind.values(); }) {
          TorqueValues values = kind.values();
          for (TorqueValue& value : values) std::visit([&](auto& x) { coin(x); }, value);
          return T::from_values(values);
        } else {
          return kind;
        }
      },
      torque);
}

/// Windows' ends by their own values, so that those of two torques at one time stay at one time.
AnyTorque perturb_windows(const AnyTorque& torque, double first, double last, double t0) {
  const auto* during = std::get_if<torques::During>(&torque);
  if (during == nullptr) return torque;
  const auto move = [=](double t) {
    return first < t && t < last && t != t0 ? Coin(std::bit_cast<std::uint64_t>(t)).move(t) : t;
  };
  std::vector<torques::Window> windows = during->windows();
  double before = -std::numeric_limits<double>::infinity();
  for (torques::Window& window : windows) {
    window = {move(window.begin), move(window.end)};
    if (!(before <= window.begin && window.begin < window.end))
      return torque;   // nothing lies between so near neighbours
    before = window.end;
  }
  return torques::During(during->torque(), std::move(windows));
}

}  // namespace

State perturb_state(const State& state, double units, int seed) {
  Coin coin(static_cast<std::uint64_t>(seed));
  const double size = units * std::numeric_limits<double>::epsilon(), rate = state.omega.norm();
  State perturbed = state;
  for (int i = 0; i < 3; ++i) perturbed.omega[i] += (coin.toss() ? size : -size) * rate;
  for (double* part : {&perturbed.attitude.x, &perturbed.attitude.y, &perturbed.attitude.z, &perturbed.attitude.w})
    *part += coin.toss() ? size : -size;
  return perturbed;
}

Scene perturb(const Scene& scene) {
  Coin coin;
  Matrix3d I = scene.inertia_B().matrix();
  const bool cut = has_windows(scene);   // then equal moments stay equal: a piece of it may be a closed form's
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j <= i; ++j)
      I(i, j) = I(j, i) = cut ? Coin(std::bit_cast<std::uint64_t>(I(i, j))).move(I(i, j)) : coin.move(I(i, j));
  SceneParts parts = scene.parts();
  parts.inertia_B = InertiaTensor::from_trusted(I, scene.inertia_B().physical());
  coin(parts.omega);
  const Quat& q = scene.attitude();
  parts.attitude = {coin.move(q.x), coin.move(q.y), coin.move(q.z), coin.move(q.w)};
  const auto [least, most] = std::minmax_element(scene.times().begin(), scene.times().end());
  const double first = std::min(*least, scene.t0()), last = std::max(*most, scene.t0());
  for (AnyTorque& torque : parts.torques)
    torque = perturb_windows(perturb_torque(torque, coin), first, last, scene.t0());
  return Scene(std::move(parts));
}

}  // namespace polhode
