#include "reference/law_series.hpp"

#include <algorithm>
#include <cmath>

#include "polhode/core/error.hpp"
#include "polhode/formula/facts.hpp"
#include "polhode/math/detail/double_double.hpp"

namespace polhode {

using formula::Form;
using formula::Node;
using formula::Op;



namespace {

using Real = LawSeries::Real;

constexpr int known_size = formula::Ephemeris::size;

math::DD to_dd(Real x) {
  const double high = static_cast<double>(x);
  return {high, static_cast<double>(x - high)};
}
Real to_real(const math::DD& x) { return Real(x.hi) + x.lo; }

Real compute_tanh(Real a) {
  const Real e = to_real(math::exp(to_dd(-2 * std::fabs(a))));
  const Real small = a * a;   // where 1 - e cancels
  const Real value = std::fabs(a) > 0.01L ? (1 - e) / (1 + e)
                                           : std::fabs(a) * (1 - small * (1 / 3.0L - small * (2 / 15.0L - small * (
                                                 17 / 315.0L - small * (62 / 2835.0L - small * 1382 / 155925.0L)))));
  return std::copysign(value, a);
}

}  // namespace

SinCosReal compute_sincos(Real angle) {
  const math::SinCos found = math::sincos(to_dd(angle));
  return {to_real(found.sin), to_real(found.cos)};
}

LawSeries::LawSeries(const formula::Program& law, int order)
    : law_(formula::rewrite(formula::expand_rotations(law))), parameters_(formula::list_values(law.parameters)),
      order_(order) {
  const formula::Facts facts = formula::find_facts(law_);
  if (facts.has_switches || !law_.states.empty())
    throw InvalidInput("torques", "without switches and states, which the reference lacks", "a formula with them");
  const auto size = static_cast<std::size_t>(law_.graph.size()), rows = static_cast<std::size_t>(order) + 1;
  const std::vector<bool> live = formula::find_live(law_.graph, law_.outputs);
  series_.resize(size), partners_.resize(size), fixed_.resize(size);
  for (std::size_t i = 0; i < size; ++i) {
    if (!live[i]) continue;
    const int node = static_cast<int>(i);
    const Node& n = law_.graph[node];
    live_.push_back(node);
    bool fixed = n.op != Op::time && n.op != Op::state && n.op != Op::ephemeris;
    for (const int operand : n.operands) fixed = fixed && (operand < 0 || fixed_[static_cast<std::size_t>(operand)]);
    if (n.op == Op::linear)
      for (const formula::Term& term : law_.graph.linear(node).terms)
        fixed = fixed && fixed_[static_cast<std::size_t>(term.node)];
    fixed_[i] = fixed;
    series_[i].assign(rows, 0), partners_[i].assign(rows, 0);
  }
}

void LawSeries::expand(Real t, int n, const Series* const* states, Real* tau) {
  if (n == 0) expand_ephemerides(t);
  for (const int node : live_)
    if (n == 0 || !fixed_[static_cast<std::size_t>(node)])
      series(node)[static_cast<std::size_t>(n)] = compute(node, t, n, states);
  for (std::size_t i = 0; i < 3; ++i) tau[i] = sum(law_.outputs[i], n);
}

void LawSeries::expand_ephemerides(Real t) {
  const auto& known = law_.graph.ephemerides();
  ephemerides_.resize(known.size());
  for (std::size_t i = 0; i < known.size(); ++i) {
    ephemerides_[i].resize(static_cast<std::size_t>(known_size * (order_ + 1)));
    known[i].path()->expand(to_dd(t), 1.0, order_, ephemerides_[i].data());
  }
}

Real LawSeries::sum(const Form& form, int n) const {
  Real total = n == 0 ? Real(form.constant) : 0;
  for (const formula::Term& term : form.terms)
    total += Real(term.factor) * series(term.node)[static_cast<std::size_t>(n)];
  return total;
}

Real LawSeries::compute(int node, Real t, int n, const Series* const* states) {
  const Node& one = law_.graph[node];
  static const Series none;
  const auto operand = [&](std::size_t i) -> const Series& {
    return one.operands[i] < 0 ? none : series(one.operands[i]);
  };
  const Series &a = operand(0), &b = operand(1);
  Series &z = series(node), &partner = partners_[static_cast<std::size_t>(node)];
  const auto at = static_cast<std::size_t>(n);
  const auto convolve = [&](const Series& x, const Series& y, int first, int last) {   // sum of x_j y_{n-j}
    Real total = 0;
    for (int j = first; j <= last; ++j) total += x[static_cast<std::size_t>(j)] * y[static_cast<std::size_t>(n - j)];
    return total;
  };
  const auto convolve_weighted = [&](const Series& x, const Series& y, int last) {     // sum of j x_j y_{n-j}
    Real total = 0;
    for (int j = 1; j <= last; ++j)
      total += j * x[static_cast<std::size_t>(j)] * y[static_cast<std::size_t>(n - j)];
    return total;
  };
  const auto is_fixed = [&](std::size_t i) { return fixed_[static_cast<std::size_t>(one.operands[i])]; };
  switch (one.op) {
    case Op::constant: return n == 0 ? Real(one.constant) : 0;
    case Op::parameter: return n == 0 ? Real(parameters_[static_cast<std::size_t>(one.index)]) : 0;
    case Op::time: return n == 0 ? t : n == 1 ? 1 : 0;
    case Op::state: return (*states[one.index])[at];
    case Op::ephemeris:
      return ephemerides_[static_cast<std::size_t>(one.index / known_size)][known_size * at + static_cast<std::size_t>(one.index % known_size)];
    case Op::linear: return sum(law_.graph.linear(node), n);
    case Op::multiply:
      if (is_fixed(0)) return a[0] * b[at];
      if (is_fixed(1)) return a[at] * b[0];
      return convolve(a, b, 0, n);
    case Op::divide: return (a[at] - convolve(z, b, 0, n - 1)) / b[0];
    case Op::root: return n == 0 ? std::sqrt(a[0]) : (a[at] - convolve(z, z, 1, n - 1)) / (2 * z[0]);
    case Op::power: {
      if (n == 0) return to_real(math::exp(to_dd(Real(one.constant) * to_real(math::log(to_dd(a[0]))))));
      Real total = 0;
      for (int j = 1; j <= n; ++j) {
        const Real factor = Real(one.constant) * j - (n - j);
        total += factor * a[static_cast<std::size_t>(j)] * z[static_cast<std::size_t>(n - j)];
      }
      return total / (n * a[0]);
    }
    case Op::exponential: return n == 0 ? to_real(math::exp(to_dd(a[0]))) : convolve_weighted(a, z, n) / n;
    case Op::logarithm:
      return n == 0 ? to_real(math::log(to_dd(a[0]))) : (a[at] - convolve_weighted(z, a, n - 1) / n) / a[0];
    case Op::sine:
    case Op::cosine: {
      const Real sign = one.op == Op::sine ? 1 : -1;
      if (n == 0) {
        const SinCosReal found = compute_sincos(a[0]);
        partner[0] = one.op == Op::sine ? found.cos : found.sin;
        return one.op == Op::sine ? found.sin : found.cos;
      }
      const Real value = sign * convolve_weighted(a, partner, n) / n;
      partner[at] = -sign * convolve_weighted(a, z, n) / n;
      return value;
    }
    case Op::tanh: {
      const Real value = n == 0 ? compute_tanh(a[0]) : convolve_weighted(a, partner, n) / n;
      z[at] = value;
      partner[at] = (n == 0 ? 1 : 0) - convolve(z, z, 0, n);
      return value;
    }
    case Op::angle: {
      partner[at] = convolve(a, a, 0, n) + convolve(b, b, 0, n);
      if (n == 0) return to_real(math::atan2(to_dd(a[0]), to_dd(b[0])));
      return (convolve_weighted(a, b, n) - convolve_weighted(b, a, n) - convolve_weighted(z, partner, n - 1)) /
             (n * partner[0]);
    }
    case Op::choose:
    case Op::to_body: break;   // there are none
  }
  return 0;
}

}  // namespace polhode
