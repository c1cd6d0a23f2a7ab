#include "method/steps/body_stepper.hpp"

#include "polhode/step.hpp"

namespace polhode {
namespace {

/// The exact free motion in closed form, by a series that ends: polhode/step.hpp.
class Free {
 public:
  static constexpr bool kick_within = false;
  static constexpr int interior = 10;

  Free(const PrincipalBody& body, const Scene&) : inertia_(step::make_inertia(body.I[0], body.I[1], body.I[2])) {}

  bool advance(double h, const double*, double* L, double* q) {
    step::Vec<double> L_P{L[0], L[1], L[2]};
    step::Quat<double> q_WP{q[0], q[1], q[2], q[3]};
    step::drift_body(inertia_, h, L_P, q_WP);
    L[0] = L_P.x, L[1] = L_P.y, L[2] = L_P.z;
    q[0] = q_WP.x, q[1] = q_WP.y, q[2] = q_WP.z, q[3] = q_WP.w;
    return true;
  }

 private:
  step::Inertia<double> inertia_;
};

}  // namespace

const BodyMethod free_method{
    {
        .name = "free",
        .order = 12,
        .driven_order = 2,
        .dense_order = 12,
        .adaptive = false,
        .comparison = true,
        .keeps = "energy, |L|, L",
        .doc = "The free motion in closed form, with series of five terms. It conserves energy and L of a free body at "
               "any step.",
        .source = "DLMF 23.9, 23.10; Whittaker & Watson, A Course of Modern Analysis, sec. 23.7; polhode/step.hpp",
    },
    &integrate_with<Free>,
};

}  // namespace polhode
