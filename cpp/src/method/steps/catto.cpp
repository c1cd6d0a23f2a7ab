#include <Eigen/LU>

#include "method/steps/body_stepper.hpp"

namespace polhode {
namespace {

/// One Newton step of implicit Euler from the old rates: w -= J^-1 f, f = h w x I w, J = I + h ([w] I - [I w]).
class Catto {
 public:
  static constexpr bool kick_within = true;
  static constexpr int interior = 0;

  Catto(const PrincipalBody& body, const Scene&) : body_(&body) {}

  bool advance(double h, const double* kick, double* L, double* q) {
    const double* I = body_->I;
    double w[3];
    for (int i = 0; i < 3; ++i) w[i] = L[i] / I[i];
    Matrix3d J;
    J << I[0], h * (L[2] - w[2] * I[1]), h * (w[1] * I[2] - L[1]),  //
        h * (w[2] * I[0] - L[2]), I[1], h * (L[0] - w[0] * I[2]),   //
        h * (L[1] - w[1] * I[0]), h * (w[0] * I[1] - L[0]), I[2];
    const Vector3d f{h * (w[1] * L[2] - w[2] * L[1]), h * (w[2] * L[0] - w[0] * L[2]), h * (w[0] * L[1] - w[1] * L[0])};
    const Vector3d change = J.inverse() * f;
    double rotation[3];
    for (int i = 0; i < 3; ++i) L[i] += kick[i] - I[i] * change[i], rotation[i] = h * (L[i] / I[i]);
    rotate_by_vector(rotation, q);
    return true;
  }

 private:
  const PrincipalBody* body_;
};

}  // namespace

const BodyMethod catto_method{
    {
        .name = "catto",
        .order = 1,
        .dense_order = 3,
        .adaptive = false,
        .implicit = true,
        .comparison = true,
        .keeps = "nothing",
        .doc = "Catto's implicit gyroscopic step, one Newton step of implicit Euler. It never diverges, but loses "
               "energy and |L|.",
        .source =
            "Catto 2015, GDC, Numerical Methods; Bullet computeGyroscopicImpulseImplicit_Body; MuJoCo implicitfast",
    },
    &integrate_with<Catto>,
};

}  // namespace polhode
