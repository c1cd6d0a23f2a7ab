#include "method/steps/body_stepper.hpp"

#include "polhode/math/detail/functions.hpp"

namespace polhode {
namespace {

/// Five exact rotations about the principal axes: 1 and 2 by half a step, 3 by a whole step, 2 and 1 by half a step.
class Split {
 public:
  static constexpr bool kick_within = false;
  static constexpr int interior = 0;

  Split(const PrincipalBody& body, const Scene&) : body_(&body) {}

  bool advance(double h, const double*, double* L, double* q) {
    rotate(0, 0.5 * h, L, q);
    rotate(1, 0.5 * h, L, q);
    rotate(2, h, L, q);
    rotate(1, 0.5 * h, L, q);
    rotate(0, 0.5 * h, L, q);
    return true;
  }

 private:
  /// The flow of L_i^2 / (2 I_i): the body rotates about axis i by a = h L_i / I_i, and L by -a.
  void rotate(int i, double h, double* L, double* q) const {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const auto [s, c] = math::sincos(0.5 * h * (L[i] / body_->I[i]));
    const double sin_a = 2 * s * c, cos_a = 1 - 2 * s * s, Lj = L[j];
    L[j] = cos_a * Lj + sin_a * L[k];
    L[k] = cos_a * L[k] - sin_a * Lj;
    double p[4] = {0, 0, 0, c};
    p[i] = s;
    rotate_by(p, q);
  }

  const PrincipalBody* body_;
};

}  // namespace

const BodyMethod split_method{
    {
        .name = "split",
        .order = 2,
        .dense_order = 3,
        .adaptive = false,
        .comparison = true,
        .keeps = "|L|, L",
        .doc = "Three-rotation splitting. It is symplectic, L in space is conserved, and the energy error stays "
               "bounded.",
        .source = "Reich 1994, Physica D 76, 375; Dullweber, Leimkuhler & McLachlan 1997, J. Chem. Phys. 107, 5840",
    },
    &integrate_with<Split>,
};

}  // namespace polhode
