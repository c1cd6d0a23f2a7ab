#include "batch/summary/reducer.hpp"

#include <cmath>
#include <limits>

namespace polhode::summary {
namespace {

using Of = SummaryQuantity::Of;

std::size_t planes_of(Of of) { return of == Of::attitude ? 4 : 1; }
std::size_t sums_of(Of of) { return of == Of::attitude ? 10 : 2; }

}  // namespace

std::size_t count_bins(const SummaryQuantity& quantity) {
  if (quantity.of == Of::attitude) return 0;
  const auto one_sign = static_cast<std::size_t>(Summary::bins_of_octave * (quantity.last - quantity.first)) + 2;
  return quantity.of == Of::value ? 2 * one_sign - 1 : one_sign;
}

Layout::Layout(const std::vector<SummaryQuantity>& quantities, const std::vector<std::vector<double>>& given,
               std::size_t n)
    : times(n), row(padded(n)) {
  for (std::size_t k = 0; k < quantities.size(); ++k) {
    const SummaryQuantity& q = quantities[k];
    entries.push_back({&q, &given[k], planes, rows, values, count_bins(q)});
    planes += planes_of(q.of), rows += sums_of(q.of), values += q.of == Of::value;
    needs_omega |= q.of == Of::omega || q.of == Of::energy;
    needs_attitude |= q.of == Of::angle || q.of == Of::axis_angle || q.of == Of::attitude;
  }
}

Summary::Totals Layout::make_totals() const {
  const std::size_t n = entries.size() * row;
  const double infinity = std::numeric_limits<double>::infinity();
  Summary::Totals totals;
  totals.count.assign(n, 0.0), totals.least.assign(n, infinity), totals.largest.assign(n, -infinity);
  for (const Entry& e : entries) totals.bins.emplace_back(e.bins == 0 ? 0 : times * (e.bins + 1), 0u);
  return totals;
}

Reducer::Reducer(const Layout& layout)
    : layout_(layout), omega_(3 * span), attitude_(4 * span), numbers_(layout.planes * tile * span) {}

void Reducer::measure(std::size_t i, std::size_t from, std::size_t n, const double* tensor, const double* values) {
  const Kernels& k = kernels();
  const std::size_t whole = padded(n);   // what stands beyond n is never counted
  for (const Layout::Entry& e : layout_.entries) {
    const SummaryQuantity& q = *e.quantity;
    double* to = plane_of(e.plane, i, planes_of(q.of));
    const std::size_t components = q.of == Of::axis_angle ? 3 : 4, stride = e.planes->size() / components;
    const bool constant = stride == lanes && q.reference.size() == components;
    const TimeVectors reference{e.planes->data() + (constant ? 0 : from), stride, constant ? std::size_t{0} : 1};
    switch (q.of) {
      case Of::angle: k.angle(attitude_.data(), reference, whole, to); break;
      case Of::axis_angle: k.axis_angle(attitude_.data(), q.axis.data(), reference, whole, to); break;
      case Of::omega: k.rate(omega_.data(), whole, to); break;
      case Of::energy: k.energy(omega_.data(), tensor, whole, to); break;
      case Of::attitude: k.deviation(attitude_.data(), reference, whole, to, span); break;
      case Of::value:
        for (std::size_t j = 0; j < n; ++j) to[j] = values[(from + j) * layout_.values + e.value];
        break;
    }
  }
}

void Reducer::leave_out(std::size_t i, std::size_t at) {
  for (const Layout::Entry& e : layout_.entries) {
    const std::size_t width = planes_of(e.quantity->of);
    for (std::size_t c = 0; c < width; ++c)
      plane_of(e.plane, i, width)[c * span + at] = std::numeric_limits<double>::quiet_NaN();
  }
}

void Reducer::add(std::size_t bodies, std::size_t from, std::size_t n, Summary::Totals& totals,
                  Summary::Sums& sums) const {
  for (std::size_t q = 0; q < layout_.entries.size(); ++q) {
    const Layout::Entry& e = layout_.entries[q];
    const std::size_t at = q * layout_.row + from;
    const double* numbers = numbers_.data() + e.plane * tile * span;
    double* sum = sums.data() + e.sums * layout_.row + from;
    if (e.quantity->of == Of::attitude) {
      kernels().add_products(numbers, bodies, n, totals.count.data() + at, sum, layout_.row);
      continue;
    }
    const std::size_t row = e.bins + 1;
    kernels().add(numbers, bodies, n,
                  ScalarSums{totals.count.data() + at, sum, sum + layout_.row, totals.least.data() + at,
                             totals.largest.data() + at, totals.bins[q].data() + from * row, row,
                             std::ldexp(1.0, e.quantity->first), std::ldexp(1.0, e.quantity->last),
                             e.quantity->of == Of::value});
  }
}

}  // namespace polhode::summary
