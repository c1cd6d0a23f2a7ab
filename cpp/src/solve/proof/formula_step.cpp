#include "solve/proof/formula_step.hpp"

#include <map>

#include "polhode/math/detail/functions.hpp"
#include "polhode/math/detail/interval_functions.hpp"

namespace polhode::proof {

using formula::Node;
using formula::Op;

namespace {

/// Makes the slots of a program.
template <class Slot, class Kind, class Form>
class Compiler {
 public:
  Compiler(const FormulaSystem& system, std::vector<Slot>& slots)
      : system_(system), graph_(system.derivatives.graph), slots_(slots), slot_of_(to_index(graph_.size()), -1) {
    const std::vector<formula::Form>& outputs = system.derivatives.outputs;
    live_ = formula::find_live(graph_, outputs);
    std::vector<formula::Form> followed(outputs.begin(), outputs.begin() + system.size);
    followed.insert(followed.end(), outputs.end() - system.guards, outputs.end());
    full_ = formula::find_live(graph_, followed);
    for (int i = 0; i < graph_.size(); ++i)
      if (live_[to_index(i)] && (graph_[i].op == Op::sine || graph_[i].op == Op::cosine)) {
        bool& full = full_pair_[graph_[i].operands[0]];
        full = full || full_[to_index(i)];
      }
    for (int i = 0; i < graph_.size(); ++i)
      if (live_[to_index(i)]) slot_of_[to_index(i)] = make(i);
  }

  Form make_form(const formula::Form& form) const {
    Form made{Interval(form.constant)};
    for (const formula::Term& term : form.terms) {
      const int slot = slot_of_[to_index(term.node)];
      const Slot& source = slots_[to_index(slot)];
      if (source.kind == Kind::fixed) made.constant = made.constant + Interval(term.factor) * source.value;
      else made.terms.emplace_back(term.factor, slot);
    }
    return made;
  }

 private:
  int add(Slot slot) {
    slots_.push_back(std::move(slot));
    return static_cast<int>(slots_.size()) - 1;
  }
  int add_fixed(const Interval& value) { return add({.kind = Kind::fixed, .value = value}); }

  int make(int node) {
    const Node& n = graph_[node];
    const bool full = full_[to_index(node)];
    const int a = n.operands[0] < 0 ? -1 : slot_of_[to_index(n.operands[0])];
    const int b = n.operands[1] < 0 ? -1 : slot_of_[to_index(n.operands[1])];
    const auto is_fixed = [&](int slot) { return slot < 0 || slots_[to_index(slot)].kind == Kind::fixed; };
    const auto value = [&](int slot) { return slots_[to_index(slot)].value; };
    const auto apply = [&](Kind kind, const auto& function) {
      return is_fixed(a) ? add_fixed(function(value(a))) : add({.kind = kind, .a = a, .is_full = full});
    };
    const auto scale = [&](const Interval& factor, int slot) {
      return factor.is_zero() ? add_fixed({}) : add({.kind = Kind::scale, .a = slot, .value = factor, .is_full = full});
    };
    switch (n.op) {
      case Op::constant: return add_fixed(Interval(n.constant));
      case Op::parameter: return add_fixed(system_.values[to_index(n.index)]);
      case Op::time: return add({.kind = Kind::time});
      case Op::state: return add({.kind = Kind::state, .a = system_.find_variable(n.index)});
      case Op::linear: {
        Form form = make_form(graph_.linear(node));
        if (form.terms.empty()) return add_fixed(form.constant);
        return add({.kind = Kind::linear, .form = std::move(form), .is_full = full});
      }
      case Op::multiply:
        if (is_fixed(a) && is_fixed(b)) return add_fixed(value(a) * value(b));
        if (is_fixed(a)) return scale(value(a), b);
        if (is_fixed(b)) return scale(value(b), a);
        return add({.kind = Kind::multiply, .a = a, .b = b, .is_full = full});
      case Op::divide:
        if (is_fixed(a) && is_fixed(b)) return add_fixed(value(a) / value(b));
        if (is_fixed(b)) return scale(Interval(1.0) / value(b), a);
        return add({.kind = Kind::divide, .a = a, .b = b, .is_full = full});
      case Op::root:
        // sqrt() of an interval is of what is not negative in it.
        return apply(Kind::root, [](const Interval& x) {
          return x.is_zero() || (x.mignitude() > 0.0 && x.middle.hi > 0.0) ? sqrt(x) : Interval::all();
        });
      case Op::exponential: return apply(Kind::exponential, [](const Interval& x) { return exp(x); });
      case Op::logarithm: return apply(Kind::logarithm, [](const Interval& x) { return log(x); });
      case Op::sine:
      case Op::cosine: {
        const bool is_sine = n.op == Op::sine;
        if (is_fixed(a)) return add_fixed(is_sine ? sincos(value(a)).sin : sincos(value(a)).cos);
        const auto [at, is_new] = pairs_.emplace(n.operands[0], static_cast<int>(slots_.size()));
        if (is_new)
          for (const Kind kind : {Kind::sine, Kind::cosine})
            add({.kind = kind, .a = a, .is_full = full_pair_.at(n.operands[0])});
        return at->second + (is_sine ? 0 : 1);
      }
      case Op::tanh: {
        if (is_fixed(a)) return add_fixed(tanh(value(a)));
        const int slot = add({.kind = Kind::tanh, .a = a, .is_full = full});
        add({.kind = Kind::slope, .a = slot, .is_full = full});
        return slot;
      }
      case Op::angle: {
        if (is_fixed(a) && is_fixed(b)) return add_fixed(compute_angle(value(a), value(b)));
        add({.kind = Kind::squares, .a = a, .b = b, .is_full = full});
        return add({.kind = Kind::angle, .a = a, .b = b, .is_full = full});
      }
      default: return add_fixed(Interval::all());   // none of these is left in a system
    }
  }

  /// The principal angle, which jumps at the cut.
  static Interval compute_angle(const Interval& y, const Interval& x) {
    const bool is_off_cut = y.is_zero() || y.mignitude() > 0.0 || (x.mignitude() > 0.0 && x.middle.hi > 0.0);
    return is_off_cut ? atan2(y, x) : Interval::all();
  }

  const FormulaSystem& system_;
  const formula::Graph& graph_;
  std::vector<Slot>& slots_;
  std::vector<int> slot_of_;
  std::vector<bool> live_, full_;
  std::map<int, bool> full_pair_;   ///< whether f needs a sine or a cosine of a node
  std::map<int, int> pairs_;
};

/// A quadratic system has more variables, all of which limit its steps. This gives the same bounds.
StepSettings refine(StepSettings settings) {
  settings.tolerance *= 0.25;
  return settings;
}

}  // namespace

FormulaStep::FormulaStep(const FormulaSystem& system, const StepSettings& settings)
    : TaylorStep(system.size, refine(settings), system.first_own()), t0_(system.t0), per_time_(system.per_time) {
  const Compiler<Slot, Kind, Form> compiler(system, slots_);
  std::size_t terms = 0;
  for (int i = 0; i < n_; ++i) rates_.push_back(compiler.make_form(system.derivatives.outputs[to_index(i)]));
  for (int j = 0; j < n_; ++j)
    for (int i = 0; i < n_; ++i) {
      Form form = compiler.make_form(system.derivatives.outputs[to_index(n_ + n_ * j + i)]);
      if (form.constant.is_zero() && form.terms.empty()) continue;
      const auto rows = form.terms.empty() ? std::size_t{1} : to_index(order_ + 1);
      terms = std::max(terms, form.terms.size());
      entries_.push_back({i, j, std::move(form), std::vector<double>(rows)});
    }
  for (auto guard = system.derivatives.outputs.end() - system.guards; guard != system.derivatives.outputs.end(); ++guard)
    guards_.push_back({compiler.make_form(*guard), std::vector<double>(to_index(order_))});
  for (const Guard& guard : guards_) terms = std::max(terms, guard.form.terms.size());
  for (const Form& rate : rates_) terms = std::max(terms, rate.terms.size());
  for (const Slot& slot : slots_) terms = std::max(terms, slot.form.terms.size());
  // The longest sums of a row: an angle has three of products, other operations one.
  const bool has_angle = std::any_of(slots_.begin(), slots_.end(), [](const Slot& s) { return s.kind == Kind::angle; });
  set_rounding(((has_angle ? 3.0 : 1.0) * order_ + static_cast<double>(terms) + 20.0) * unit);
  fine_ = std::min(fine_ + 1, order_ - 1);   // an operation's coefficients fall more slowly than those of the state
  derivative_rounding_ = (n_ * (order_ + 1.0) + 2.0 * order_ + static_cast<double>(terms) + 20.0) * unit;
  const std::size_t all = slots_.size() * to_index(order_ + 1);
  slot_high_.resize(all), slot_low_.resize(all), slot_sizes_.resize(all), slot_tails_.resize(all);
  weighted_sizes_.resize(all), weighted_tails_.resize(all);
  start_.resize(slots_.size()), lost_.resize(slots_.size());
  first_.resize(slots_.size()), second_.resize(slots_.size());
  for (std::size_t s = 0; s < slots_.size(); ++s) {
    if (slots_[s].kind != Kind::fixed) continue;
    slot_high_[at(static_cast<int>(s), 0)] = slots_[s].value.middle.hi;
    slot_low_[at(static_cast<int>(s), 0)] = slots_[s].value.middle.lo;
  }
}

template <>
double FormulaStep::get<double>(int slot, int k) const { return slot_high_[at(slot, k)]; }
template <>
DD FormulaStep::get<DD>(int slot, int k) const { return {slot_high_[at(slot, k)], slot_low_[at(slot, k)]}; }

namespace {

template <class N>
N take(const DD& x) {
  if constexpr (std::is_same_v<N, DD>) return x;
  else return x.hi;
}

void put(const DD& x, double& high, double& low) { high = x.hi, low = x.lo; }
void put(double x, double& high, double& low) { high = x, low = 0.0; }

}  // namespace

template <class N>
N FormulaStep::sum(const Form& form, int k) const {
  N total = k == 0 ? take<N>(form.constant.middle) : N(0.0);
  for (const auto& [factor, slot] : form.terms) total = total + N(factor) * get<N>(slot, k);
  return total;
}

/// Row 0 of a function, from its enclosure at the value of its operand.
void FormulaStep::start(int s) {
  const Slot& slot = slots_[to_index(s)];
  const Interval a(get<DD>(slot.a, 0), 0.0);
  const auto set = [&](int to, const Interval& value) {
    slot_high_[at(to, 0)] = value.middle.hi, slot_low_[at(to, 0)] = value.middle.lo;
    start_[to_index(to)] = value.radius;
  };
  switch (slot.kind) {
    case Kind::exponential: return set(s, exp(a));
    case Kind::logarithm: return set(s, log(a));
    case Kind::sine: return set(s, sincos(a).sin);
    case Kind::cosine: return set(s, sincos(a).cos);
    case Kind::tanh: return set(s, tanh(a));
    default: return set(s, atan2(a, Interval(get<DD>(slot.b, 0), 0.0)));
  }
}

/// Row k of an operation, from the rows below and those of its operands.
template <class N>
N FormulaStep::compute(int s, int k) {
  const Slot& slot = slots_[to_index(s)];
  const int a = slot.a, b = slot.b;
  const auto convolve = [&](int x, int y, int first, int last) {   // sum of x_j y_{k-j}
    N total(0.0);
    for (int j = first; j <= last; ++j) total = total + get<N>(x, j) * get<N>(y, k - j);
    return total;
  };
  const auto convolve_weighted = [&](int x, int y, int last) {     // sum of j x_j y_{k-j}, j > 0
    N total(0.0);
    for (int j = 1; j <= last; ++j) total = total + N(static_cast<double>(j)) * get<N>(x, j) * get<N>(y, k - j);
    return total;
  };
  const N n(static_cast<double>(k));
  switch (slot.kind) {
    case Kind::linear: return sum<N>(slot.form, k);
    case Kind::scale: return take<N>(slot.value.middle) * get<N>(a, k);
    case Kind::multiply: return convolve(a, b, 0, k);
    case Kind::divide: return (get<N>(a, k) - convolve(s, b, 0, k - 1)) / get<N>(b, 0);
    case Kind::root:
      if (k == 0) return take<N>(math::sqrt(get<DD>(a, 0)));
      return (get<N>(a, k) - convolve(s, s, 1, k - 1)) / (N(2.0) * get<N>(s, 0));
    case Kind::exponential: return convolve_weighted(a, s, k) / n;
    case Kind::logarithm: return (get<N>(a, k) - convolve_weighted(s, a, k - 1) / n) / get<N>(a, 0);
    case Kind::sine: return convolve_weighted(a, s + 1, k) / n;
    case Kind::cosine: return N(0.0) - convolve_weighted(a, s - 1, k) / n;
    case Kind::tanh: return convolve_weighted(a, s + 1, k) / n;
    case Kind::slope: return (k == 0 ? N(1.0) : N(0.0)) - convolve(a, a, 0, k);
    case Kind::squares: return convolve(a, a, 0, k) + convolve(b, b, 0, k);
    case Kind::angle:
      return (convolve_weighted(a, b, k) - convolve_weighted(b, a, k) - convolve_weighted(s, s - 1, k - 1)) /
             (n * get<N>(s - 1, 0));
    default: return N(0.0);
  }
}

namespace {

template <class Kind>
bool starts_by_function(Kind kind) {
  return kind == Kind::exponential || kind == Kind::logarithm || kind == Kind::sine || kind == Kind::cosine ||
         kind == Kind::tanh || kind == Kind::angle;
}

}  // namespace

void FormulaStep::expand_state(const Interval& now) {
  const Interval time = Interval(t0_) + now * Interval(per_time_);
  time_radius_ = time.radius;
  refused_ = 0;
  const int count = static_cast<int>(slots_.size());
  const auto store = [&](int slot, int k, const auto& value) {
    put(value, slot_high_[at(slot, k)], slot_low_[at(slot, k)]);
  };
  const auto take_state = [&](int k) {
    for (int s = 0; s < count; ++s) {
      if (slots_[to_index(s)].kind != Kind::state) continue;
      const int v = slots_[to_index(s)].a;
      store(s, k, DD(P(v)[k], low_[to_index(v * (order_ + 1) + k)]));
    }
  };
  take_state(0);
  for (int k = 0; k < order_; ++k) {
    const auto advance = [&](auto zero) {
      using N = decltype(zero);
      for (int s = 0; s < count; ++s) {
        const Slot& slot = slots_[to_index(s)];
        if (!slot.is_full || slot.kind == Kind::fixed || slot.kind == Kind::state) continue;
        if (slot.kind == Kind::time) store(s, k, k == 0 ? time.middle : DD(k == 1 ? per_time_ : 0.0));
        else if (k == 0 && starts_by_function(slot.kind)) start(s);
        else store(s, k, compute<N>(s, k));
      }
      for (int v = 0; v < n_; ++v) {
        const N next = sum<N>(rates_[to_index(v)], k) / N(k + 1.0);
        put(next, P(v)[k + 1], low_[to_index(v * (order_ + 1) + k + 1)]);
      }
    };
    if (k < fine_) advance(DD());
    else advance(0.0);
    take_state(k + 1);
  }
  for (Guard& guard : guards_)
    for (int k = 0; k < order_; ++k) {
      const DD value = sum<DD>(guard.form, k);
      guard.coefficients[to_index(k)] = value.hi;
      if (k == 0) guard.low = value.lo;
    }
}

/// Guards may vary faster than the motion does.
double FormulaStep::shorten(double length) const {
  for (const Guard& guard : guards_) {
    const auto size = [&](int k) { return std::abs(guard.coefficients[to_index(k)]) * math::fast_pow(length, k); };
    for (int times = 0; times < 200; ++times) {
      double largest = 0.0;
      for (int k = 0; k <= order_ / 2; ++k) largest = std::max(largest, size(k));
      const double last = std::max(size(order_ - 2), size(order_ - 1));
      if (last == 0.0 || last <= settings_.tolerance * largest) break;
      length *= last < 1e200 ? 0.75 : 0x1p-20;
    }
  }
  return length;
}

void FormulaStep::expand_derivative() {
  const int M = derivative_order_;
  const auto w = to_index(width_);
  for (int s = 0; s < static_cast<int>(slots_.size()); ++s) {
    const Slot& slot = slots_[to_index(s)];
    if (slot.is_full || slot.kind == Kind::fixed) continue;
    for (int k = 0; k <= order_; ++k) {
      if (k == 0 && starts_by_function(slot.kind)) start(s);
      else put(k < M ? compute<double>(s, k) : 0.0, slot_high_[at(s, k)], slot_low_[at(s, k)]);
    }
  }
  for (Entry& entry : entries_)
    for (int k = 0; k < static_cast<int>(entry.coefficients.size()); ++k)
      entry.coefficients[to_index(k)] = sum<double>(entry.form, k);

  std::fill_n(derivative_.begin(), to_index(n_) * w, 0.0);
  for (int v = 0; v < n_; ++v) F(0, v)[v] = 1.0;
  for (int k = 0; k < M; ++k) {
    double* rows = F(k + 1, 0);
    std::fill_n(rows, to_index(n_) * w, 0.0);
    for (const Entry& entry : entries_) {
      double* row = F(k + 1, entry.row);
      const int last = std::min(k, static_cast<int>(entry.coefficients.size()) - 1);
      for (int j = 0; j <= last; ++j) {
        const double* source = F(k - j, entry.column);
        const double factor = entry.coefficients[to_index(j)];
        for (std::size_t c = 0; c < w; ++c) row[c] += factor * source[c];
      }
    }
    for (std::size_t c = 0; c < to_index(n_) * w; ++c) rows[c] /= k + 1;
  }
}

}  // namespace polhode::proof
