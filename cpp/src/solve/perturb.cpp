#include "perturb.hpp"

#include <cmath>
#include <cstdint>
#include <limits>

namespace polhode {
namespace {

/// Vigna's splitmix64 (public domain, as an idea): a fair coin that is the same on every machine.
class Coin {
 public:
  double move(double x) {
    state_ += 0x9e3779b97f4a7c15u;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    const double end = ((z ^ (z >> 31)) & 1) != 0 ? std::numeric_limits<double>::infinity() : -std::numeric_limits<double>::infinity();
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
  std::uint64_t state_ = 2026;
};

AnyTorque perturb_torque(const AnyTorque& torque, Coin& coin) {
  return std::visit(
      [&]<class T>(const T& one) -> AnyTorque {
        if constexpr (requires { one.values(); }) {
          TorqueValues values = one.values();
          for (TorqueValue& value : values) std::visit([&](auto& x) { coin(x); }, value);
          return T::from_values(values);
        } else {
          return one;
        }
      },
      torque);
}

}  // namespace

Scene perturb(const Scene& scene) {
  Coin coin;
  Matrix3d I = scene.inertia_B().matrix();
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j <= i; ++j) I(i, j) = I(j, i) = coin.move(I(i, j));
  SceneParts parts{.inertia_B = InertiaTensor::from_trusted(I, scene.inertia_B().physical())};
  parts.omega = scene.omega();
  coin(parts.omega);
  const Quat& q = scene.attitude();
  parts.attitude = {coin.move(q.x), coin.move(q.y), coin.move(q.z), coin.move(q.w)};
  for (const AnyTorque& torque : scene.torques()) parts.torques.push_back(perturb_torque(torque, coin));
  parts.times = scene.times();
  parts.want = scene.want();
  parts.t0 = scene.t0();
  return Scene(std::move(parts));
}

}  // namespace polhode
