#include "polhode/ode/first_root.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "polhode/ode/series.hpp"

namespace polhode::ode {
namespace {

constexpr double none = 2.0;
constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double least_half = 1.0 / 4096;   // of an interval

class RootSearch {
 public:
  RootSearch(const double* a, int degree) : a_(a), degree_(degree) {}

  /// The first zero in [begin, end], where p(begin) > 0.
  double search(double begin, double end) const {
    const double middle = 0.5 * (begin + end), half = 0.5 * (end - begin);
    double c[most_series_order + 1];
    shift(middle, c);
    double range = 0.0, slopes = 0.0, power = half;
    for (int k = 1; k <= degree_; ++k, power *= half) {
      range += std::abs(c[k]) * power;
      if (k > 1) slopes += k * std::abs(c[k]) * power / half;
    }
    if (c[0] > range) return none;
    const bool falls = std::abs(c[1]) > slopes;   // or rises, all the way
    if (falls) return value(end) > 0.0 ? none : bisect(begin, end);
    if (half > least_half) {
      const double first = search(begin, middle);
      return first <= 1.0 ? first : search(middle, end);
    }
    // Next to an extreme value: its parabola.
    double lowest = middle;
    if (c[2] > 0.0) lowest = std::clamp(middle - 0.5 * c[1] / c[2], begin, end);
    for (const double u : {lowest, end})
      if (!(value(u) > 0.0) && u > begin) return bisect(begin, u);
    return none;
  }

 private:
  double value(double u) const {
    double sum = a_[degree_];
    for (int k = degree_; k-- > 0;) sum = sum * u + a_[k];
    return sum;
  }

  void shift(double by, double* c) const {
    std::copy_n(a_, degree_ + 1, c);
    for (int i = 0; i < degree_; ++i)
      for (int k = degree_ - 1; k >= i; --k) c[k] += by * c[k + 1];
  }

  double bisect(double begin, double end) const {
    for (int i = 0; i < 60 && end - begin > 0x1p-53 * end; ++i) {
      const double middle = 0.5 * (begin + end);
      (value(middle) > 0.0 ? begin : end) = middle;
    }
    return end;
  }

  const double* a_;
  int degree_;
};

}  // namespace

double find_first_root(const double* a, int degree) {
  double rest = 0.0;
  for (int k = 1; k <= degree; ++k) rest += std::abs(a[k]);
  if (a[0] > rest || degree == 0) return none;
  if (a[0] == 0.0) return find_first_root(a + 1, degree - 1);
  return RootSearch(a, degree).search(0.0, 1.0);
}

double find_lowest(const double* a, int degree, double limit) {
  const auto value = [&](double u) {
    double sum = a[degree];
    for (int k = degree; k-- > 0;) sum = sum * u + a[k];
    return sum;
  };
  double begin = 0.0;
  if (a[0] > limit) {
    double lowered[most_series_order + 1];
    std::copy_n(a, degree + 1, lowered);
    lowered[0] -= limit;
    begin = find_first_root(lowered, degree);
    if (begin > 1.0) return 2.0;
  }
  constexpr int parts = 32;
  const double width = (1.0 - begin) / parts;
  double values[parts + 1];
  for (int i = 0; i <= parts; ++i) values[i] = value(begin + i * width);
  int best = parts;
  for (int i = a[0] == 0.0 ? 1 : 0; i < parts; ++i)   // a guard may leave its surface
    if (values[i] < values[best] && (i == 0 || values[i] <= values[i - 1])) best = i;
  if (!(values[best] < limit)) return 2.0;
  if (best == 0 || best == parts) return best == 0 ? begin : 1.0;
  const double bend = values[best - 1] - 2 * values[best] + values[best + 1];
  return begin + (best + (bend > 0.0 ? 0.5 * (values[best - 1] - values[best + 1]) / bend : 0.0)) * width;
}

double polish_root(const std::function<double(double)>& value, const double* a, int degree, double root) {
  constexpr int most = 60;
  double u = root, low = 0.0, high = 2.0, reach = 0x1p-50;
  const double least = a[0] == 0.0 ? 0.5 * root : 0.0;   // behind a zero at 0 the function may be rounding alone
  for (int i = 0; i < most && high - low > 2 * epsilon * low; ++i) {
    const double now = value(u);
    (now > 0.0 ? low : high) = u;
    if (high <= least) return root;
    if (low >= 1.0) return 2.0;
    double slope = 0.0;
    for (int k = degree; k > 0; --k) slope = slope * u + k * a[k];
    const double step = slope < 0.0 ? -now / slope : 2.0;
    reach = std::max(4 * reach, 2 * std::abs(step));
    double next = u + step;
    // Next to the zero it stepsilon over it, so that both ends of the bracket close in.
    if (high > 1.0) next = std::min(u + std::max(step, reach), 1.0);
    else if (low == 0.0) next = std::max(u - std::max(-step, reach), least);
    else if (std::abs(step) < 2 * epsilon * u) next = now > 0.0 ? u + 2 * epsilon * u : u - 2 * epsilon * u;
    if (!(next > low && next < high)) next = high > 1.0 ? 1.0 : 0.5 * (low + high);
    u = next;
  }
  return high;
}

}  // namespace polhode::ode
