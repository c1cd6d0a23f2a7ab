#pragma once

#include <vector>

namespace polhode::proof {

/// A bound that was computed with rounding to nearest from numbers that are not negative: fewer than 2^20 sums,
/// products and quotients of them are wrong by less than this in all, underflow included while all are below 2^60.
inline double raised(double x) { return x * (1.0 + 0x1p-30) + 0x1p-900; }

/// Where the exact state may lie around a computed one: all vectors B x with |x_i| <= radius_i. B is nearly orthogonal
/// and turns with the error, so that the set does not grow by being boxed in fixed axes again and again.
/// Lohner 1987, in: Computer Arithmetic, Scientific Computation and Programming Languages; Nedialkov, Jackson & Corliss
/// 1999, Appl. Math. Comput. 105, 21, section 5.
class ErrorSet {
 public:
  explicit ErrorSet(std::vector<double> radii);

  /// At least |e_i| for every e of the set.
  std::vector<double> box() const;

  /// At least |(M e)_i| for every e of the set; M is (n, width), by rows, and wrong by at most `slack` in (M B) x.
  std::vector<double> image_box(const std::vector<double>& M, int width, const std::vector<double>& slack) const;

  /// Replaces every e by M e + r with |r_i| <= rest_i.
  void advance(const std::vector<double>& M, int width, const std::vector<double>& rest);

 private:
  std::vector<double> times_basis(const std::vector<double>& M, int width) const;

  int n_;
  std::vector<double> basis_;    ///< B by rows
  std::vector<double> radius_;
};

}  // namespace polhode::proof
