#include "method/steps/body_stepper.hpp"

namespace polhode {
namespace {

/// L += h (L x w) and the attitude, both with the old w.
class Euler {
 public:
  static constexpr bool kick_within = true;
  static constexpr int interior = 0;

  Euler(const PrincipalBody& body, const Scene&) : body_(&body) {}

  bool advance(double h, const double* kick, double* L, double* q) {
    double w[3], gyro[3];
    for (int i = 0; i < 3; ++i) w[i] = L[i] / body_->I[i];
    cross(L, w, gyro);
    for (int i = 0; i < 3; ++i) L[i] += h * gyro[i] + kick[i], w[i] *= h;
    rotate_by_vector(w, q);
    return true;
  }

 private:
  const PrincipalBody* body_;
};

}  // namespace

const BodyMethod euler_method{
    {
        .name = "euler",
        .order = 1,
        .dense_order = 3,
        .adaptive = false,
        .comparison = true,
        .keeps = "nothing",
        .doc = "Explicit Euler, with the attitude rotated by the old rates. The energy grows until the run diverges.",
        .source = "Euler 1768, Institutionum calculi integralis 1, cap. VII",
    },
    &integrate_with<Euler>,
};

}  // namespace polhode
