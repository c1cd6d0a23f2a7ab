#include "solve/proof/body_equations.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "polhode/formula/facts.hpp"
#include "polhode/math/detail/number.hpp"
#include "solve/proof/body_constants.hpp"
#include "solve/proof/formula_step.hpp"
#include "solve/proof/quadratic_step.hpp"

namespace polhode::proof {
namespace {

AnyTorque drop_window(const AnyTorque& torque) {
  const auto* during = std::get_if<torques::During>(&torque);
  if (during == nullptr) return torque;
  return std::visit([](const auto& lasting) { return AnyTorque(lasting); }, during->torque());
}

bool is_in_space(const torques::Constant& constant) {
  return constant.frame() == torques::Constant::Frame::space && !constant.traits().vanishes;
}

/// A power of two that divides every component of a vector without rounding, near the largest where there is one.
double find_unit(const Vector3d& v) {
  const double size = math::power_of_two_below(v.cwiseAbs().maxCoeff());
  const Vector3d scaled = v / size, back = scaled * size;
  return std::isfinite(size) && size > 0.0 && back == v ? size : 1.0;
}

/// A power of two near x, between 2^-1000 and 2^1000.
double nearest_power(double x) { return std::ldexp(1.0, std::clamp(std::ilogb(x), -1000, 1000)); }

/// Whether the attitude stands in a torque's formula, be it multiplied by a number that is 0.
bool names_attitude(const AnyTorque& torque) {
  const torques::Formula* formula = find_formula(torque);
  if (formula == nullptr) return traits(torque).uses_attitude;
  const formula::Program given = formula->given();
  return given.outputs.size() == 1 || formula::find_facts(given).uses_attitude;
}

/// R_WB^T v_W of a unit quaternion.
Vector to_body(const std::array<Interval, 4>& q, const Vector& v) {
  const Interval two(2.0), one(1.0);
  const auto& [x, y, z, w] = q;
  const Matrix R{{{one - two * (sqr(y) + sqr(z)), two * (x * y - w * z), two * (x * z + w * y)},
                  {two * (x * y + w * z), one - two * (sqr(x) + sqr(z)), two * (y * z - w * x)},
                  {two * (x * z - w * y), two * (y * z + w * x), one - two * (sqr(x) + sqr(y))}}};
  Vector seen;
  for (std::size_t i = 0; i < 3; ++i) seen[i] = R[0][i] * v[0] + R[1][i] * v[1] + R[2][i] * v[2];
  return seen;
}

}  // namespace

BodyEquations::BodyEquations(const Scene& scene) : scene_(scene), has_attitude_(scene.want().attitude) {
  for (const AnyTorque& torque : scene.torques()) torques_.push_back(drop_window(torque));
  by_formulas_ = needs_formula_system(torques_);
  if (by_formulas_) has_attitude_ = has_attitude_ || std::any_of(torques_.begin(), torques_.end(), names_attitude);
  else choose_vectors();
  choose_units();
  choose_state_units();
  attitude_ = orbit_index(orbits_.size());
}

void BodyEquations::choose_vectors() {
  const auto add = [](auto& list, const auto& item) {
    if (std::find(list.begin(), list.end(), item) == list.end()) list.push_back(item);
  };
  for (const AnyTorque& torque : torques_) {
    if (const auto* gravity = std::get_if<torques::Gravity>(&torque)) {
      if (gravity->weight() != 0.0 && !gravity->arm().isZero(0.0)) add(fixed_, Vector3d::UnitZ().eval());
    } else if (const auto* constant = std::get_if<torques::Constant>(&torque)) {
      if (is_in_space(*constant)) add(fixed_, Vector3d(constant->torque() / find_unit(constant->torque())));
    } else if (const auto* gradient = std::get_if<torques::GravityGradient>(&torque)) {
      if (gradient->mean_motion() != 0.0) add(orbits_, Orbit{gradient->mean_motion(), gradient->phase()});
    }
  }
  if (fixed_.size() > 2) fixed_ = {Vector3d::UnitX(), Vector3d::UnitY(), Vector3d::UnitZ()};
}

void BodyEquations::choose_units() {
  double damping = 0.0, fastest = scene_.omega().norm();
  const double least = scene_.inertia_B().moments().minCoeff();
  const auto take = [&](double torque) { fastest = std::max(fastest, std::sqrt(torque / least)); };
  for (const AnyTorque& torque : torques_) {
    if (const auto* constant = std::get_if<torques::Constant>(&torque)) take(constant->torque().norm());
    if (const auto* gravity = std::get_if<torques::Gravity>(&torque)) take(gravity->moment().norm());
    if (const auto* gradient = std::get_if<torques::GravityGradient>(&torque))
      fastest = std::max(fastest, std::abs(gradient->mean_motion()));
    if (const auto* brake = std::get_if<torques::Damping>(&torque))
      damping = std::max(damping, brake->matrix().cwiseAbs().maxCoeff() / least);
    if (const torques::Formula* formula = find_formula(torque)) {
      const Quat& q = scene_.attitude();
      const double attitude[4] = {q.x, q.y, q.z, q.w};
      Vector3d tau = Vector3d::Zero();
      formula->add({scene_.t0(), scene_.omega().data(), attitude, scene_.inertia_B().matrix()}, tau.data());
      if (tau.allFinite()) take(tau.norm());
    }
    if (const auto* angular = std::get_if<torques::AngularDamping>(&torque))
      damping = std::max(damping, std::abs(angular->rate()));
  }
  for (const Rotor& rotor : scene_.rotors())
    fastest = std::max(fastest, std::abs(rotor.compute_momentum(scene_.omega())) / least);
  if (fastest == 0.0) {   // at rest throughout: a radian over the span
    double span = 0.0;
    for (const double t : scene_.times()) span = std::max(span, std::abs(t - scene_.t0()));
    if (span > 0.0 && std::isfinite(span)) fastest = 1.0 / span;
  }
  if (fastest > 0.0 && std::isfinite(fastest)) rate_ = nearest_power(fastest);
  pace_ = damping > rate_ && std::isfinite(damping) ? nearest_power(damping) : rate_;
  if (by_formulas_)   // units are factors of forms there, whose products must not leave float64's range
    for (double* one : {&rate_, &pace_}) *one = std::clamp(*one, 0x1p-100, 0x1p100);
}

/// A state's size at the start, or what its rate makes of it in a radian.
void BodyEquations::choose_state_units() {
  state_units_ = formula::list_values(scene_.states());
  const Quat& q = scene_.attitude();
  const double attitude[4] = {q.x, q.y, q.z, q.w};
  const TorqueInput in{scene_.t0(), scene_.omega().data(), attitude, scene_.inertia_B().matrix()};
  for (const AnyTorque& torque : torques_) {
    const torques::Formula* formula = find_formula(torque);
    if (formula == nullptr || formula->states().empty()) continue;
    const std::vector<double> outputs = formula->compute(in, formula::list_values(formula->states()));
    std::size_t next = 3;
    for (const formula::Input& state : formula->states()) {   // a vector has one unit
      double size = 0.0;
      for (const double start : state.values)
        size = std::max({size, std::abs(start), std::abs(outputs[next++]) / pace_});
      const formula::Place place = formula::find_place(scene_.states(), state.name);
      const double unit = size > 0.0 && std::isfinite(size) ? std::clamp(nearest_power(size), 0x1p-100, 0x1p100) : 1.0;
      std::fill_n(state_units_.begin() + place.first, place.count, unit);
    }
  }
}

/// A formula's start is exact. That of a momentum was rounded, where the scene computed it from speeds.
std::vector<Interval> BodyEquations::enclose_states() const {
  const std::vector<double> given = formula::list_values(scene_.states());
  std::vector<Interval> states(given.begin(), given.end());
  const auto replace = [&](const std::string& name, std::size_t i, double rounded, const Interval& exact) {
    const std::size_t at = to_index(formula::find_place(scene_.states(), name).first) + i;
    if (given[at] == rounded) states[at] = exact;
  };
  for (const Rotor& rotor : scene_.rotors()) {
    if (!rotor.is_driven()) continue;
    replace(rotor.state(), 0, rotor.compute_start_momentum(scene_.omega()),
            enclose_start_momentum(rotor, scene_.omega()));
  }
  if (const std::optional<Damper>& damper = scene_.damper()) {
    const Vector3d rounded = damper->inertia() * (scene_.omega() + damper->rates());
    for (int i = 0; i < 3; ++i)
      replace(damper->state(), to_index(i), rounded[i],
              Interval(damper->inertia()) * (Interval(scene_.omega()[i]) + Interval(damper->rates()[i])));
  }
  for (std::size_t i = 0; i < states.size(); ++i) states[i] = states[i] * Interval(1.0 / state_units_[i]);
  return states;
}

std::vector<Interval> BodyEquations::start() const {
  std::vector<Interval> y(to_index(size()));
  const Interval to_units = Interval(1.0) / Interval(rate_);
  for (std::size_t i = 0; i < 3; ++i) y[i] = Interval(scene_.omega()[static_cast<int>(i)]) * to_units;
  const Quat& given = scene_.attitude();
  std::array<Interval, 4> q{Interval(given.x), Interval(given.y), Interval(given.z), Interval(given.w)};
  const Interval length = sqrt(sqr(q[0]) + sqr(q[1]) + sqr(q[2]) + sqr(q[3]));
  for (Interval& component : q) component = component / length;

  std::size_t at = 3;
  const auto add = [&](const Vector& v_W) {
    for (const Interval& component : to_body(q, v_W)) y[at++] = component;
  };
  for (const Vector3d& v : fixed_) add({Interval(v[0]), Interval(v[1]), Interval(v[2])});
  for (const Orbit& orbit : orbits_) {
    const auto [sine, cosine] = sincos(Interval(orbit.mean_motion) * Interval(scene_.t0()) + Interval(orbit.phase));
    add({cosine, sine, Interval()});
    add({-sine, cosine, Interval()});
  }
  if (has_attitude_) std::copy(q.begin(), q.end(), y.begin() + static_cast<std::ptrdiff_t>(at));
  const std::vector<Interval> states = enclose_states();
  std::copy(states.begin(), states.end(), y.begin() + first_own());
  return y;
}

/// Adds the terms of a body in units of 1 / rate, torque by torque. A torque with kernels needs its overload of add():
/// the compiler asks for it.
class BodyEquations::Maker {
 public:
  explicit Maker(const BodyEquations& body)
      : body_(body), system_(body.size()), per_rate_(Interval(1.0) / Interval(body.rate_)),
        part_(1.0 / nearest_power(body.scene_.inertia_B().matrix().cwiseAbs().maxCoeff())),
        I_(enclose_inertia(body.scene_, part_)), inverse_(invert(I_)),
        torque_unit_(Interval(part_) * per_rate_ * per_rate_) {}

  QuadraticSystem make(const std::vector<AnyTorque>& torques, const std::vector<bool>& rotating) {
    add_gyroscopic(0, Interval(-1.0));
    for (std::size_t i = 0; i < rotating.size(); ++i)
      if (rotating[i]) add_rotor(body_.scene_.rotors()[i]);
    for (const AnyTorque& torque : torques) std::visit([this](const auto& acting) { add(acting); }, torque);
    for (std::size_t i = 0; i < body_.fixed_.size(); ++i) add_rotation(body_.fixed_index(i));
    for (std::size_t i = 0; i < body_.orbits_.size(); ++i) add_orbit(i);
    if (body_.has_attitude_) add_attitude();
    return std::move(system_);
  }

  /// J^-1 times a momentum, in the unit of the rates
  Vector find_rates(const Vector& momentum) const {
    Vector rates;
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j)
        rates[i] = rates[i] + inverse_[i][j] * momentum[j] * Interval(part_) * per_rate_;
    return rates;
  }

 private:
  /// Calls use(row, factor) with what a torque about one axis gives to each component of w'.
  template <class Use>
  void accelerate(int axis, const Interval& torque, Use use) {
    for (int i = 0; i < 3; ++i) use(i, inverse_[to_index(i)][to_index(axis)] * torque);
  }
  void accelerate_by(int axis, const Interval& torque, int variable) {
    accelerate(axis, torque, [&](int row, const Interval& factor) { system_.add_variable(row, variable, factor); });
  }

  /// I^-1 (strength v x I v) for the variables v from `first`; w' of a free body with v = w and strength -1.
  void add_gyroscopic(int first, const Interval& strength) {
    const std::array<Matrix, 3> cross = enclose_products(I_);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        for (int l = j; l < 3; ++l) {
          const Interval& sum =
              cross[to_index(i)][to_index(j)][to_index(l)];
          accelerate(i, strength * sum, [&](int row, const Interval& factor) {
            system_.add_product(row, first + j, first + l, factor);
          });
        }
  }

  void add_rotor(const Rotor& rotor) {   // h x w
    const Vector h = enclose_momentum(rotor, body_.scene_.omega());
    for_permutations([&](int i, int j, int k, double s) {
      accelerate_by(i, Interval(s) * h[to_index(j)] * Interval(part_) * per_rate_, k);
    });
  }

  void add(const torques::Constant& constant) {
    const Vector3d& tau = constant.torque();
    const std::vector<Vector3d>& fixed = body_.fixed_;
    if (!is_in_space(constant)) {
      for (int axis = 0; axis < 3; ++axis)
        accelerate(axis, Interval(tau[axis]) * torque_unit_,
                   [&](int row, const Interval& factor) { system_.add_constant(row, factor); });
      return;
    }
    const double size = find_unit(tau);
    const auto direction = std::find(fixed.begin(), fixed.end(), Vector3d(tau / size));
    for (int axis = 0; axis < 3; ++axis) {
      if (direction != fixed.end()) {
        accelerate_by(axis, Interval(size) * torque_unit_,
                      body_.fixed_index(to_index(direction - fixed.begin())) + axis);
      } else {   // by its parts along the three axes of space
        for (int k = 0; k < 3; ++k)
          accelerate_by(axis, Interval(tau[k]) * torque_unit_, body_.fixed_index(to_index(k)) + axis);
      }
    }
  }

  void add(const torques::Gravity& gravity) {
    const auto vertical = std::find(body_.fixed_.begin(), body_.fixed_.end(), Vector3d::UnitZ().eval());
    if (vertical == body_.fixed_.end()) return;   // it has no moment
    const int first = body_.fixed_index(to_index(vertical - body_.fixed_.begin()));
    for_permutations([&](int i, int j, int k, double s) {   // m g e_z x r
      const Interval moment = Interval(-s) * Interval(gravity.weight()) * Interval(gravity.arm()[j]);
      accelerate_by(i, moment * torque_unit_, first + k);
    });
  }

  void add(const torques::Damping& damping) {
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        accelerate_by(i, -Interval(damping.matrix()(i, j)) * Interval(part_) * per_rate_, j);
  }

  void add(const torques::AngularDamping& damping) {
    for (int i = 0; i < 3; ++i) system_.add_variable(i, i, -Interval(damping.rate()) * per_rate_);
  }

  void add(const torques::GravityGradient& gradient) {
    const std::vector<Orbit>& orbits = body_.orbits_;
    const auto orbit = std::find(orbits.begin(), orbits.end(), Orbit{gradient.mean_motion(), gradient.phase()});
    if (orbit == orbits.end()) return;   // its mean motion is 0
    const Interval n = Interval(gradient.mean_motion()) * per_rate_;
    add_gyroscopic(body_.orbit_index(to_index(orbit - orbits.begin())), Interval(3.0) * n * n);
  }

  // Torques without kernels need a FormulaSystem, and pieces have no windows.
  template <class Torque>
  void add(const Torque&) requires(!torques::HasKernel<Torque>) {}

  /// v' = v x w of a vector fixed in space, as seen from the body
  void add_rotation(int first) {
    for_permutations([&](int i, int j, int k, double s) { system_.add_product(first + i, first + j, k, Interval(s)); });
  }

  void add_orbit(std::size_t orbit) {
    const int radial = body_.orbit_index(orbit), tangential = radial + 3;
    const Interval n = Interval(body_.orbits_[orbit].mean_motion) * per_rate_;
    add_rotation(radial), add_rotation(tangential);
    for (int i = 0; i < 3; ++i) {
      system_.add_variable(radial + i, tangential + i, n);
      system_.add_variable(tangential + i, radial + i, -n);
    }
  }

  void add_attitude() {   // q' = q (w, 0) / 2
    const int q = body_.attitude_;
    for_permutations([&](int i, int j, int k, double s) { system_.add_product(q + i, q + j, k, Interval(0.5 * s)); });
    for (int i = 0; i < 3; ++i) {
      system_.add_product(q + i, q + 3, i, Interval(0.5));
      system_.add_product(q + 3, q + i, i, Interval(-0.5));
    }
  }

  const BodyEquations& body_;
  QuadraticSystem system_;
  const Interval per_rate_;
  const double part_;    // I and every torque are divided by a power of two near I: no product of three overflows
  const Matrix I_, inverse_;
  const Interval torque_unit_;
};

std::vector<bool> BodyEquations::find_rotating(double begin, double end) const {
  std::vector<bool> rotating;
  for (const Rotor& rotor : scene_.rotors())
    rotating.push_back(begin < end ? rotor.rotates_throughout(begin, end) : rotor.rotates_at(begin));
  return rotating;
}

QuadraticSystem BodyEquations::make_system(const std::vector<AnyTorque>& torques, const std::vector<bool>& rotating,
                                           double sign) const {
  QuadraticSystem system = Maker(*this).make(torques, rotating);
  system.scale(sign * (rate_ / pace_));
  return system;
}

std::unique_ptr<TaylorStep> BodyEquations::make_step(const std::vector<AnyTorque>& torques,
                                                     const std::vector<bool>& rotating, double sign,
                                                     const StepSettings& settings) const {
  if (!by_formulas_) return std::make_unique<QuadraticStep>(make_system(torques, rotating, sign), settings);
  const FormulaEquations equations =
      make_formula_equations(scene_, torques, rotating, {rate_, pace_, sign, state_units_}, has_attitude_);
  return std::make_unique<FormulaStep>(differentiate(equations, equations.program), settings);
}

bool BodyEquations::has_switches(const std::vector<AnyTorque>& torques) const {
  return std::any_of(torques.begin(), torques.end(), [](const AnyTorque& torque) {
    const torques::Formula* formula = find_formula(torque);
    return formula != nullptr && formula->has_switches();
  });
}

std::unique_ptr<FormulaModes> BodyEquations::make_modes(const std::vector<AnyTorque>& torques,
                                                        const std::vector<bool>& rotating, double sign,
                                                        const StepSettings& settings) const {
  return std::make_unique<FormulaModes>(
      make_formula_equations(scene_, torques, rotating, {rate_, pace_, sign, state_units_}, has_attitude_), settings);
}

std::array<Interval, 3> BodyEquations::compute_jump(const std::vector<bool>& before,
                                                    const std::vector<bool>& after) const {
  Vector lost;   // momentum of rotors
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (before[i] == after[i]) continue;
    const Vector h = enclose_momentum(scene_.rotors()[i], scene_.omega());
    for (std::size_t k = 0; k < 3; ++k) lost[k] = before[i] ? lost[k] + h[k] : lost[k] - h[k];
  }
  return before == after ? lost : Maker(*this).find_rates(lost);
}

}  // namespace polhode::proof
