#include <algorithm>
#include <cmath>

#include "solve/proof/formula_step.hpp"

// What the polynomials of a step of formulas leave out, bounded.
namespace polhode::proof {
namespace {

constexpr double tiny = 0x1p-600;   // above what underflow loses in a step
constexpr double steepest = 60.0;   // the largest exponent of exp_above()

}  // namespace

void FormulaStep::measure_slot(int s) {
  double sum = 0.0, weighted = 0.0;
  for (int k = order_; k >= 0; --k) {
    const std::size_t i = at(s, k);
    slot_sizes_[i] = std::abs(slot_high_[i]) * powers_[to_index(k)];
    slot_tails_[i] = sum += slot_sizes_[i];
    weighted_sizes_[i] = k * slot_sizes_[i];
    weighted_tails_[i] = weighted += weighted_sizes_[i];
  }
}

/// Of what a slot brings to an equation whose coefficients are computed like those of `whole`.
FormulaStep::Sizes FormulaStep::of_slot(int s, const Slot& whole, bool weighted) const {
  return {tail(s, 0, weighted), tail(s, whole.is_full ? fine_ : 0, weighted), tail(s, rows_of(whole), weighted)};
}

/// The same of a product of two slots, the second one weighted by the powers of time.
FormulaStep::Sizes FormulaStep::of_pair(int x, int y, const Slot& whole, bool weighted) const {
  const int fine = whole.is_full ? fine_ : 0, rows = rows_of(whole);
  Sizes sizes{tail(x, 0) * tail(y, 0, weighted), 0.0, 0.0};
  for (int i = 0; i <= order_; ++i) {
    const double size = slot_sizes_[at(x, i)];
    sizes.coarse += size * tail(y, fine - i, weighted);
    sizes.left_out += size * tail(y, rows - i, weighted);
  }
  return sizes;
}

double FormulaStep::lose(const Sizes& sizes) const {
  const double rounding = fine_rounding * sizes.all + rounding_ * sizes.coarse;
  return raised(rounding + settings_.remainder_factor * sizes.left_out) + tiny;
}

/// Of a form by its own polynomial, and by those of its slots.
double FormulaStep::lose_form(const Form& form, const Slot& whole) const {
  double lost = form.constant.radius +
                (whole.is_full ? fine_rounding : rounding_) * std::abs(form.constant.middle.hi);
  for (const auto& [factor, slot] : form.terms)
    lost += std::abs(factor) * (lose(of_slot(slot, whole)) + lost_[to_index(slot)]);
  return raised(lost);
}

FormulaStep::Range FormulaStep::find_range(int s, double wide) const {
  const double center = std::abs(slot_high_[at(s, 0)]) * (1.0 - 0x1p-30), off = raised(tail(s, 1) + wide);
  return {center > off ? (center - off) * (1.0 - 0x1p-30) : 0.0, raised(tail(s, 0) + wide)};
}

/// Bounds that hold wherever the operands are within `wide` of their polynomials.
FormulaStep::Slopes FormulaStep::find_slopes(int s, const std::vector<double>& wide) const {
  const Slot& slot = slots_[to_index(s)];
  const Slopes unknown{.known = false};
  const auto range = [&](int operand) { return find_range(operand, wide[to_index(operand)]); };
  const auto is_positive = [&](int operand) { return slot_high_[at(operand, 0)] > 0.0 && range(operand).least > 0.0; };
  switch (slot.kind) {
    case Kind::multiply: return {.a = range(slot.b).most, .b = range(slot.a).most, .ab = 1.0};
    case Kind::divide: {
      const double least = range(slot.b).least;
      if (!(least > 0.0)) return unknown;
      const double inverse = raised(1.0 / least), size = raised(range(slot.a).most * inverse);
      return {.a = inverse, .b = size * inverse, .ab = inverse * inverse, .bb = 2.0 * size * inverse * inverse};
    }
    case Kind::root: {
      if (!is_positive(slot.a)) return unknown;
      const double least = range(slot.a).least, inverse = raised(1.0 / std::sqrt(least));
      return {.a = 0.5 * inverse, .aa = 0.25 * inverse / least};
    }
    case Kind::exponential: {
      const double off = raised(tail(slot.a, 1) + wide[to_index(slot.a)]);
      if (!(off <= steepest)) return unknown;
      const double most = raised((std::abs(slot_high_[at(s, 0)]) + start_[to_index(s)]) * exp_above(off));
      return {.a = most, .aa = most};
    }
    case Kind::logarithm: {
      if (!is_positive(slot.a)) return unknown;
      const double inverse = raised(1.0 / range(slot.a).least);
      return {.a = inverse, .aa = inverse * inverse};
    }
    case Kind::sine:
    case Kind::cosine:
    case Kind::tanh: return {.a = 1.0, .aa = 1.0};
    case Kind::angle: {
      // The principal angle jumps where y = 0 and x < 0.
      const double across = range(slot.a).least, along = range(slot.b).least;
      if (!(across > 0.0) && !is_positive(slot.b)) return unknown;
      const double least = across * across + along * along;
      if (!(least > 0x1p-900)) return unknown;
      const double inverse = raised(1.0 / least), slope = raised(std::sqrt(inverse));
      return {.a = slope, .b = slope, .aa = inverse, .ab = inverse, .bb = inverse};
    }
    default: return {};
  }
}

/// |Z - z| for the function z of the polynomials of the operands; not finite where it is not known.
double FormulaStep::find_own_error(int s) const {
  const Slot& slot = slots_[to_index(s)];
  const int a = slot.a, b = slot.b;
  const double start = start_[to_index(s)];
  const double unknown = Interval::infinity;
  // |A'| integrated over the step; the sizes are weighted so that integrals of defects need no factor.
  const double change = a < 0 ? 0.0 : raised(tail(a, 1));
  switch (slot.kind) {
    case Kind::multiply: return lose(of_pair(a, b, slot));
    case Kind::scale: return raised(std::abs(slot.value.middle.hi) * lose(of_slot(a, slot)) +
                                    slot.value.radius * tail(a, 0));
    case Kind::divide: {   // A - Z B
      const double least = find_range(b, 0.0).least;
      Sizes sizes = of_pair(s, b, slot);
      return least > 0.0 ? raised(lose(sizes += of_slot(a, slot)) / least) : unknown;
    }
    case Kind::root: {     // A - Z^2
      const double least = find_range(s, 0.0).least;
      Sizes sizes = of_pair(s, s, slot);
      const double defect = lose(sizes += of_slot(a, slot));
      return slot_high_[at(s, 0)] > 0.0 && 0.5 * least * least > defect ? raised(defect / least) : unknown;
    }
    case Kind::exponential: {   // Z' - Z A', carried by e^A
      if (!(change <= 0.5 * steepest)) return unknown;
      const double growth = exp_above(change);
      return raised(growth * (start + growth * lose(of_pair(s, a, slot, true))));
    }
    case Kind::logarithm: {     // A' - Z' A
      const double least = find_range(a, 0.0).least;
      Sizes sizes = of_pair(a, s, slot, true);
      return slot_high_[at(a, 0)] > 0.0 && least > 0.0
                 ? raised(start + lose(sizes += of_slot(a, slot, true)) / least) : unknown;
    }
    case Kind::sine:
    case Kind::cosine: {        // S' - C A' and C' + S A', carried by a rotation
      const int sine = slot.kind == Kind::sine ? s : s - 1, cosine = sine + 1;
      return raised(start_[to_index(sine)] + start_[to_index(cosine)] + lose(of_pair(cosine, a, slot, true)) +
                    lose(of_pair(sine, a, slot, true)));
    }
    case Kind::tanh: {          // Z' - (1 - Z^2) A'; the error of Z obeys e' = -(Z + tanh A) A' e + the defect
      const double exponent = raised((1.0 + tail(s, 0)) * change);
      if (!(exponent <= steepest)) return unknown;
      Sizes sizes = of_pair(s, s, slot);
      sizes.all += 1.0, sizes.coarse += slot.is_full ? 0.0 : 1.0;
      const double defect = lose(of_pair(s + 1, a, slot, true)) + lose(sizes) * change;
      return raised((start + defect) * exp_above(exponent));
    }
    case Kind::angle: {         // (X^2 + Y^2) Z' - (X Y' - Y X')
      const double across = find_range(a, 0.0).least, along = find_range(b, 0.0).least;
      const double least = across * across + along * along;
      if (!(least > 0x1p-900)) return unknown;
      Sizes sizes = of_pair(a, a, slot), defect = of_pair(s - 1, s, slot, true);
      sizes += of_pair(b, b, slot);
      defect += of_pair(b, a, slot, true), defect += of_pair(a, b, slot, true);
      return raised(start + (lose(defect) + lose(sizes) * tail(s, 1)) / (least * (1.0 - 0x1p-30)));
    }
    default: return 0.0;
  }
}

bool FormulaStep::bound_slot(int s) {
  const Slot& slot = slots_[to_index(s)];
  double& lost = lost_[to_index(s)];
  measure_slot(s);
  if (slot.kind == Kind::squares) measure_slot(s + 1);
  if (slot.kind == Kind::sine || slot.kind == Kind::tanh) measure_slot(s + 1);
  if (!(tail(s, 0) < 0x1p60)) return false;
  if (slot.kind == Kind::linear) {
    lost = lose_form(slot.form, slot);
  } else if (slot.kind == Kind::fixed) {
    lost = slot.value.radius;
  } else if (slot.kind == Kind::time) {
    lost = time_radius_;
  } else if (slot.kind == Kind::scale) {
    lost = raised(find_own_error(s) + slot.value.magnitude() * lost_[to_index(slot.a)]);
  } else {
    const Slopes slopes = find_slopes(s, lost_);
    lost = find_own_error(s);
    if (slopes.a > 0.0) lost += slopes.a * lost_[to_index(slot.a)];
    if (slopes.b > 0.0) lost += slopes.b * lost_[to_index(slot.b)];
    lost = raised(lost);
    if (!slopes.known) return false;
  }
  return lost < 0x1p60;
}

/// |d| + |D| box over the step. f(P) and J(P) are polynomials but for what their slots lose.
bool FormulaStep::compute_defects(const std::vector<double>&) {
  if (!(powers_[to_index(order_)] < 0x1p400)) return false;   // `tiny` covers no more
  for (int s = 0; s < static_cast<int>(slots_.size()); ++s)
    if (!bound_slot(s)) return false;
  const int M = derivative_order_;
  const Slot whole{.kind = Kind::linear};
  for (int i = 0; i < n_; ++i) defect_[to_index(i)] = lose_form(rates_[to_index(i)], whole);

  // An operation may be singular where f is not. Its series then decides the step, and not that of the state alone.
  double worst = 0.0;
  for (int i = 0; i < n_; ++i) worst = std::max(worst, defect_[to_index(i)] / largest_size(i));
  if (worst * powers_[1] > 256.0 * settings_.tolerance && refused_++ < 8) return false;

  std::vector<double> image_tails(to_index(n_ * (M + 1)));
  for (int v = 0; v < n_; ++v) {
    double sum = 0.0;
    for (int k = M; k >= 0; --k) image_tails[to_index(v * (M + 1) + k)] = sum += image(k, v);
  }
  for (Entry& entry : entries_) {
    // The form, its rounding in doubles included.
    double lost = entry.form.constant.radius + 4.0 * unit * std::abs(entry.form.constant.middle.hi);
    for (const auto& [factor, slot] : entry.form.terms)
      lost += std::abs(factor) * (lost_[to_index(slot)] + rounding_ * tail(slot, 0));
    entry.lost = raised(lost + tiny);
    double all = 0.0, left_out = 0.0;
    for (int k = 0; k < static_cast<int>(entry.coefficients.size()); ++k) {
      const double size = std::abs(entry.coefficients[to_index(k)]) * powers_[to_index(k)];
      all += size, left_out += size * image_tails[to_index(entry.column * (M + 1) + std::max(M - k, 0))];
    }
    entry.size = all;
    const double spread = spread_[to_index(entry.column)];
    defect_[to_index(entry.row)] += derivative_rounding_ * all * spread + entry.lost * spread +
                                    settings_.remainder_factor * left_out;
  }
  for (double& defect : defect_) defect = raised(defect);
  return true;
}

/// J_ii at the start, and how much larger it may become.
void FormulaStep::compute_jacobian() {
  std::fill(jacobian_.begin(), jacobian_.end(), 0.0);
  for (const Entry& entry : entries_) {
    double& bound = jacobian_[to_index(entry.row * n_ + entry.column)];
    if (entry.row != entry.column) {
      bound = raised(entry.size + entry.lost);
      continue;
    }
    const double first = entry.coefficients[0];
    const double more = entry.size - std::abs(first) * (1.0 - 0x1p-40) + entry.lost + std::max(first, 0.0);
    bound = std::max(0.0, raised(more) - std::max(-first, 0.0) * (1.0 - 0x1p-40));
    bound = raised(bound);
  }
}

/// Gershgorin's circles of (J + J^T) / 2.
double FormulaStep::compute_growth() const {
  const auto n = to_index(n_);
  std::vector<double> added(n, 0.0), subtracted(n, 0.0);
  std::vector<const Entry*> places(n * n, nullptr);
  for (const Entry& entry : entries_) places[to_index(entry.row * n_ + entry.column)] = &entry;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i; j < n; ++j) {
      const Entry *a = places[i * n + j], *b = places[j * n + i];
      if (a == nullptr) std::swap(a, b);
      if (a == nullptr) continue;
      if (i == j) {
        const double first = a->coefficients[0];
        added[i] += 2.0 * (a->size - std::abs(first) * (1.0 - 0x1p-40) + a->lost + std::max(first, 0.0));
        subtracted[i] = 2.0 * std::max(-first, 0.0);
        continue;
      }
      double size = a->lost + (b == nullptr ? 0.0 : b->lost);
      const std::size_t rows = std::max(a->coefficients.size(), b == nullptr ? 0 : b->coefficients.size());
      for (std::size_t k = 0; k < rows; ++k) {
        const double one = k < a->coefficients.size() ? a->coefficients[k] : 0.0;
        const double other = b != nullptr && k < b->coefficients.size() ? b->coefficients[k] : 0.0;
        size += (std::abs(one + other) + 0x1p-52 * (std::abs(one) + std::abs(other))) * powers_[k];
      }
      added[i] += size, added[j] += size;
    }
  double largest = 0.0;
  for (std::size_t i = 0; i < n; ++i)
    largest = std::max(largest, raised(added[i]) * (1.0 + 0x1p-50) - subtracted[i] * (1.0 - 0x1p-50));
  return raised(0.5 * largest);
}

/// Along g(s) = f(P + s e), 0 <= s <= 1: |f(P + e) - f(P) - J e| is at most the largest second coefficient of g.
bool FormulaStep::add_second_order(std::vector<double>& source) {
  std::vector<double> wide(slots_.size());
  for (int s = 0; s < static_cast<int>(slots_.size()); ++s) {
    const Slot& slot = slots_[to_index(s)];
    double first = 0.0, second = 0.0;
    bool is_exact = true;   // what depends on time alone has no error
    const auto of_first = [&](int operand) {
      const double size = operand < 0 ? 0.0 : first_[to_index(operand)];
      is_exact = is_exact && size == 0.0;
      return size;
    };
    const auto of_second = [&](int operand) { return operand < 0 ? 0.0 : second_[to_index(operand)]; };
    if (!slot.is_full) continue;
    if (slot.kind == Kind::state) {
      first = spread_[to_index(slot.a)], is_exact = false;
    } else if (slot.kind == Kind::linear) {
      for (const auto& [factor, from] : slot.form.terms)
        first += std::abs(factor) * of_first(from), second += std::abs(factor) * of_second(from);
    } else if (slot.kind == Kind::scale) {
      first = slot.value.magnitude() * of_first(slot.a), second = slot.value.magnitude() * of_second(slot.a);
    } else if (slot.kind != Kind::fixed && slot.kind != Kind::time) {
      const Slopes slopes = find_slopes(s, wide);
      if (!slopes.known) return false;
      const double a = of_first(slot.a), b = of_first(slot.b);
      first = slopes.a * a + slopes.b * b;
      second = slopes.a * of_second(slot.a) + slopes.b * of_second(slot.b) + 0.5 * slopes.aa * a * a +
               slopes.ab * a * b + 0.5 * slopes.bb * b * b;
    }
    first_[to_index(s)] = is_exact ? 0.0 : raised(first);
    second_[to_index(s)] = is_exact ? 0.0 : raised(second);
    wide[to_index(s)] = raised(lost_[to_index(s)] + first_[to_index(s)]);
    if (!(wide[to_index(s)] < 0x1p60)) return false;
  }
  for (int i = 0; i < n_; ++i)
    for (const auto& [factor, slot] : rates_[to_index(i)].terms)
      source[to_index(i)] += std::abs(factor) * second_[to_index(slot)];
  return true;
}

double FormulaStep::find_width(const Guard& guard) const {
  double width = lose_form(guard.form, {.kind = Kind::linear});
  for (const auto& [factor, slot] : guard.form.terms) width += std::abs(factor) * first_[to_index(slot)];
  return raised(settings_.switch_factor * width);
}

double FormulaStep::find_certain(const std::vector<double>& sides, double length) const {
  double certain = Interval::infinity;
  for (std::size_t i = 0; i < guards_.size(); ++i)
    certain = std::min(certain, find_certain(guards_[i], sides[i], length));
  return certain;
}

/// From each time on, the guard keeps its sign as long as its tangent less half the largest second derivative does.
double FormulaStep::find_certain(const Guard& guard, double side, double length) const {
  const double end = length * margin, width = find_width(guard);
  const std::vector<double>& c = guard.coefficients;
  const int rows = static_cast<int>(c.size());
  double steepest_slope = 0.0, curvature = 0.0;   // at most |G'| and |G''|
  for (int k = 1; k < rows; ++k) {
    const double size = std::abs(c[to_index(k)]) * powers_[to_index(k)] / end;
    steepest_slope += k * size, curvature += k * (k - 1.0) * size / end;
  }
  steepest_slope = raised(steepest_slope), curvature = raised(curvature);
  const double part = (2.0 * rows + 8.0) * unit;
  double t = 0.0, first = 0.0;
  for (int attempt = 0; attempt < 400; ++attempt) {
    double value = 0.0, slope = 0.0;
    for (int k = rows - 1; k >= 1; --k) value = value * t + c[to_index(k)];
    for (int k = rows - 1; k >= 1; --k) slope = slope * t + k * c[to_index(k)];
    value = side * (c[0] + (guard.low + value * t));
    const double off = raised(width + part * (steepest_slope * t) + 2.0 * unit * std::abs(value));
    const double left = (value - off) * (1.0 - 0x1p-50);
    if (attempt == 0) first = left;
    if (!(left > 0x1p-20 * first) || !(left > 0.0)) break;
    const double least_slope = side * slope - raised(part * steepest_slope);
    const double root = std::sqrt(least_slope * least_slope + 2.0 * curvature * left);
    double step = least_slope > 0.0 ? (curvature > 0.0 ? (least_slope + root) / curvature : end)
                                    : 2.0 * left / (root - least_slope);
    step = std::min(0.9375 * step, end - t);
    for (int halving = 0; halving < 60; ++halving) {
      if (left + least_slope * step - 0.5 * curvature * step * step > 0x1p-10 * left) break;
      step *= 0.5;
    }
    if (!(left + least_slope * step - 0.5 * curvature * step * step > 0x1p-10 * left)) break;
    t += step;
    if (!(t < end * (1.0 - 0x1p-50))) return Interval::infinity;
  }
  return t * (1.0 - 0x1p-29);   // its steps meet within this part: see margin
}

double FormulaStep::find_crossing() const {
  double nearest = Interval::infinity;
  for (const Guard& guard : guards_) {
    const double slope = std::abs(guard.coefficients[1]);
    const double off = std::abs(guard.coefficients[0]) + 2.0 * find_width(guard);
    if (slope > 0.0 && off > 0.0) nearest = std::min(nearest, off / slope);
  }
  return nearest < Interval::infinity ? nearest : 0.0;
}

}  // namespace polhode::proof
