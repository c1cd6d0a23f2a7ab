#include "solve/proof/quadratic_system.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "polhode/math/detail/number.hpp"

namespace polhode::proof {
namespace {

using Kind = Term::Kind;
using Vector = std::array<Interval, 3>;
using Matrix = std::array<Vector, 3>;   // by rows

/// Collects terms. A product of two variables is formed once, whatever the number of components that hold it.
class Builder {
 public:
  explicit Builder(int size) { system_.size = size; }

  void add_constant(int row, const Interval& factor) { add({row, Kind::constant, 0, factor}); }
  void add_variable(int row, int variable, const Interval& factor) { add({row, Kind::variable, variable, factor}); }
  void add_product(int row, int a, int b, const Interval& factor) {
    if (factor.is_zero()) return;
    if (a > b) std::swap(a, b);
    auto& products = system_.products;
    auto at = std::find_if(products.begin(), products.end(), [&](const Product& p) { return p.a == a && p.b == b; });
    if (at == products.end()) at = products.insert(at, {a, b});
    add({row, Kind::product, static_cast<int>(at - products.begin()), factor});
  }

  QuadraticSystem finish(int passive, double sign) {
    system_.passive = passive;
    for (Term& term : system_.terms) term.factor = Interval(sign) * term.factor;
    return std::move(system_);
  }

 private:
  void add(const Term& term) {
    if (term.factor.is_zero()) return;
    for (Term& there : system_.terms) {
      if (there.row != term.row || there.kind != term.kind || there.source != term.source) continue;
      there.factor = there.factor + term.factor;
      return;
    }
    system_.terms.push_back(term);
  }

  QuadraticSystem system_;
};

Matrix make_matrix(const Matrix3d& m, double scale) {
  Matrix result;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) result[i][j] = Interval(m(i, j)) * Interval(scale);
  return result;
}

Matrix invert(const Matrix& m) {
  Matrix inverse;
  if (m[0][1].is_zero() && m[0][2].is_zero() && m[1][2].is_zero()) {
    for (std::size_t i = 0; i < 3; ++i) inverse[i][i] = Interval(1.0) / m[i][i];
    return inverse;
  }
  const auto minor = [&](std::size_t i, std::size_t j) {   // of row j and column i, signed
    const std::size_t a = (j + 1) % 3, b = (j + 2) % 3, c = (i + 1) % 3, d = (i + 2) % 3;
    return m[a][c] * m[b][d] - m[a][d] * m[b][c];
  };
  const Interval determinant = m[0][0] * minor(0, 0) + m[0][1] * minor(1, 0) + m[0][2] * minor(2, 0);
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) inverse[i][j] = minor(i, j) / determinant;
  return inverse;
}

/// Calls use(i, j, k, sign) for the six entries of the permutation symbol.
template <class Use>
void for_permutations(Use use) {
  for (int i = 0; i < 3; ++i) {
    use(i, (i + 1) % 3, (i + 2) % 3, 1.0);
    use(i, (i + 2) % 3, (i + 1) % 3, -1.0);
  }
}

AnyTorque drop_window(const AnyTorque& torque) {
  const auto* during = std::get_if<torques::During>(&torque);
  return during == nullptr ? torque : std::visit([](const auto& lasting) { return AnyTorque(lasting); }, during->torque());
}

bool is_in_space(const torques::Constant& constant) {
  return constant.frame() == torques::Constant::Frame::space && !constant.traits().vanishes;
}

/// A power of two near x, between 2^-1000 and 2^1000.
double nearest_power(double x) { return std::ldexp(1.0, std::clamp(std::ilogb(x), -1000, 1000)); }

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

Variables::Variables(const Scene& scene) : scene_(scene), has_attitude_(scene.want().attitude) {
  for (const AnyTorque& torque : scene.torques()) torques_.push_back(drop_window(torque));
  choose_vectors();
  choose_rate();
  attitude_ = orbit_index(orbits_.size());
}

void Variables::choose_vectors() {
  const auto add = [this](const Vector3d& direction) {
    if (std::find(fixed_.begin(), fixed_.end(), direction) == fixed_.end()) fixed_.push_back(direction);
  };
  for (const AnyTorque& torque : torques_) {
    if (const auto* gravity = std::get_if<torques::Gravity>(&torque)) {
      if (gravity->weight() != 0.0 && !gravity->arm().isZero(0.0)) add(Vector3d::UnitZ());
    } else if (const auto* constant = std::get_if<torques::Constant>(&torque)) {
      if (!is_in_space(*constant)) continue;
      const Vector3d& tau = constant->torque();
      add(tau / math::power_of_two_below(tau.cwiseAbs().maxCoeff()));
    } else if (const auto* gradient = std::get_if<torques::GravityGradient>(&torque)) {
      const Orbit orbit{gradient->mean_motion(), gradient->phase()};
      if (orbit.mean_motion != 0.0 && std::find(orbits_.begin(), orbits_.end(), orbit) == orbits_.end())
        orbits_.push_back(orbit);
    }
  }
  if (fixed_.size() > 2) fixed_ = {Vector3d::UnitX(), Vector3d::UnitY(), Vector3d::UnitZ()};
}

void Variables::choose_rate() {
  double fastest = scene_.omega().norm();
  const double least = scene_.inertia_B().moments().minCoeff();
  const auto take = [&](double torque) { fastest = std::max(fastest, std::sqrt(torque / least)); };
  for (const AnyTorque& torque : torques_) {
    if (const auto* constant = std::get_if<torques::Constant>(&torque)) take(constant->torque().norm());
    if (const auto* gravity = std::get_if<torques::Gravity>(&torque)) take(gravity->moment().norm());
    if (const auto* gradient = std::get_if<torques::GravityGradient>(&torque))
      fastest = std::max(fastest, std::abs(gradient->mean_motion()));
  }
  if (fastest > 0.0 && std::isfinite(fastest)) rate_ = nearest_power(fastest);
}

std::vector<Interval> Variables::start() const {
  std::vector<Interval> y(static_cast<std::size_t>(size()));
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
  return y;
}

QuadraticSystem Variables::equations(const std::vector<AnyTorque>& torques, double sign) const {
  Builder build(size());
  // I and every torque are divided by a power of two near I, so that no product of three entries overflows.
  const double part = 1.0 / nearest_power(scene_.inertia_B().matrix().cwiseAbs().maxCoeff());
  const Matrix I = make_matrix(scene_.inertia_B().matrix(), part), inverse = invert(I);
  const Interval per_rate = Interval(1.0) / Interval(rate_);
  const auto accelerate = [&](int axis, const Interval& torque, auto add) {
    for (int i = 0; i < 3; ++i) add(i, inverse[static_cast<std::size_t>(i)][static_cast<std::size_t>(axis)] * torque);
  };
  const auto entry = [&](int i, int j) { return I[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)]; };
  /// strength times v x (I v), for the variables v from `first`
  const auto add_gyroscopic = [&](int first, const Interval& strength) {
    std::array<Matrix, 3> cross = {};   // of the products v_j v_l, j <= l, collected before they are multiplied
    for_permutations([&](int i, int j, int k, double s) {
      for (int l = 0; l < 3; ++l) {
        auto& sum = cross[static_cast<std::size_t>(i)][static_cast<std::size_t>(std::min(j, l))]
                         [static_cast<std::size_t>(std::max(j, l))];
        sum = sum + Interval(s) * entry(k, l);
      }
    });
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        for (int l = j; l < 3; ++l) {
          const Interval& sum = cross[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)][static_cast<std::size_t>(l)];
          accelerate(i, strength * sum,
                     [&](int row, const Interval& f) { build.add_product(row, first + j, first + l, f); });
        }
  };
  add_gyroscopic(0, Interval(-1.0));

  const Interval torque_unit = Interval(part) * per_rate * per_rate;
  for (const AnyTorque& torque : torques) {
    if (const auto* constant = std::get_if<torques::Constant>(&torque)) {
      const Vector3d& tau = constant->torque();
      const bool in_space = is_in_space(*constant);
      const double size = in_space ? math::power_of_two_below(tau.cwiseAbs().maxCoeff()) : 1.0;
      const auto direction = in_space ? std::find(fixed_.begin(), fixed_.end(), Vector3d(tau / size)) : fixed_.end();
      for (int axis = 0; axis < 3; ++axis) {
        if (!in_space) {
          accelerate(axis, Interval(tau[axis]) * torque_unit,
                     [&](int row, const Interval& f) { build.add_constant(row, f); });
        } else if (direction != fixed_.end()) {
          const int first = 3 + 3 * static_cast<int>(direction - fixed_.begin());
          accelerate(axis, Interval(size) * torque_unit,
                     [&](int row, const Interval& f) { build.add_variable(row, first + axis, f); });
        } else {   // by its parts along the three axes of space
          for (int k = 0; k < 3; ++k) {
            accelerate(axis, Interval(tau[k]) * torque_unit,
                       [&](int row, const Interval& f) { build.add_variable(row, 3 + 3 * k + axis, f); });
          }
        }
      }
    } else if (const auto* gravity = std::get_if<torques::Gravity>(&torque)) {
      const auto vertical = std::find(fixed_.begin(), fixed_.end(), Vector3d::UnitZ().eval());
      if (vertical == fixed_.end()) continue;   // it has no moment
      const int first = 3 + 3 * static_cast<int>(vertical - fixed_.begin());
      for_permutations([&](int i, int j, int k, double s) {
        const Interval moment = Interval(gravity->weight()) * Interval(gravity->arm()[j]) * Interval(-s) * torque_unit;
        accelerate(i, moment, [&](int row, const Interval& f) { build.add_variable(row, first + k, f); });
      });
    } else if (const auto* damping = std::get_if<torques::Damping>(&torque)) {
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          accelerate(i, -Interval(damping->matrix()(i, j)) * Interval(part) * per_rate,
                     [&](int row, const Interval& f) { build.add_variable(row, j, f); });
    } else if (const auto* gradient = std::get_if<torques::GravityGradient>(&torque)) {
      const auto orbit = std::find(orbits_.begin(), orbits_.end(), Orbit{gradient->mean_motion(), gradient->phase()});
      if (orbit == orbits_.end()) continue;
      const Interval n = Interval(gradient->mean_motion()) * per_rate;
      add_gyroscopic(orbit_index(static_cast<std::size_t>(orbit - orbits_.begin())), Interval(3.0) * n * n);
    }
  }

  const auto add_turning = [&](int first) {   // v' = v x w
    for_permutations([&](int i, int j, int k, double s) { build.add_product(first + i, first + j, k, Interval(s)); });
  };
  for (std::size_t i = 0; i < fixed_.size(); ++i) add_turning(3 + 3 * static_cast<int>(i));
  for (std::size_t k = 0; k < orbits_.size(); ++k) {
    const int radial = orbit_index(k), tangential = radial + 3;
    const Interval n = Interval(orbits_[k].mean_motion) * per_rate;
    add_turning(radial), add_turning(tangential);
    for (int i = 0; i < 3; ++i) {
      build.add_variable(radial + i, tangential + i, n);
      build.add_variable(tangential + i, radial + i, -n);
    }
  }
  if (has_attitude_) {   // q' = q (w, 0) / 2
    const Interval half(0.5);
    const int q = attitude_;
    for_permutations([&](int i, int j, int k, double s) { build.add_product(q + i, q + j, k, Interval(0.5 * s)); });
    for (int i = 0; i < 3; ++i) {
      build.add_product(q + i, q + 3, i, half);
      build.add_product(q + 3, q + i, i, -half);
    }
  }
  return build.finish(has_attitude_ ? 4 : 0, sign);
}

}  // namespace polhode::proof
