#include <doctest/doctest.h>

#include <array>
#include <cmath>

#include "polhode/ode/tableaus/dormand_prince54.hpp"

using namespace polhode::ode::tableaus;

namespace {

// The order conditions as rooted trees: Hairer, Norsett, Wanner 1993, Solving ODEs I, sec. II.2, table 2.2. Each is a
// vector Phi over the stages with sum b Phi = 1/gamma.
template <class T>
struct Conditions {
  using Vector = std::array<double, T::stages>;

  static Vector apply(const Vector& v) {   // sum_j a_ij v_j
    Vector out{};
    for (int i = 0; i < T::stages; ++i)
      for (int j = 0; j < i; ++j) out[static_cast<std::size_t>(i)] += T::a[i][j] * v[static_cast<std::size_t>(j)];
    return out;
  }
  static Vector times(const Vector& a, const Vector& b) {
    Vector out{};
    for (std::size_t i = 0; i < a.size(); ++i) out[i] = a[i] * b[i];
    return out;
  }
  static double worst(const Vector& b, int order) {
    Vector one{}, c{};
    for (std::size_t i = 0; i < one.size(); ++i) one[i] = 1.0, c[i] = T::c[i];
    const Vector c2 = times(c, c), c3 = times(c2, c), ac = apply(c), ac2 = apply(c2), aac = apply(ac);
    double largest = 0.0;
    const auto check = [&](const Vector& phi, double gamma) {
      double sum = 0.0;
      for (std::size_t i = 0; i < phi.size(); ++i) sum += b[i] * phi[i];
      largest = std::fmax(largest, std::abs(sum - 1.0 / gamma));
    };
    check(one, 1);
    if (order >= 2) check(c, 2);
    if (order >= 3) check(c2, 3), check(ac, 6);
    if (order >= 4) check(c3, 4), check(times(c, ac), 8), check(ac2, 12), check(aac, 24);
    if (order >= 5) {
      check(times(c3, c), 5), check(times(c2, ac), 10), check(times(ac, ac), 20), check(times(c, ac2), 15);
      check(apply(c3), 20), check(times(c, aac), 30), check(apply(times(c, ac)), 40), check(apply(ac2), 60);
      check(apply(aac), 120);
    }
    return largest;
  }
};

}  // namespace

TEST_CASE_TEMPLATE("a tableau meets its order conditions, its lower formula only its own", T, DormandPrince54) {
  using C = Conditions<T>;
  typename C::Vector b{}, lower{};
  for (int i = 0; i < T::stages; ++i) {
    const auto k = static_cast<std::size_t>(i);
    b[k] = i + 1 < T::stages ? T::a[T::stages - 1][i] : 0.0;
    lower[k] = b[k] - T::error[i];
    double row = 0.0;
    for (int j = 0; j + 1 < T::stages; ++j) row += T::a[i][j];
    CHECK(std::abs(row - T::c[i]) < 1e-15);
  }
  CHECK(C::worst(b, T::order) < 1e-15);
  CHECK(C::worst(lower, T::error_order) < 1e-15);
  CHECK(C::worst(lower, T::error_order + 1) > 1e-5);
}
