#pragma once

#include <vector>

#include "polhode/math/detail/interval.hpp"
#include "polhode/scene/scene.hpp"

// A body's motion as y' = c + L y + Q(y, y), with constants that are intervals. Time runs in units of 1 / rate().
namespace polhode::proof {

using math::Interval;

/// A term of one component of y': a constant times 1, a variable, or a product of two variables.
struct Term {
  enum class Kind { constant, variable, product };
  int row;
  Kind kind;
  int source;            ///< which variable or product
  Interval factor;
};

struct Product {
  int a, b;              ///< the variables
};

/// The right-hand side while the same torques act.
struct QuadraticSystem {
  int size = 0;          ///< variables
  int passive = 0;       ///< the last so many are seen by no other: the quaternion
  std::vector<Product> products = {};
  std::vector<Term> terms = {};
};

/// The variables of a scene: w_B / rate, vectors fixed in space and the radial and tangential vectors of orbits as seen
/// from the body, and the quaternion where it is wanted. They are the same in every piece of the span.
class Variables {
 public:
  explicit Variables(const Scene& scene);

  int size() const { return attitude_ + (has_attitude_ ? 4 : 0); }
  int attitude() const { return attitude_; }           ///< index of the quaternion's first component
  bool has_attitude() const { return has_attitude_; }
  double rate() const { return rate_; }                ///< a power of two [rad/s]

  /// The exact start. The attitude is normalised as real numbers are.
  std::vector<Interval> start() const;

  /// The equations under these torques, none of them with windows; `sign` is -1 backwards in time.
  QuadraticSystem equations(const std::vector<AnyTorque>& torques, double sign) const;

 private:
  struct Orbit {
    double mean_motion, phase;
    friend bool operator==(const Orbit&, const Orbit&) = default;
  };

  void choose_vectors();
  void choose_rate();
  int orbit_index(std::size_t orbit) const { return 3 + 3 * static_cast<int>(fixed_.size() + 2 * orbit); }

  Scene scene_;
  std::vector<AnyTorque> torques_ = {};    ///< without their windows
  std::vector<Vector3d> fixed_ = {};       ///< directions in space
  std::vector<Orbit> orbits_ = {};
  double rate_ = 1.0;
  int attitude_ = 3;
  bool has_attitude_ = false;
};

}  // namespace polhode::proof
