/// The second route of worlds_reference.py: the rates, the rotation matrix, position and velocity on the orbit and the
/// wheel's speed, by Gauss-Legendre collocation. Torques are written in body axes. One line "w R W" per sample.
/// options: longest step, stages s, nodes c (s), coefficients A (s x s).
#include "world.hpp"

namespace {

constexpr std::size_t kSize = 19;   // w, the rows of R, r, v, W

class Rates {
 public:
  World world;
  explicit Rates(World w) : world(std::move(w)), s_(static_cast<std::size_t>(world.options.at(1))) {
    const auto begin = world.options.begin() + 2;
    c_.assign(begin, begin + static_cast<long>(s_));
    a_.assign(begin + static_cast<long>(s_), world.options.end());
    if (a_.size() != s_ * s_) std::exit((std::fputs("wrong tableau\n", stderr), 1));
    for (std::size_t i = 0; i < s_; ++i) {
      Real weight = 1 / c_[i];
      for (std::size_t j = 0; j < s_; ++j)
        if (j != i) weight *= (1 - c_[j]) / (c_[i] - c_[j]);
      weights_.push_back(weight);
    }
  }

  State start() const {
    State y(kSize, 0);
    auto [x, e, z, w] = world.attitude;
    const Real size = sqrt(x * x + e * e + z * z + w * w);
    x /= size, e /= size, z /= size, w /= size;
    const Real R[9] = {1 - 2 * (e * e + z * z), 2 * (x * e - z * w), 2 * (x * z + e * w),
                       2 * (x * e + z * w), 1 - 2 * (x * x + z * z), 2 * (e * z - x * w),
                       2 * (x * z - e * w), 2 * (e * z + x * w), 1 - 2 * (x * x + e * e)};
    std::copy(world.omega.begin(), world.omega.end(), y.begin());
    std::copy(R, R + 9, y.begin() + 3);
    std::copy(world.r0.begin(), world.r0.end(), y.begin() + 12);
    std::copy(world.v0.begin(), world.v0.end(), y.begin() + 15);
    return y;
  }

  State rate(Real t, const State& y, Sides& s) const {
    s.begin(world.inertia > 0);
    const Vector w{y[0], y[1], y[2]}, &I = world.moments;
    Vector tau = torque(t, y, s), change;
    State d(kSize, 0);
    const Vector H = Vector{I[0] * w[0], I[1] * w[1], I[2] * w[2]} + (world.inertia * y[18]) * world.axis;
    tau = tau - cross(w, H);
    if (world.inertia > 0) {
      Real u = world.ramp * t;
      if (!s.is_positive(world.max_torque - u)) u = world.max_torque;
      change = drive(tau, u, y[18], s, d[18]);
    } else {
      change = {tau[0] / I[0], tau[1] / I[1], tau[2] / I[2]};
    }
    std::copy(change.begin(), change.end(), d.begin());
    for (std::size_t row = 0; row < 3; ++row)   // R' = R [w]x
      for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
        d[3 + 3 * row + i] = y[3 + 3 * row + j] * w[k] - y[3 + 3 * row + k] * w[j];
      }
    if (world.mu == 0) return d;
    const Vector r{y[12], y[13], y[14]};
    const Real distance = sqrt(dot(r, r)), pull = -world.mu / (distance * distance * distance);
    for (std::size_t i = 0; i < 3; ++i) d[12 + i] = y[15 + i], d[15 + i] = pull * r[i];
    return d;
  }

  void changed(State& y, Sides& s) const {
    if (s.wheel == Wheel::kSliding) {
      s.speed = y[18], s.wheel = Wheel::kTop;
      return;
    }
    s.needed = s.needed > 0 ? 1 : -1, s.wheel = Wheel::kSliding;
  }

  std::vector<Real> output(Real, const State& y, Sides&) const {
    std::vector<Real> row(y.begin(), y.begin() + 12);
    if (world.inertia > 0) row.push_back(y[18]);
    return row;
  }

  bool step(Real t, State& y, Real h, Sides& sides) const {
    std::vector<State> increment(s_, State(kSize, 0)), f(s_);
    const State first = rate(t, y, sides);
    for (State& row : f) row = first;
    Real change = 1, before = 2;
    int rounds = 0;
    for (; rounds < 100 && (change > Real(1e-20L) || change < before / 2); ++rounds) {
      before = change, change = 0;
      for (std::size_t i = 0; i < s_; ++i) {
        State stage = y;
        for (std::size_t m = 0; m < kSize; ++m) {
          Real sum = 0;
          for (std::size_t j = 0; j < s_; ++j) sum += a_[i * s_ + j] * f[j][m];
          change = std::max(change, absolute(h * sum - increment[i][m]) / (absolute(y[m]) + 1));
          increment[i][m] = h * sum, stage[m] += h * sum;
        }
        f[i] = rate(t + c_[i] * h, stage, sides);
      }
    }
    if (rounds == 100) return false;
    for (std::size_t i = 0; i < s_; ++i)
      for (std::size_t m = 0; m < kSize; ++m) y[m] += weights_[i] * increment[i][m];
    return true;
  }

 private:
  /// w' and W' of body and wheel, where tau has the gyroscopic part.
  Vector drive(const Vector& tau, Real u, Real speed, Sides& s, Real& faster) const {
    const Vector &J = world.moments, &a = world.axis;
    const Vector locked{tau[0] / J[0], tau[1] / J[1], tau[2] / J[2]};
    Real effort = u - world.viscous * speed;
    if (s.wheel != Wheel::kSliding) {
      const Real excess = effort - world.inertia * dot(a, locked);
      if (s.wheel == Wheel::kStuck) s.needed = excess, s.note_mode(world.coulomb - absolute(excess));
      else s.note_mode((speed > 0 ? excess : -excess) - world.coulomb);
      return locked;
    }
    effort -= world.coulomb * s.needed;
    s.note_mode(world.max_speed - absolute(speed));
    // Rows of J w' + Ji W' a = tau and Ji (a.w' + W') = effort: W' eliminated, Cramer's rule.
    Vector m[3];
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t k = 0; k < 3; ++k) m[i][k] = (i == k ? J[i] : Real(0)) - world.inertia * a[i] * a[k];
    const Vector b = tau - effort * a, yz = cross(m[1], m[2]);
    const Real whole = dot(m[0], yz);
    const Vector zx = cross(m[2], m[0]), xy = cross(m[0], m[1]);
    const Vector turn = (1 / whole) * (b[0] * yz + b[1] * zx + b[2] * xy);   // m is symmetric
    faster = effort / world.inertia - dot(a, turn);
    return turn;
  }

  Vector torque(Real t, const State& y, Sides& s) const {
    if (world.mu == 0) return {0, 0, 0};
    const auto to_body = [&](const Vector& x) {
      return Vector{y[3] * x[0] + y[6] * x[1] + y[9] * x[2], y[4] * x[0] + y[7] * x[1] + y[10] * x[2],
                    y[5] * x[0] + y[8] * x[1] + y[11] * x[2]};
    };
    const Vector r{y[12], y[13], y[14]}, v{y[15], y[16], y[17]}, &I = world.moments;
    const Real distance = sqrt(dot(r, r));
    const Vector up = to_body((1 / distance) * r);
    const Real n2 = world.mu / (distance * distance * distance);
    Vector tau{3 * n2 * (I[2] - I[1]) * up[1] * up[2], 3 * n2 * (I[0] - I[2]) * up[2] * up[0],
               3 * n2 * (I[1] - I[0]) * up[0] * up[1]};
    if (world.strength != 0) {
      const Real turn = world.phase + t * world.field_spin;
      const Vector pole = to_body({sin(world.tilt) * cos(turn), sin(world.tilt) * sin(turn), cos(world.tilt)});
      const Real k = world.strength / (distance * distance * distance);
      tau = tau + cross(world.moment, (3 * k * dot(pole, up)) * up - k * pole);
    }
    if (!world.air.empty()) {
      const Vector flow = to_body(v - cross({0, 0, world.air_spin}, r));
      const Real thin = exp((world.height_radius - distance) / world.scale_height);
      for (const Plate& plate : world.air) {
        const Real met = dot(plate.normal, flow);
        if (s.is_positive(met)) tau = tau - (Real(0.5L) * world.coefficient * world.density * thin * plate.area * met) *
                                                cross(plate.centre, flow);
      }
    }
    if (world.light.empty()) return tau;
    bool is_lit = true;
    if (world.shadow > 0) {
      const Real ahead = dot(r, world.sun);
      const Vector aside = r - ahead * world.sun;
      const bool is_ahead = s.is_positive(ahead, true);
      const bool is_aside = s.is_positive(dot(aside, aside) - world.shadow * world.shadow, true);
      is_lit = is_ahead || is_aside;
    }
    const Vector sun = to_body(world.sun);
    for (const Plate& plate : world.light) {
      const Real c = dot(plate.normal, sun);
      if (!s.is_positive(c) || !is_lit) continue;
      const Vector along = (1 - plate.specular) * cross(plate.centre, sun);
      const Vector across = (2 * plate.specular * c + 2 * plate.diffuse / 3) * cross(plate.centre, plate.normal);
      tau = tau - (world.pressure * plate.area * c) * (along + across);
    }
    return tau;
  }

  std::size_t s_;
  std::vector<Real> c_, a_, weights_;
};

}  // namespace

int main() {
  const Rates route(World::read());
  run(route, route.world.options[0]);
}
