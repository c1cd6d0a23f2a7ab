#include "solve/effect/theorems.hpp"

#include <algorithm>
#include <cmath>

#include "polhode/math/detail/functions.hpp"
#include "solve/effect/norms.hpp"

namespace polhode::effect {
namespace {

Bounds refuse(const char* why) { return {.refusal = why}; }

/// The rotation vector a = Theta to first order becomes an angle rho with rho <= Theta + sigma (rho/2 + 0.085 rho^2),
/// sigma = T max |dw|. @return HUGE_VAL where that does not hold
double close_rotation(double theta, double sigma) {
  if (!(sigma < 0.5)) return HUGE_VAL;
  const double a = 0.085 * sigma, b = 1.0 - 0.5 * sigma, root = b * b - 4.0 * a * theta;
  if (!(root >= 0.0)) return HUGE_VAL;
  const double rho = 2.0 * theta / (b + std::sqrt(root));
  return rho < 1.0 ? rho : HUGE_VAL;
}

/// How columns near a free motion differ from its own, in a tube of the radius rho about it.
class Tube {
 public:
  Tube(const FreeTable& table, double rho) : table_(table), body_(table.body()), rho_(rho) { closes_ = measure(); }

  const char* refusal() const { return closes_ ? nullptr : why_; }
  Bounds bound(const Integrals& of, double& state) const;

 private:
  bool measure();

  const FreeTable& table_;
  const FreeBody& body_;
  double rho_;
  bool closes_ = false;
  const char* why_ = "";
  double rate_factor_ = 1.0, state_factor_ = 1.0;   // of the phase that the period's change shifts
  double state_ = 0.0, state_slope_ = 0.0;          // of S_r and of its slope, per y
  double rotation_ = 0.0, rotation_slope_ = 0.0;    // of Psi, per y
};

bool Tube::measure() {
  const double root = std::sqrt(body_.least);
  why_ = "the torque takes the motion too far from that of the free body";
  if (!(rho_ / root <= 0.1 * body_.most_rate && std::sqrt(body_.greatest) * rho_ <= 0.05 * body_.L)) return false;
  double K = table_.most_state, rotated = table_.most_rotation, reach = table_.span(), shift = 0.0, change = 0.0;
  if (table_.is_periodic()) {
    change = body_.bound_period_change(rho_);
    shift = change * (table_.all_cells() / table_.cells() + 1);
    constexpr double most_shift = 0.1;   // as an exponent of growth
    why_ = "the torque may change the phase of the motion too much";
    if (!(body_.growth * shift <= most_shift && body_.rate_growth * shift <= 3.0 * most_shift)) return false;
    K *= math::exp(most_shift);
    rotated += shift * K / root;
    reach = body_.period + shift;
    rate_factor_ = math::exp(body_.rate_growth * shift), state_factor_ = math::exp(body_.growth * shift);
  }
  // Gronwall over the reach: two motions of the distance rho stay within 1.05 K rho.
  const double eta = 2.3 * body_.c * K * K * rho_ * reach;
  why_ = "nearby motions of the free body move apart too fast for the torque";
  if (!(eta <= 0.1)) return false;
  const double grown = K * math::exp(eta);
  state_ = K * math::expm1(eta);
  // Psi_r = int_0^r E J^-1/2 S, where the rotations E of two motions differ by |Psi| rho.
  const double fed = reach / root * rho_ * grown;
  if (!(fed < 0.5)) return false;
  rotation_ = (fed * rotated + reach / root * state_) / (1.0 - fed);
  if (!table_.is_periodic()) return true;

  const double N = table_.most_return, G = table_.most_slope;
  const double change_of_N = math::expm1(body_.growth * change) * grown + state_;
  state_slope_ = (K + state_) * change_of_N + state_ * N;
  const double top = std::sqrt(body_.greatest), late = shift * grown / root, near = rotation_ + late;
  const double angle = (rotated + rotation_) * rho_ + 1.1 * change * body_.most_rate;
  const double change_of_G = rotation_ + change * grown / root + angle * (rotated + top / body_.L + G) +
                             7.0 * body_.greatest * rho_ / (body_.L * body_.L);
  rotation_slope_ = change_of_G + near * (N + change_of_N) + rotated * change_of_N;
  rotation_ = near + 2.2 * body_.greatest * rho_ / (body_.L * body_.L);
  return true;
}

Bounds Tube::bound(const Integrals& of, double& state) const {
  const double root = std::sqrt(body_.least), half = 0.5 * table_.width();
  const double more = state_ * of.whole + state_slope_ * of.repeated;
  state = state_factor_ * (of.state + math::exp(body_.growth * half) * more / root);
  Bounds bounds;
  bounds.rate = rate_factor_ * (of.rate + math::exp(body_.rate_growth * half) * more / body_.least);
  bounds.rotation = of.rotation + half * (bounds.rate - of.rate) +
                    (rotation_ * of.whole + rotation_slope_ * of.repeated) / root;
  return bounds;
}

/// The integrals for rates that differ by at most `margin`.
Integrals add_margin(const Share& share, double margin) {
  Integrals sum = share.fixed;
  if (margin > 0.0) sum += margin * share.per_rate;
  return sum;
}

}  // namespace

Bounds bound_by_majorant(const FreeTable& table, const Share& share, double most_margin) {
  const double c = table.body().c;
  const Integrals unit = integrate_unit(table);
  const bool by_rates = share.per_rate.whole > 0.0;
  double margin = 0.0;
  for (int tries = 0; tries < 6; ++tries) {
    const Integrals of = add_margin(share, margin);
    const double x = c * unit.state * of.state;
    if (!(x <= 0.25)) return refuse("the torque is too large for the second order");
    const double u = of.state * 2.0 / (1.0 + std::sqrt(1.0 - 4.0 * x)), second = c * u * u;
    const double rate = of.rate + second * unit.rate;
    if (!(rate <= most_margin)) return refuse("the torque changes the rates beyond its own bound");
    if (by_rates && !(rate <= margin)) {
      margin = 1.05 * rate;
      continue;
    }
    return {.rate = rate, .rotation = close_rotation(of.rotation + second * unit.rotation, table.span() * rate)};
  }
  return refuse("the torque grows with the rates that it causes");
}

Bounds bound_by_growth(const FreeBody& body, double size, double span) {
  const double root = std::sqrt(body.least), slow = body.rate_growth * span;
  const double kappa = span * mean_growth(body.growth * span), beta = size * kappa / root;
  const double x = body.c * kappa * beta;
  if (!(x <= 0.25)) return refuse("the torque is too large for the second order");
  const double u = beta * 2.0 / (1.0 + std::sqrt(1.0 - 4.0 * x));
  // |J^-1/2 S J^1/2| <= e^(g t), and Psi is its integral.
  const double source = size / body.least + body.c * u * u / root;
  const double rate = source * span * mean_growth(slow);
  return {.rate = rate, .rotation = close_rotation(source * 0.5 * span * span * math::exp(slow), span * rate)};
}

Bounds bound_by_tube(const FreeTable& table, const Share& share, double most_margin) {
  const bool by_rates = share.per_rate.whole > 0.0;
  double margin = by_rates ? 1.05 * share.fixed.rate : 0.0, rho = 1.02 * add_margin(share, margin).state;
  for (int tries = 0; tries < 8; ++tries) {
    const Tube tube(table, rho);
    if (tube.refusal() != nullptr) return refuse(tube.refusal());
    double state = 0.0;
    const Bounds bounds = tube.bound(add_margin(share, margin), state);
    if (!(bounds.rate <= most_margin)) return refuse("the torque changes the rates beyond its own bound");
    if (state <= rho && (!by_rates || bounds.rate <= margin)) return bounds;
    rho = std::max(rho, 1.1 * state);
    if (by_rates) margin = std::max(margin, 1.1 * bounds.rate);
  }
  return refuse("the torque grows with the rates that it causes");
}

}  // namespace polhode::effect
