#include "solve/effect/shares.hpp"

#include <algorithm>
#include <cmath>

#include "polhode/math/detail/functions.hpp"
#include "solve/effect/norms.hpp"

namespace polhode::effect {
namespace {

using torques::Window;

/// Time within the windows, of the cells of one phase that precede a time.
struct PhaseTime {
  double all = 0.0;      ///< [s]
  double repeated = 0.0;   ///< times the number of periods that remain
  double later = 0.0;    ///< of those with a period or more that remain
};

/// The acting time of a torque by the phase of the cells.
class ActingTime {
 public:
  ActingTime(const FreeTable& table, const std::vector<Window>& windows, double t0, int direction) : table_(table) {
    constexpr int most_walked = 200'000;   // cells: of longer spans the windows are not used
    windowed_ = !windows.empty() && table.all_cells() <= most_walked;
    if (!windowed_) return;
    whole_.resize(static_cast<std::size_t>(table.cells()));
    last_.assign(whole_.size(), 0.0);
    for (const Window& window : windows) {
      const double begin = direction > 0 ? window.begin - t0 : t0 - window.end;
      const double end = direction > 0 ? window.end - t0 : t0 - window.begin;
      add(std::max(begin, 0.0), std::min(end, table.span()));
    }
  }

  bool is_windowed() const { return windowed_; }

  /// Before the end of cell `until`, one of the last period, in cells of a phase.
  PhaseTime at(int phase, int until) const {
    if (phase > until) return {};
    const int n = table_.cells();
    const double before = (until - phase) / n;   // whole periods
    if (!windowed_) {
      const double h = table_.width();
      return {(before + 1.0) * h, 0.5 * before * (before + 1.0) * h, before * h};
    }
    const auto i = static_cast<std::size_t>(phase);
    PhaseTime time = whole_[i];
    if ((table_.all_cells() - 1 - phase) / n > (until - phase) / n) {   // its last cell comes later
      time.all -= last_[i];
      time.repeated -= time.all;
    }
    time.all = std::max(time.all, 0.0), time.repeated = std::max(time.repeated, 0.0);
    time.later = before > 0.0 ? time.all : 0.0;
    return time;
  }

 private:
  void add(double begin, double end) {
    if (!(begin < end)) return;
    const int n = table_.cells(), all = table_.all_cells();
    const double h = table_.width();
    const int first = std::min(static_cast<int>(begin / h), all - 1);
    for (int cell = first; cell < all && h * cell < end; ++cell) {
      const double time = std::min(end, h * (cell + 1)) - std::max(begin, h * cell);
      if (!(time > 0.0)) continue;
      const auto phase = static_cast<std::size_t>(cell % n);
      const int remaining = (all - 1 - cell) / n;
      whole_[phase].all += time, whole_[phase].repeated += time * remaining;
      if (remaining == 0) last_[phase] += time;
    }
  }

  const FreeTable& table_;
  bool windowed_ = false;
  std::vector<PhaseTime> whole_;   // until the end of the span
  std::vector<double> last_;       // of the last cell of a phase
};

/// The largest of the integrals up to the cells of the last period.
class Sum {
 public:
  Sum(const FreeTable& table, const ActingTime& time, const std::vector<double>& sizes)
      : table_(table), time_(time), sizes_(sizes) {}

  double most(Passage of) const {
    const int n = table_.cells(), last = table_.all_cells() - 1;
    const bool rotates = of == rotation_of_momentum || of == rotation_of_state;
    const FreeBody& body = table_.body();
    // Over whole periods the direction of the angular momentum turns, too: |(1 - E) dl| <= 2 |dL| / L.
    const double tilt = !rotates ? 0.0 : (of == rotation_of_state ? std::sqrt(body.greatest) : 1.0) * 2.0 / body.L;
    double most = 0.0;
    for (int until = std::max(0, last - n + 1); until <= last; ++until) {
      double sum = 0.0;
      for (int i = 0; i < std::min(n, until + 1); ++i) {
        const PhaseTime time = time_.at(i, until);
        const int later = (until - i) % n;
        double one = time.all * table_.norms(of, i)[later];
        if (table_.is_periodic()) one += time.repeated * table_.slopes(of, i)[later] + time.later * tilt;
        sum += sizes_[static_cast<std::size_t>(i)] * one;
      }
      most = std::max(most, sum);
    }
    return most;
  }

  PhaseTime whole() const {
    PhaseTime sum;
    for (int i = 0; i < table_.cells(); ++i) {
      const PhaseTime time = time_.at(i, table_.all_cells() - 1);
      const double size = sizes_[static_cast<std::size_t>(i)];
      sum.all += size * time.all, sum.repeated += size * time.repeated;
    }
    return sum;
  }

 private:
  const FreeTable& table_;
  const ActingTime& time_;
  const std::vector<double>& sizes_;
};

/// What the norms between the middles of cells miss: a factor, and a rotation within the cell.
struct Within {
  double factor, rotation;
};
/// @param growth  of changes of the source, which may act at any time of a cell, or evenly [1/s]
Within cover_cell(double growth, double width, bool evenly) {
  const double half = 0.5 * growth * width, mean = mean_growth(half);
  return evenly ? Within{mean, 0.25 * width * mean} : Within{math::exp(half), 0.5 * width * mean};
}

Integrals gather(const FreeTable& table, const ActingTime& time, const std::vector<double>& sizes) {
  if (std::all_of(sizes.begin(), sizes.end(), [](double size) { return size == 0.0; })) return {};
  const Sum sum(table, time, sizes);
  const FreeBody& body = table.body();
  const Within within = cover_cell(body.momentum_growth, table.width(), !time.is_windowed());
  const double half = 0.5 * table.width();
  Integrals found;
  found.first_rate = sum.most(rate_of_momentum), found.first_rotation = sum.most(rotation_of_momentum);
  const PhaseTime whole = sum.whole();
  found.whole = whole.all, found.repeated = whole.repeated;
  found.rate = math::exp(body.rate_growth * half) * within.factor * found.first_rate;
  found.state = math::exp(body.growth * half) * within.factor * sum.most(state_of_momentum);
  found.rotation = within.factor * found.first_rotation + within.rotation * whole.all / body.least + half * found.rate;
  return found;
}

}  // namespace

Integrals& Integrals::operator+=(const Integrals& other) {
  rate += other.rate, state += other.state, rotation += other.rotation;
  whole += other.whole, repeated += other.repeated;
  first_rate += other.first_rate, first_rotation += other.first_rotation;
  return *this;
}

Integrals operator*(double factor, const Integrals& of) {
  return {factor * of.rate,   factor * of.state,      factor * of.rotation,      factor * of.whole,
          factor * of.repeated, factor * of.first_rate, factor * of.first_rotation};
}

Share integrate(const FreeTable& table, const TorqueSize& size, const Matrix3d& axes, double t0, int direction) {
  const ActingTime time(table, size.windows, t0, direction);
  const auto n = static_cast<std::size_t>(table.cells());
  std::vector<double> sizes(n, size.fixed);
  const FreeBody& body = table.body();
  if (size.per_rate > 0.0) {
    // From the middle of a cell y moves by at most c Y^2 h / 2.
    const double most = size.per_rate * body.most_rate;
    const double change = size.per_rate * (0.5 * table.width() * body.growth * body.Y / std::sqrt(body.least));
    for (std::size_t i = 0; i < n; ++i)
      sizes[i] += std::min(most, (size.matrix * (axes * table.rates(static_cast<int>(i)))).norm() + change);
  }
  Share share;
  share.fixed = gather(table, time, sizes);
  if (size.per_rate > 0.0) share.per_rate = gather(table, time, std::vector<double>(n, size.per_rate));
  return share;
}

Integrals integrate_unit(const FreeTable& table) {
  const ActingTime always(table, {}, 0.0, 1);
  const std::vector<double> ones(static_cast<std::size_t>(table.cells()), 1.0);
  const Sum sum(table, always, ones);
  const FreeBody& body = table.body();
  const Within within = cover_cell(body.growth, table.width(), true);
  const double half = 0.5 * table.width();
  Integrals found;
  found.whole = sum.whole().all;
  found.rate = math::exp(body.rate_growth * half) * within.factor * sum.most(rate_of_state);
  found.state = math::exp(body.growth * half) * within.factor * sum.most(state_of_state);
  found.rotation = within.factor * sum.most(rotation_of_state) +
                   within.rotation * found.whole / std::sqrt(body.least) + half * found.rate;
  return found;
}

}  // namespace polhode::effect
