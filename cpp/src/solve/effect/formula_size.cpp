#include <algorithm>
#include <array>
#include <cmath>

#include "polhode/math/detail/interval_functions.hpp"
#include "solve/effect/orbit_range.hpp"
#include "solve/effect/torque_size.hpp"

// A formula over all attitudes: its nodes as intervals.
namespace polhode::effect {
namespace {

using formula::Form;
using formula::Graph;
using formula::Node;
using formula::Op;
using math::DD;
using math::Interval;

Interval between(double low, double high) {
  if (!(std::abs(low) < HUGE_VAL && std::abs(high) < HUGE_VAL)) return Interval::all();
  const double middle = 0.5 * low + 0.5 * high;
  return {DD(middle), Interval::raise(std::max(high - middle, middle - low))};
}

Interval join(const Interval& a, const Interval& b) {
  if (!a.is_bounded() || !b.is_bounded()) return Interval::all();
  return between(std::min(a.lower(), b.lower()), std::max(a.upper(), b.upper()));
}

/// a^n by squares.
Interval raise(const Interval& a, long n) {
  if (n == 0) return Interval(1.0);
  const Interval square = math::sqr(raise(a, n / 2));
  return n % 2 == 0 ? square : square * a;
}

/// From the values at both ends, so that it is bounded for wide intervals, too.
Interval exponential(const Interval& a) {
  if (!a.is_bounded()) return Interval::all();
  const Interval low = math::exp(Interval(a.lower())), high = math::exp(Interval(a.upper()));
  return high.is_bounded() ? between(low.is_bounded() ? std::max(low.lower(), 0.0) : 0.0, high.upper()) : Interval::all();
}

Interval power(const Interval& a, double exponent) {
  constexpr double most = 64.0;
  if (exponent == std::nearbyint(exponent) && std::abs(exponent) <= most) {
    const Interval whole = raise(a, static_cast<long>(std::abs(exponent)));
    return exponent < 0.0 ? Interval(1.0) / whole : whole;
  }
  return math::exp(Interval(exponent) * math::log(a));
}

class Values {
 public:
  Values(const formula::Program& program, const Region& region) : graph_(program.graph), region_(region) {
    const std::vector<bool> live = formula::find_live(graph_, program.outputs);
    values_.resize(live.size());
    for (std::size_t i = 0; i < live.size(); ++i)
      if (live[i]) values_[i] = compute(graph_[static_cast<int>(i)], static_cast<int>(i));
  }

  Interval of(const Form& form) const {
    Interval sum(form.constant);
    for (const formula::Term& term : form.terms) sum = sum + Interval(term.factor) * at(term.node);
    return sum;
  }
  Interval at(int node) const { return values_[static_cast<std::size_t>(node)]; }

 private:
  Interval compute(const Node& n, int node) const {
    const auto operand = [&](std::size_t i) { return at(n.operands[i]); };
    switch (n.op) {
      case Op::constant: return Interval(n.constant);
      case Op::time: return between(region_.begin, region_.end);
      case Op::ephemeris: return of_orbit(n);
      case Op::state:
        if (n.index < formula::first_attitude) return {DD(0.0), region_.most_rates_B[n.index] + region_.margin};
        return n.index < formula::first_extra ? Interval(DD(0.0), 1.0) : Interval::all();
      case Op::parameter: return Interval::all();
      case Op::linear: return of(graph_.linear(node));
      case Op::multiply: return n.operands[0] == n.operands[1] ? math::sqr(operand(0)) : operand(0) * operand(1);
      case Op::divide: return operand(0) / operand(1);
      case Op::root: return math::sqrt(operand(0));
      case Op::power: return power(operand(0), n.constant);
      case Op::exponential: return exponential(operand(0));
      case Op::logarithm: return math::log(operand(0));
      case Op::sine: return math::sincos(operand(0)).sin;
      case Op::cosine: return math::sincos(operand(0)).cos;
      case Op::tanh: return math::tanh(operand(0));
      case Op::angle: return math::atan2(operand(0), operand(1));
      case Op::choose: return join(operand(1), operand(2));
      case Op::to_body: break;
    }
    return {DD(0.0), length(operand(0), operand(1), operand(2))};
  }

  Interval of_orbit(const Node& n) const {
    using formula::Ephemeris;
    const OrbitRange range = find_range(graph_.ephemeris_of(n), region_.begin, region_.end);
    const int number = n.index % Ephemeris::size;
    if (number < Ephemeris::velocity) return between(-range.most_distance, range.most_distance);
    if (number < Ephemeris::distance) return between(-range.most_speed, range.most_speed);
    if (number == Ephemeris::distance) return between(range.least_distance, range.most_distance);
    return between(1.0 / range.most_distance, 1.0 / range.least_distance);
  }

  static double length(const Interval& x, const Interval& y, const Interval& z) {
    return math::sqrt(math::sqr(x) + math::sqr(y) + math::sqr(z)).magnitude();
  }
  friend double polhode::effect::bound_formula(const torques::Formula&, const Region&);

  const Graph& graph_;
  const Region& region_;
  std::vector<Interval> values_;
};

/// The nodes of a vector in space and a factor, if the outputs are a multiple of that vector seen from the body.
struct Seen {
  std::array<int, 3> operands;
  double factor;
};
std::optional<Seen> find_seen_vector(const formula::Program& program) {
  Seen seen{{-1, -1, -1}, 0.0};
  for (int i = 0; i < 3; ++i) {
    const Form& form = program.outputs[static_cast<std::size_t>(i)];
    if (form.constant != 0.0 || form.terms.size() != 1) return std::nullopt;
    const Node& node = program.graph[form.terms[0].node];
    if (node.op != Op::to_body || node.index != i) return std::nullopt;
    if (i == 0) seen = {node.operands, form.terms[0].factor};
    if (node.operands != seen.operands || form.terms[0].factor != seen.factor) return std::nullopt;
  }
  return seen;
}

}  // namespace

double bound_formula(const torques::Formula& formula, const Region& region) {
  if (!formula.states().empty()) return HUGE_VAL;
  const formula::Program program = formula.program(region.inertia_B);
  const Values values(program, region);
  double most = HUGE_VAL;
  if (const std::optional<Seen> seen = find_seen_vector(program)) {
    const auto& v = seen->operands;
    most = std::abs(seen->factor) * Values::length(values.at(v[0]), values.at(v[1]), values.at(v[2]));
  } else {
    const auto& outputs = program.outputs;
    most = Values::length(values.of(outputs[0]), values.of(outputs[1]), values.of(outputs[2]));
  }
  return most < HUGE_VAL ? most * (1.0 + 0x1p-50) : HUGE_VAL;
}

}  // namespace polhode::effect
