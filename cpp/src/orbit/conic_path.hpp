#pragma once

#include <utility>

#include "orbit/dd_vector.hpp"
#include "orbit/kepler.hpp"
#include "orbit/kepler_series.hpp"
#include "orbit/path.hpp"

namespace polhode {

/// A Kepler orbit on any conic; that of an ellipse may drift under the secular part of J2.
class ConicPath final : public Orbit::Path {
 public:
  ConicPath(double mu, const Vector3d& r0, const Vector3d& v0, double t0);
  explicit ConicPath(const OrbitElements& given);

  OrbitState at(math::DD t) const override;
  void expand(math::DD t, double unit, int order, double* rows) const override;
  std::vector<Eclipse> find_eclipses(const Vector3d& sun, double radius, double first, double last) const override;

  OrbitKind kind() const override;
  double mu() const override { return mu_; }
  double t0() const override { return t0_; }
  double e() const override { return conic_.e.hi; }
  double period() const override;
  double periapsis_distance() const override { return conic_.q.hi; }

 private:
  class Track;

  struct Angles {
    double inclination = 0.0, node = 0.0, periapsis = 0.0;
  };
  /// How the plane moves under the secular part of J2 [rad/s].
  struct Drift {
    double node = 0.0, periapsis = 0.0;
  };
  /// To the periapsis, and along the angular momentum.
  struct Axes {
    DDVector x, z;
  };

  bool is_closed() const { return conic_.alpha.hi > 0.0; }
  bool drifts() const { return drift_.node != 0.0 || drift_.periapsis != 0.0; }
  std::pair<Vector3d, Vector3d> find_axes(math::DD t) const;
  kepler::PlaneState find_state(math::DD t) const;
  void start(math::DD chi);
  bool meets_centre(math::DD n) const;
  std::pair<Vector3d, Vector3d> rotate_plane(double elapsed) const;
  Axes rotate_plane(math::DD elapsed) const;
  void set_drift(const OrbitElements& given);

  double mu_, t0_;
  kepler::Conic conic_{};
  Vector3d x_, z_;   ///< to the periapsis, and along the angular momentum
  Axes axes_;        ///< the same in double-double, at t0
  bool radial_ = false;
  Angles angles_ = {};
  Drift drift_ = {};
  double speed_up_ = 1.0;   ///< of the mean motion by J2
  math::DD since_periapsis_, revolution_, rate_;   ///< times sqrt(mu): of t0 from the periapsis, of a revolution
};

}  // namespace polhode
