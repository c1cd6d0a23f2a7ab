#include "polhode/ode/first_root.hpp"

#include <algorithm>
#include <cmath>

#include "polhode/ode/series.hpp"

namespace polhode::ode {
namespace {

constexpr double none = 2.0;
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

}  // namespace polhode::ode
