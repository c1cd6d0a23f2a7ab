#include "method/steps/body_stepper.hpp"

namespace polhode {
namespace {

/// The modified moments J with which the discrete Moser-Veselov step has order 4, 6 or 8; with J = I it has order 2.
/// 1/J = s/I + d, where s and d are series in C = h^2 |L|^2 / 2 and H = h^2 L.w / 2. Hairer & Vilmart 2006, J. Phys. A
/// 39, 13225, theorem 3.
template <int order>
void preprocess(const double* I, double h, const double* L, double* J) {
  if constexpr (order == 2) {
    for (int i = 0; i < 3; ++i) J[i] = I[i];
    return;
  }
  const double a = I[0], b = I[1], c = I[2], D = a * b * c;
  double LL = 0, Lw = 0;
  for (int i = 0; i < 3; ++i) LL += L[i] * L[i], Lw += L[i] * (L[i] / I[i]);
  const double C = 0.5 * h * h * LL, H = 0.5 * h * h * Lw;
  const double S1 = a + b + c, S2 = a * a + b * b + c * c, S3 = a * a * a + b * b * b + c * c * c;
  const double X1 = 1 / a + 1 / b + 1 / c, X2 = 1 / (a * a) + 1 / (b * b) + 1 / (c * c);
  const double X3 = 1 / (a * a * a) + 1 / (b * b * b) + 1 / (c * c * c);
  const double X = (a + b) / c + (b + c) / a + (c + a) / b;
  double s = 1 + S1 / (6 * D) * C - X1 / 3 * H;
  double d = -1 / (3 * D) * C + S1 / (6 * D) * H;
  if constexpr (order >= 6) {
    s += (S2 / D - X1) / (30 * D) * C * C + (1 - X) / (30 * D) * C * H + (3 * S1 / D + 2 * X2) / 60 * H * H;
    d += -S1 / (60 * D * D) * C * C + (X1 / (10 * D) - S2 / (60 * D * D)) * C * H - (9 + X) / (60 * D) * H * H;
  }
  if constexpr (order >= 8) {
    const double P = (a + b) / (c * c) + (b + c) / (a * a) + (c + a) / (b * b);
    const double R = (a * a + b * b) / c + (b * b + c * c) / a + (c * c + a * a) / b;
    const double D2 = D * D, D3 = D2 * D;
    s += (4 * D + 17 * S3 - 15 * D * X) / (2520 * D3) * C * C * C +
         (9 * S1 + 10 * D * X2 - 6 * R) / (420 * D2) * C * C * H +
         ((6 * P - 100 * X1) * D + 53 * S2) / (2520 * D2) * C * H * H + (15 - D * X3 - 2 * X) / (630 * D) * H * H * H;
    d += (34 * D * X1 - 19 * S2) / (2520 * D3) * C * C * C + (S3 + 2 * D * X - 85 * D) / (1260 * D3) * C * C * H +
         (47 * S1 + 13 * R - 38 * D * X2) / (2520 * D2) * C * H * H +
         (9 * D * X1 + D * P - 11 * S2) / (1260 * D2) * H * H * H;
  }
  for (int i = 0; i < 3; ++i) J[i] = 1 / (s / I[i] + d);
}

/// Solves J x + x x (J x) = (h/2) L (1 + |x|^2). The body rotates by the quaternion (x, 1) / norm, which also
/// transforms L to the new body axes. Moser & Veselov 1991.
template <int order>
class Dmv {
 public:
  static constexpr bool kick_within = false;
  static constexpr int interior = order == 2 ? 0 : order - 2;

  Dmv(const PrincipalBody& body, const Scene&) : body_(&body) {}

  bool advance(double h, const double*, double* L, double* q) {
    if (h != h_ || body_->driven())
      preprocess<order>(body_->I, h, L, J_);   // a free body conserves both arguments
    h_ = h;
    const double g[3] = {(J_[1] - J_[2]) / J_[0], (J_[2] - J_[0]) / J_[1], (J_[0] - J_[1]) / J_[2]};
    const double u[3] = {0.5 * h * L[0] / J_[0], 0.5 * h * L[1] / J_[1], 0.5 * h * L[2] / J_[2]};
    double x[3] = {u[0], u[1], u[2]}, last = std::numeric_limits<double>::infinity();
    const double size = std::abs(u[0]) + std::abs(u[1]) + std::abs(u[2]);
    double A = 1.0;
    for (int n = 0;; ++n) {   // Gauss-Seidel sweeps
      if (n == most_sweeps_) return false;
      A = 1.0 + x[0] * x[0] + x[1] * x[1] + x[2] * x[2];
      const double old[3] = {x[0], x[1], x[2]};
      x[0] = A * u[0] + g[0] * x[1] * x[2];
      x[1] = A * u[1] + g[1] * x[2] * x[0];
      x[2] = A * u[2] + g[2] * x[0] * x[1];
      const double change = std::abs(x[0] - old[0]) + std::abs(x[1] - old[1]) + std::abs(x[2] - old[2]);
      if (!std::isfinite(change))
        return !std::isfinite(L[0] + L[1] + L[2]);   // a torque that was NaN, or no solution
      if (change <= 1e-16 * size || (change < 1e-12 * size && change >= last)) break;
      last = change;
    }
    // L -= 4 / (h A) x x (J x) is exactly the rotated L.
    const double M[3] = {J_[0] * x[0], J_[1] * x[1], J_[2] * x[2]}, p[4] = {x[0], x[1], x[2], 1.0};
    A = 1.0 + x[0] * x[0] + x[1] * x[1] + x[2] * x[2];
    double c[3];
    cross(x, M, c);
    for (int i = 0; i < 3; ++i) L[i] -= 4 / (h * A) * c[i];
    rotate_by(p, q);
    return true;
  }

 private:
  static constexpr int most_sweeps_ = 500;
  const PrincipalBody* body_;
  double h_ = 0.0, J_[3] = {};
};

constexpr ode::MethodRecord record_of(std::string_view name, int order, std::string_view doc, std::string_view source) {
  return {.name = name, .order = order, .driven_order = 2, .dense_order = order == 2 ? 3 : order, .adaptive = false,
          .implicit = true, .comparison = true, .keeps = "energy, |L|, L", .doc = doc, .source = source};
}

constexpr std::string_view moser = "Moser & Veselov 1991, Commun. Math. Phys. 139, 217";
constexpr std::string_view hairer = "Hairer & Vilmart 2006, J. Phys. A 39, 13225";

}  // namespace

const BodyMethod dmv2_method{
    record_of("dmv2", 2, "The discrete Moser-Veselov step. It conserves energy and L of a free body; its phase drifts.",
              moser),
    &integrate_with<Dmv<2>>};
const BodyMethod dmv4_method{
    record_of("dmv4", 4, "Moser-Veselov with modified moments, of order 4 for a free body.", hairer),
    &integrate_with<Dmv<4>>};
const BodyMethod dmv6_method{
    record_of("dmv6", 6, "Moser-Veselov with modified moments, of order 6 for a free body.", hairer),
    &integrate_with<Dmv<6>>};
const BodyMethod dmv8_method{
    record_of("dmv8", 8, "Moser-Veselov with modified moments, of order 8 for a free body: the best cheap free step.",
              hairer),
    &integrate_with<Dmv<8>>};

}  // namespace polhode
