#pragma once

#include <vector>

#include "solve/proof/basis.hpp"

namespace polhode::proof {

/// Where the exact state may lie around a computed one: all sums over j of B_j x_j with |x_ji| <= radius_ji.
///
/// The matrices B_j follow the motion's derivative, so that the set rotates, shears and stretches with the motion and is
/// not boxed in fixed axes at each step. The last B_j takes up what each step adds; where its inverse becomes large a
/// new one begins. The smallest two are merged, in an orthogonal basis, where there are too many.
/// Sums of parallelepipeds: Kuehn 1998, Computing 61, 47. Orthogonal bases: Lohner 1987, in: Computer Arithmetic,
/// Scientific Computation and Programming Languages; Nedialkov, Jackson & Corliss 1999, Appl. Math. Comput. 105, 21,
/// section 5.
class ErrorSet {
 public:
  explicit ErrorSet(const std::vector<double>& radii);

  /// At least |e_i| for every e of the set.
  std::vector<double> box() const;

  /// At least |(M e)_i| for every e of the set; M is (n, width), by rows, and slack_i bounds the rounding of (M e)_i.
  std::vector<double> image_box(const std::vector<double>& M, int width, const std::vector<double>& slack) const;

  /// Replaces every e by M e + r with |r_i| <= rest_i.
  void advance(const std::vector<double>& M, int width, const std::vector<double>& rest);

 private:
  struct Part {
    std::vector<double> basis;    ///< B_j by rows
    std::vector<double> radius;
  };

  std::vector<double> multiply(const std::vector<double>& M, int width, const std::vector<double>& B) const;
  void add_box(const Part& part, std::vector<double>& sums) const;
  Part make_box(const std::vector<double>& radii) const;
  bool absorb(const std::vector<double>& rest);
  void merge_smallest();
  Part merge(const Part& first, const Part& second) const;

  std::size_t n_;
  std::vector<Part> parts_;
};

}  // namespace polhode::proof
