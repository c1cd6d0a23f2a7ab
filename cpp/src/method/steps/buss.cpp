#include "method/steps/body_stepper.hpp"

namespace polhode {
namespace {

/// The rotation vector h w + h^2/2 a + h^3/12 a x w, with a = w' at the start. L is constant in space, so in the body
/// it rotates backwards.
class Buss {
 public:
  static constexpr bool kick_within = false;
  static constexpr int interior = 0;

  Buss(const PrincipalBody& body, const Scene&) : body_(&body) {}

  bool advance(double h, const double*, double* L, double* q) {
    double w[3], a[3], aw[3], rotation[3], p[4];
    for (int i = 0; i < 3; ++i) w[i] = L[i] / body_->I[i];
    cross(L, w, a);
    for (int i = 0; i < 3; ++i) a[i] /= body_->I[i];
    cross(a, w, aw);
    for (int i = 0; i < 3; ++i) rotation[i] = h * (w[i] + h * (0.5 * a[i] + h / 12 * aw[i]));
    exponential(rotation, p);
    rotate_by(p, q);
    rotate_back(p, L);
    return true;
  }

 private:
  const PrincipalBody* body_;
};

}  // namespace

const BodyMethod buss_method{
    {
        .name = "buss",
        .order = 2,
        .dense_order = 3,
        .adaptive = false,
        .comparison = true,
        .keeps = "|L|, L",
        .doc =
            "Buss's augmented second-order step, with L constant in space. The energy grows until the body rotates "
            "about its axis of least moment.",
        .source = "Buss 2000, J. Comput. Phys. 164, 377; JSBSim eBuss2",
    },
    &integrate_with<Buss>,
};

}  // namespace polhode
