#include "solve/run/perturb.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "polhode/math/detail/coin.hpp"
#include "solve/ground/pieces.hpp"
#include "solve/ground/proportional_damping.hpp"

namespace polhode {
namespace {

constexpr double no_end = std::numeric_limits<double>::infinity();

/// Changes numbers by some units in the last place, up or down at random.
class Perturber {
 public:
  explicit Perturber(int units, std::uint64_t seed = 2026) : units_(units), coin_(seed) {}

  double operator()(double x) {
    const double end = coin_.toss() ? no_end : -no_end;
    for (int i = 0; i < units_ && x != 0.0; ++i) x = std::nextafter(x, end);
    return x;
  }
  void apply(double& x) { x = (*this)(x); }
  void apply(Vector3d& v) {
    for (int i = 0; i < 3; ++i) apply(v[i]);
  }
  void apply(Matrix3d& m) {
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) apply(m(i, j));
  }
  void apply(std::string&) {}
  void apply(formula::Ephemeris&) {}   // rounded much less than the torque

 private:
  int units_;
  math::Coin coin_;
};

/// Changes a number by a rule that depends on the number alone.
double perturb_alone(double x, int units) { return Perturber(units, std::bit_cast<std::uint64_t>(x))(x); }

template <class Torque>
Torque perturb_torque(const Torque& torque, Perturber& perturber) {
  return std::visit(
      [&]<class T>(const T& kind) -> Torque {
        if constexpr (std::is_same_v<T, torques::During>) {
          return T(perturb_torque(kind.torque(), perturber), kind.windows());
        } else if constexpr (requires { kind.values(); }) {
          TorqueValues values = kind.values();
          for (TorqueValue& value : values) std::visit([&](auto& x) { perturber.apply(x); }, value);
          return T::from_values(values);
        } else {
          return kind;
        }
      },
      torque);
}

Rotor perturb_rotor(const Rotor& rotor, Perturber& perturber) {
  RotorParts parts = rotor.parts();
  perturber.apply(parts.axis);
  for (std::optional<double>* number : {&parts.momentum, &parts.inertia, &parts.speed})
    if (*number) perturber.apply(**number);
  return Rotor(std::move(parts));
}

Changing perturb_terms(const Changing& changing, int units) {
  std::vector<Changing::Piece> pieces = changing.pieces();
  for (Changing::Piece& piece : pieces)
    for (std::vector<double>& term : piece.terms)
      for (double& x : term) x = perturb_alone(x, units);
  return Changing(std::move(pieces), changing.physical());
}

/// A damping matrix proportional to the inertia, as the torque that stays so when both are perturbed. A piece with it
/// may have a closed form.
template <class Torque>
Torque keep_proportional(const Torque& torque, const Matrix3d& inertia_B) {
  return std::visit(
      [&]<class T>(const T& kind) -> Torque {
        if constexpr (std::is_same_v<T, torques::During>) {
          return T(keep_proportional(kind.torque(), inertia_B), kind.windows());
        } else if constexpr (std::is_same_v<T, torques::Damping>) {
          const auto found = find_proportional(kind.matrix(), inertia_B);
          return found ? Torque(torques::AngularDamping(found->rate)) : Torque(kind);
        } else {
          return kind;
        }
      },
      torque);
}

/// Changes each end of a window by its own value, so that equal ends of two torques stay equal.
AnyTorque perturb_windows(const AnyTorque& torque, double first, double last, double t0) {
  const auto* during = std::get_if<torques::During>(&torque);
  if (during == nullptr) return torque;
  const auto perturb_end = [=](double t) {
    return first < t && t < last && t != t0 ? perturb_alone(t, 2) : t;
  };
  std::vector<torques::Window> windows = during->windows();
  double before = -no_end;
  for (torques::Window& window : windows) {
    window = {perturb_end(window.begin), perturb_end(window.end)};
    if (!(before <= window.begin && window.begin < window.end))
      return torque;   // the ends are too close to be changed
    before = window.end;
  }
  return torques::During(during->torque(), std::move(windows));
}

}  // namespace

State perturb_state(const State& state, double units, int seed, bool keep_zeros) {
  math::Coin coin(static_cast<std::uint64_t>(seed));
  const double size = units * std::numeric_limits<double>::epsilon(), rate = state.omega.norm();
  State perturbed = state;
  const auto change = [&](double& part, double by) {
    const double signed_by = coin.toss() ? by : -by;
    if (!keep_zeros || part != 0.0) part += signed_by;
  };
  for (int i = 0; i < 3; ++i) change(perturbed.omega[i], size * rate);
  for (double* part : {&perturbed.attitude.x, &perturbed.attitude.y, &perturbed.attitude.z, &perturbed.attitude.w})
    change(*part, size);
  return perturbed;
}

Scene perturb(const Scene& scene, int units) {
  Perturber perturber(units);
  Matrix3d I = scene.given_inertia_B().matrix();
  const bool cut = has_windows(scene);   // then equal moments stay equal, because a piece may have a closed form
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j <= i; ++j)
      I(i, j) = I(j, i) = cut ? perturb_alone(I(i, j), units) : perturber(I(i, j));
  SceneParts parts = scene.parts();
  parts.inertia_B = InertiaTensor::from_trusted(I, scene.given_inertia_B().physical());
  // Equal numbers stay equal, so that what is constant stays so.
  for (std::optional<Changing>* one : {&parts.changing, &parts.momentum})
    if (*one) *one = perturb_terms(**one, units);
  perturber.apply(parts.omega);
  const Quat& q = scene.attitude();
  parts.attitude = {perturber(q.x), perturber(q.y), perturber(q.z), perturber(q.w)};
  const auto [least, most] = std::minmax_element(scene.times().begin(), scene.times().end());
  const double first = std::min(*least, scene.t0()), last = std::max(*most, scene.t0());
  // The rates jump where a rotor starts or stops, so a sample there would move with the time of the jump.
  const bool windows_stay = has_rotor_windows(scene);
  for (AnyTorque& torque : parts.torques) {
    if (cut) torque = keep_proportional(torque, scene.inertia_B().matrix());
    torque = perturb_torque(torque, perturber);
    if (!windows_stay) torque = perturb_windows(torque, first, last, scene.t0());
  }
  for (Rotor& rotor : parts.rotors) rotor = perturb_rotor(rotor, perturber);
  return Scene(std::move(parts));
}

}  // namespace polhode
