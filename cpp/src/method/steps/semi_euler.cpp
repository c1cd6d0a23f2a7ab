#include "method/steps/body_stepper.hpp"

namespace polhode {
namespace {

/// L += h (L x w) with the old w, then the attitude with the new w, in the order of most engines.
class SemiEuler {
 public:
  static constexpr bool kick_within = true;
  static constexpr int interior = 0;

  SemiEuler(const PrincipalBody& body, const Scene&) : body_(&body) {}

  bool advance(double h, const double* kick, double* L, double* q) {
    double w[3], gyro[3];
    for (int i = 0; i < 3; ++i) w[i] = L[i] / body_->I[i];
    cross(L, w, gyro);
    for (int i = 0; i < 3; ++i) L[i] += h * gyro[i] + kick[i], w[i] = h * (L[i] / body_->I[i]);
    rotate_by_vector(w, q);
    return true;
  }

 private:
  const PrincipalBody* body_;
};

}  // namespace

const BodyMethod semi_euler_method{
    {
        .name = "semi_euler",
        .order = 1,
        .dense_order = 3,
        .adaptive = false,
        .comparison = true,
        .keeps = "nothing",
        .doc = "Semi-implicit Euler: the rates first, then the attitude with the new rates. The energy grows until "
               "the run diverges.",
        .source = "MuJoCo's integrator 'Euler'; Todorov, Erez & Tassa 2012, IROS, 5026",
    },
    &integrate_with<SemiEuler>,
};

}  // namespace polhode
