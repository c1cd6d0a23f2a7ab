#include "method/steps/body_stepper.hpp"

namespace polhode {
namespace {

/// L + h (L x w), scaled to the length of L. The energy tends to L^2 / (2 I2) from any start.
class Jolt {
 public:
  static constexpr bool kick_within = true;
  static constexpr int interior = 0;

  Jolt(const PrincipalBody& body, const Scene&) : body_(&body) {}

  bool advance(double h, const double* kick, double* L, double* q) {
    double w[3], N[3];
    for (int i = 0; i < 3; ++i) w[i] = L[i] / body_->I[i];
    cross(L, w, N);
    for (int i = 0; i < 3; ++i) N[i] = L[i] + h * N[i];
    const double old_size = L[0] * L[0] + L[1] * L[1] + L[2] * L[2], size = N[0] * N[0] + N[1] * N[1] + N[2] * N[2];
    const double scale = size > 0.0 ? std::sqrt(old_size / size) : 1.0;
    double rotation[3];
    for (int i = 0; i < 3; ++i) L[i] = N[i] * scale + kick[i], rotation[i] = h * (L[i] / body_->I[i]);
    rotate_by_vector(rotation, q);
    return true;
  }

 private:
  const PrincipalBody* body_;
};

}  // namespace

const BodyMethod jolt_method{
    {
        .name = "jolt",
        .order = 1,
        .dense_order = 3,
        .adaptive = false,
        .comparison = true,
        .keeps = "|L|",
        .doc = "The explicit gyroscopic step with |L| restored. The body ends up rotating about its intermediate axis.",
        .source = "Jolt Physics, MotionProperties::ApplyGyroscopicForceInternal; avian, pull request 738",
    },
    &integrate_with<Jolt>,
};

}  // namespace polhode
