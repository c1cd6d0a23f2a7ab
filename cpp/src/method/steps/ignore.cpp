#include "method/steps/body_stepper.hpp"

namespace polhode {
namespace {

/// Leaves out the term L x w, so that without a torque omega is constant in body axes and in space axes.
class Ignore {
 public:
  static constexpr bool kick_within = true;
  static constexpr int interior = 0;

  Ignore(const PrincipalBody& body, const Scene&) : body_(&body) {}

  bool advance(double h, const double* kick, double* L, double* q) {
    double rotation[3];
    for (int i = 0; i < 3; ++i) L[i] += kick[i], rotation[i] = h * (L[i] / body_->I[i]);
    rotate_by_vector(rotation, q);
    return true;
  }

 private:
  const PrincipalBody* body_;
};

}  // namespace

const BodyMethod ignore_method{
    {
        .name = "ignore",
        .order = 0,
        .dense_order = 3,
        .adaptive = false,
        .comparison = true,
        .keeps = "energy, |L|",
        .doc = "No gyroscopic term, as in many engines by default. It solves the wrong equations at any step size.",
        .source = "Bullet, Box2D, Jolt and others with the term switched off; Catto 2015, GDC, Numerical Methods",
    },
    &integrate_with<Ignore>,
};

}  // namespace polhode
