#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "polhode/math/detail/double_double.hpp"
#include "polhode/solve/closed_form.hpp"
#include "solve/closed_form_parts.hpp"
#include "solve/distance.hpp"
#include "solve/proportional_damping.hpp"

namespace polhode {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double unit_roundoff = epsilon / 2;
constexpr double nudge = 0x1p-46;   // relative change of an input, to measure its effect
constexpr std::size_t most_compared = 16;   // times at which two motions are compared
const Vector3d signs{1, -1, 1};

/// Measures how far a closed form moves when its inputs do.
class InputError {
 public:
  InputError(const Scene& scene, const Facts& facts, std::string_view model)
      : scene_(scene), facts_(facts), h_(facts.rotor_momentum) {
    if (facts.is_free()) return;
    if (!facts.torques.rotors) damping_ = find_proportional_damping(scene);
    if (damping_ || model == "gyrostat") return;
    gravity_ = find_only_gravity(scene);
    if (model == "pendulum") return;
    axis_ = *find_top_axis(scene, gravity_->arm());
    weight_arm_ = gravity_->weight() * gravity_->arm()[axis_];
  }

  /// Of times from the start, which are differences.
  double measure_times() const {
    bool rounded = false;
    for (const double t : scene_.times()) rounded |= math::two_diff(t, scene_.t0()).lo != 0.0;
    if (!rounded) return 0.0;
    return unit_roundoff * (damping_ ? measure_damped_span() : 2 * std::numbers::pi * facts_.turns);
  }

  /// The closed forms that the measures below make. One next to a birth (measure_birth) makes two more.
  int count_set_ups() const {
    int count = (weight_is_rounded() ? 1 : 0) + (damping_is_rounded() ? 2 : 0) + (inertia_is_rounded() ? 2 : 0);
    if (!facts_.torques.rotors) return count;
    const Vector3d lost = find_lost_momentum();
    for (int i = 0; i < 3; ++i) count += lost[i] != 0.0;
    return count;
  }

  /// Of weight times arm.
  double measure_weight(const ClosedForm& form) const {
    if (!weight_is_rounded()) return 0.0;
    const HeavyTop other(scene_.inertia_B(), weight_arm_ * (1 + nudge), scene_.omega(), scene_.attitude(), h_[axis_]);
    return 4 * (unit_roundoff / nudge) * compare(form, ClosedForm(other));
  }

  /// Of a damping matrix. Together all torques differ from -c I omega by half a unit of the momentum that they take.
  double measure_damping() const {
    if (!damping_is_rounded()) return 0.0;
    const auto kicked = [&](double sign) {
      return make(scene_.inertia_B(), scene_.omega().cwiseProduct(Vector3d::Ones() + sign * nudge * signs), h_);
    };
    return 2 * (unit_roundoff / nudge) * compare(kicked(1), kicked(-1));
  }

  /// Of the sum of the rotors' momenta.
  double measure_rotors(const ClosedForm& form) const {
    if (!facts_.torques.rotors) return 0.0;
    const Vector3d lost = find_lost_momentum();
    const double part = lost.maxCoeff() / h_.cwiseAbs().maxCoeff();
    if (part == 0.0) return 0.0;
    double error = 0.0;   // one component may undo what another does: each is changed alone
    for (int i = 0; i < 3; ++i) {
      if (lost[i] == 0.0) continue;
      Vector3d h = h_;
      h[i] += (nudge / part) * lost[i];
      error += 2 * (part / nudge) * compare(form, make(scene_.inertia_B(), scene_.omega(), h));
    }
    return error;
  }

  /// Of the rates across the axis of a top with a rotor: they come from a plain top that rotates faster by h / C, and
  /// have its rounding. Measured: 0.06 units of the faster rate.
  double measure_turning(const ClosedForm& form) const {
    if (axis_ < 0 || h_[axis_] == 0.0) return 0.0;
    const double added = std::abs(h_[axis_]) / scene_.inertia_B().matrix()(axis_, axis_), largest = find_largest(form);
    return largest > 0.0 ? epsilon * added / largest : 0.0;
  }

  /// Of the rates of a heavy body next to rest. They have the rounding of the largest that its weight may give it, where
  /// the centre of mass is lowest. Measured: 0.4 units of that.
  double measure_slow_rates(const ClosedForm& form) const {
    if (gravity_ == nullptr) return 0.0;
    const Vector3d& arm = gravity_->arm();
    const double height = (to_matrix(scene_.attitude()) * arm)[2] / arm.norm();
    const double fall = std::max(0.0, 1.0 + (gravity_->weight() < 0.0 ? -height : height));
    const double start = scene_.omega().norm();
    const double reached = math::hypot(start, form.swing_frequency() * std::sqrt(2.0 * fall));
    if (!(reached > 2.0 * start)) return 0.0;
    const double largest = find_largest(form);
    return largest > 0.0 && largest < reached ? 4 * epsilon * (reached / largest - 1) : 0.0;
  }

  /// Of all inputs, where a gyrostat starts next to a steady turn that is born together with its saddle. There the
  /// closed form is only as good as its inputs (docs/gyrostat.md). The period tells: it is many revolutions long.
  double measure_birth(const ClosedForm& form) const {
    constexpr double many = 100.0;
    const Gyrostat* gyrostat = form.gyrostat();
    if (gyrostat == nullptr) return 0.0;
    const double turns = gyrostat->period() * scene_.omega().norm() / (2 * std::numbers::pi);
    if (!(turns > many) || std::isinf(turns)) return 0.0;
    const auto moved = [&](double sign) {
      const Vector3d up = Vector3d::Ones() + sign * nudge * signs, down = Vector3d::Ones() - sign * nudge * signs;
      return make(scene_.inertia_B(), scene_.omega().cwiseProduct(up), h_.cwiseProduct(down));
    };
    return 4 * (unit_roundoff / nudge) * compare(moved(1), moved(-1));
  }

  /// Of the rates of a gyrostat, whose two series cancel next to such a birth: the energy of a period shows it.
  double measure_energy(const ClosedForm& form) const {
    constexpr std::size_t count = 129;
    const Gyrostat* gyrostat = form.gyrostat();
    if (gyrostat == nullptr || gyrostat->energy() == 0.0) return 0.0;
    const double whole = facts_.span(), period = gyrostat->period();
    const double span = period > 0.0 && period < whole ? period : whole;
    double t[count], omega[3 * count], largest = 0.0;
    for (std::size_t i = 0; i < count; ++i) t[i] = span * static_cast<double>(i) / (count - 1) - facts_.before;
    form.at(t, count, omega, nullptr);
    for (std::size_t i = 0; i < count; ++i) {
      const Vector3d w{omega[3 * i], omega[3 * i + 1], omega[3 * i + 2]};
      const double energy = 0.5 * w.dot(scene_.inertia_B().matrix() * w);
      largest = std::max(largest, std::abs(energy / gyrostat->energy() - 1.0));
    }
    return 4 * std::max(0.0, largest - 16 * epsilon);
  }

  /// Of the inertia: the principal moments and axes of a full tensor have errors of a few units of rounding of the
  /// largest moment, and so has the inertia that free rotors leave.
  double measure_inertia() const {
    if (!inertia_is_rounded()) return 0.0;
    const double largest = scene_.given_inertia_B().moments()[2];
    const PrincipalAxes& principal = scene_.inertia_B().principal();
    const auto perturbed = [&](double sign) {
      if (axis_ >= 0) {   // two moments stay equal
        Vector3d I = scene_.inertia_B().matrix().diagonal() + sign * nudge * largest * Vector3d::Ones();
        I[axis_] -= 2 * sign * nudge * largest;
        return make(InertiaTensor::from_moments(I, false), scene_.omega(), h_);
      }
      const Vector3d I = principal.moments + sign * nudge * largest * signs;
      return make(InertiaTensor::from_moments(I, false), principal.axes.transpose() * scene_.omega(),
                  principal.axes.transpose() * h_);
    };
    return 8 * (epsilon / nudge) * compare(perturbed(1), perturbed(-1));
  }

 private:
  bool weight_is_rounded() const {
    return axis_ >= 0 && std::fma(gravity_->weight(), gravity_->arm()[axis_], -weight_arm_) != 0.0;
  }
  bool damping_is_rounded() const { return damping_ && damping_->rounded; }
  bool inertia_is_rounded() const {
    return (!scene_.inertia_B().is_diagonal() || has_carrier(scene_)) && !scene_.omega().isZero(0.0);
  }

  /// The most that rounding takes from the sum of the rotors' momenta.
  Vector3d find_lost_momentum() const {
    math::DD sum[3] = {};
    Vector3d lost = Vector3d::Zero();
    for (const Rotor& rotor : scene_.rotors()) {
      const double momentum = rotor.compute_momentum(scene_.omega());
      const bool skew = rotor.axis().cwiseAbs().maxCoeff() < 1.0;   // its axis was rounded to length 1
      const double roundings = (rotor.momentum() ? 0.0 : rotor.free() ? 4.0 : 1.0) + (skew ? 2.0 : 0.0);
      for (int i = 0; i < 3; ++i) {
        sum[i] = sum[i] + math::DD(math::two_prod(momentum, rotor.axis()[i]));
        lost[i] += roundings * unit_roundoff * std::abs(momentum * rotor.axis()[i]);
      }
    }
    for (int i = 0; i < 3; ++i) lost[i] += std::abs((sum[i] - math::DD(h_[i])).hi);
    return lost;
  }

  /// The closed form of the scene from other inputs.
  ClosedForm make(const InertiaTensor& inertia, const Vector3d& omega, const Vector3d& h) const {
    if (damping_) return ClosedForm(DampedFree(inertia, damping_->rate, omega));
    if (axis_ >= 0) return ClosedForm(HeavyTop(inertia, weight_arm_, omega, scene_.attitude(), h[axis_]));
    if (facts_.torques.rotors) return ClosedForm(Gyrostat(inertia, h, omega, scene_.attitude()));
    return ClosedForm(FreeMotion(inertia, omega));
  }

  /// The largest distance of two closed forms at sixteen of the scene's times.
  double compare(const ClosedForm& a, const ClosedForm& b) const {
    const std::vector<double>& times = scene_.times();
    const std::size_t n = std::min(most_compared, times.size());
    double t[most_compared], wa[3 * most_compared], wb[3 * most_compared], qa[4 * most_compared], qb[4 * most_compared];
    // The last time, and evenly spread times before it.
    for (std::size_t i = 0; i < n; ++i) t[i] = times[times.size() - 1 - i * ((times.size() - 1) / n)] - scene_.t0();
    a.at(t, n, wa, qa);
    b.at(t, n, wb, qb);
    return compute_distance(n, scene_.omega().norm(), wa, qa, wb, qb);
  }

  /// The largest rate of the start and of some samples.
  double find_largest(const ClosedForm& form) const {
    const std::vector<double>& times = scene_.times();
    double largest = scene_.omega().norm();
    for (std::size_t i = 0; i < times.size(); i += 1 + times.size() / most_compared) {
      const double t = times[i] - scene_.t0();
      Vector3d w;
      form.at(&t, 1, w.data(), nullptr);
      largest = std::max(largest, w.norm());
    }
    return largest;
  }

  /// The change of a damped motion when the times change by a part of themselves, in units of this part.
  double measure_damped_span() const {
    const DampedFree motion(scene_.inertia_B(), damping_->rate, scene_.omega());
    const double slowed = std::max(motion.slowed_time(facts_.after), -motion.slowed_time(-facts_.before));
    const double grown = std::abs(damping_->rate) * facts_.span();
    return scene_.omega().norm() * slowed * (1 + grown) + grown;
  }

  const Scene& scene_;
  const Facts& facts_;
  const Vector3d& h_;
  std::optional<ProportionalDamping> damping_;
  const torques::Gravity* gravity_ = nullptr;
  int axis_ = -1;   // of symmetry of a top
  double weight_arm_ = 0.0;
};

}  // namespace

double compute_closed_form_error(const Scene& scene, const Facts& facts, const ClosedForm& form) {
  const InputError inputs(scene, facts, form.model());
  double error = 20 * epsilon;
  if (scene.t0() != 0.0) error += inputs.measure_times();
  error += inputs.measure_slow_rates(form);
  if (form.model() == "pendulum") return error;   // the product of weight and arm is a double-double there
  return error + inputs.measure_weight(form) + inputs.measure_damping() + inputs.measure_rotors(form) +
         inputs.measure_inertia() + inputs.measure_birth(form) +
         inputs.measure_energy(form) + inputs.measure_turning(form);
}

int count_error_set_ups(const Scene& scene, const Facts& facts, std::string_view model) {
  return model == "pendulum" ? 0 : InputError(scene, facts, model).count_set_ups();
}

}  // namespace polhode
