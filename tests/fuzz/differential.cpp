#include "polhode/batch/solve_many.hpp"
#include "polhode/solve/solve.hpp"

#include <algorithm>
#include <cmath>

#include "input.hpp"

// Ordinary bodies, free or with a weight: the closed form and taylor's steps agree within the errors that both state,
// and rk45 in lanes has the bits of rk45 alone.

namespace polhode::fuzz {
namespace {

Vector3d direction(Input& input) {
  Vector3d v;
  for (int k = 0; k < 3; ++k) v[k] = 2.0 * input.fraction() - 1.0;
  return v;
}

Scene scene(Input& input) {
  const std::size_t kind = input.below(3);
  Vector3d moments;
  for (int k = 0; k < 3; ++k) moments[k] = 1.0 + 0.99 * input.fraction();
  if (kind == 1 || input.below(4) == 0) moments[1] = moments[0];
  if (input.below(8) == 0) moments[2] = std::nextafter(moments[1], 2.0);
  SceneParts parts{.inertia_B = InertiaTensor::from_moments(moments)};
  parts.omega = 4.0 * direction(input);
  if (input.coin()) {
    const int axis = static_cast<int>(input.below(3));
    parts.omega[axis] *= std::ldexp(1.0, -static_cast<int>(input.below(200)));
  }
  const Vector3d v = direction(input);
  const Quat q{v[0], v[1], v[2], 2.0 * input.fraction() - 1.0};
  if (norm(q) > 0) parts.attitude = normalized(q);
  if (kind == 1) {
    const double weight = 5.0 * input.fraction();
    parts.torques.push_back(torques::Gravity(weight, {0, 0, 2.0 * input.fraction() - 1.0}));
  }
  if (kind == 2) {
    const Vector3d rates = 0.1 * direction(input).cwiseAbs();
    parts.torques.push_back(torques::Damping(rates.asDiagonal().toDenseMatrix()));
  }
  for (std::size_t n = 1 + input.below(8); n > 0; --n) parts.times.push_back(16.0 * input.fraction() - 4.0);
  return Scene(std::move(parts));
}

double distance(const std::vector<double>& a, const std::vector<double>& b, std::size_t width, double scale) {
  double worst = 0.0;
  for (std::size_t i = 0; i + width <= a.size(); i += width) {
    double square = 0.0;
    for (std::size_t k = 0; k < width; ++k) square += (a[i + k] - b[i + k]) * (a[i + k] - b[i + k]);
    worst = std::max(worst, std::sqrt(square) / scale);
  }
  return worst;
}

void compare(Input& input) {
  const Scene given = scene(input);
  const double accuracy = std::pow(10.0, -3.0 - 8.0 * input.fraction());
  const Motion planned = solve(given, {.accuracy = accuracy});
  const Motion stepped = solve(given, {.accuracy = accuracy, .method = "taylor"});
  require(planned.status == Status::finished && stepped.status == Status::finished, "ordinary bodies are solved");
  if (planned.plan.method == "exact" && planned.omega_scale() > 0) {
    const double bound = 1.2 * (planned.error + stepped.error) + 1e-14;
    require(distance(planned.omega, stepped.omega, 3, planned.omega_scale()) <= bound, "omega of two methods");
    // A unit quaternion that differs by d belongs to a turn by 2 d.
    require(2.0 * distance(planned.attitude, stepped.attitude, 4, 1.0) <= 2.0 * bound, "attitude of two methods");
  }
  const SolveOptions steps{.method = "rk45", .rtol = std::pow(10.0, -3.0 - 6.0 * input.fraction()), .max_steps = 5000};
  const Motion alone = solve(given, steps);
  const std::size_t n = given.times().size();
  std::vector<double> w(27 * n), q(36 * n);
  solve_many(9, n, [&](std::size_t) { return given; }, steps, w.data(), q.data());
  if (alone.status != Status::finished) return;
  require(is_same(alone.omega.data(), w.data() + 24 * n, 3 * n), "lanes have the bits of one body");
  require(is_same(alone.attitude.data(), q.data() + 32 * n, 4 * n), "lanes have the bits of one body");
}

}  // namespace
}  // namespace polhode::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  polhode::fuzz::Input input(data, size);
  polhode::fuzz::is_done([&] { polhode::fuzz::compare(input); });
  return 0;
}
