#pragma once

#include <vector>

#include "orbit/dd_vector.hpp"
#include "polhode/orbit/orbit.hpp"

// The shadow of a body, a cylinder away from the sun: r.s < 0 and |r|^2 - (r.s)^2 < radius^2. Its edges are found along a
// path as roots of |r|^2 - (r.s)^2 - radius^2. Bounds of the path's slope and curvature say which intervals have none.
namespace polhode::shadow {

/// A position and its derivative by the parameter of the path.
template <class T>
struct Point {
  Triple<T> r, slope;
};

/// The largest |r| within an interval, and those of its first two derivatives by the parameter.
struct Sizes {
  double r, slope, curvature;
};

/// A path over a parameter that grows with time.
class Curve {
 public:
  virtual ~Curve() = default;
  virtual Point<double> at(double p) const = 0;
  virtual Point<math::DD> at(math::DD p) const = 0;
  virtual Sizes bound(double from, double to) const = 0;
  virtual math::DD time(math::DD p) const = 0;
};

/// The axis of the cylinder and its radius.
class Cylinder {
 public:
  /// @param sun  towards it, of any length
  Cylinder(const Vector3d& sun, double radius) : s_(normalize(to_dd(sun))), s_double_(round(s_)), radius_(radius) {}

  template <class T>
  const Triple<T>& sun() const {
    if constexpr (std::is_same_v<T, double>) return s_double_;
    else return s_;
  }
  double radius() const { return radius_; }

 private:
  DDVector s_;
  Triple<double> s_double_;
  double radius_;
};

bool is_dark(const Curve& curve, const Cylinder& cylinder, double p);

/// Where the path enters the shadow or leaves it.
struct Edge {
  math::DD p, t;
  bool enters;
};
void find_edges(const Curve& curve, const Cylinder& cylinder, double from, double to, std::vector<Edge>& edges);

/// The times between edges in the shadow.
std::vector<Eclipse> join(const std::vector<Edge>& edges, bool starts_dark, double first, double last);

}  // namespace polhode::shadow
