#include "polhode/attitude/detail/arrays.hpp"
#include "polhode/attitude/euler.hpp"
#include "polhode/attitude/kinematics.hpp"
#include "polhode/attitude/matrix.hpp"
#include "polhode/attitude/rotation_vector.hpp"
#include "polhode/math/elliptic.hpp"

#include <cmath>

#include "input.hpp"

// Rotations by any numbers and letters, and elliptic functions: refused, or the same turn in every form.

namespace polhode::fuzz {
namespace {

bool is_unit(const Quat& q) { return std::abs(norm(q) - 1.0) < 1e-15 * 4; }

bool is_same_turn(const Quat& a, const Quat& b) {
  return std::abs(std::abs(a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w) - 1.0) < 1e-13;
}

void try_forms(Input& input, const EulerSequence& sequence) {
  Quat q;
  const Quat given = input.attitude();
  if (!is_done([&] { q = make_attitude(given); })) return;
  require(is_unit(q), "an attitude is unit");
  const Vector3d angles = to_euler(sequence, q), v = to_rotation_vector(q);
  require(is_same_turn(q, quat_from_euler(sequence, angles)), "Euler angles give the attitude back");
  require(is_same_turn(q, quat_from_rotation_vector(v)), "a rotation vector gives the attitude back");
  require(is_same_turn(q, quat_from_matrix(to_matrix(q))), "a matrix gives the attitude back");
  gimbal_lock(sequence, q);
  const Vector3d rates = input.vector();
  is_done([&] { euler_rates(sequence, angles, rates); });
  body_rates(sequence, angles, rates);
}

void try_rows(Input& input, const EulerSequence& sequence) {
  const std::size_t n = 1 + input.below(20);
  const std::vector<double> values = input.numbers(9 * n);
  std::vector<double> out(9 * n);
  std::vector<char> locked(n);
  const double* in = values.data();
  double* to = out.data();
  require(arrays::quat_from_euler(sequence, n, in, arrays::kDegrees, to) <= n, "a row");
  require(arrays::quat_from_matrix(n, in, to) <= n, "a row");
  require(arrays::quat_from_rotation_vector(n, in, arrays::kRadians, to) <= n, "a row");
  arrays::euler_rates(sequence, n, in, 3, in + 3 * n, 0, to);
  arrays::body_rates(sequence, n, in, 0, in + 3 * n, 3, to);
  const std::size_t good = arrays::normalize(n, in, to);
  for (std::size_t i = 0; i < good; ++i)
    require(is_unit({out[4 * i], out[4 * i + 1], out[4 * i + 2], out[4 * i + 3]}), "rows are unit");
  const std::vector<double> unit(to, to + 4 * good);
  arrays::to_matrix(good, unit.data(), to);
  arrays::to_euler(sequence, good, unit.data(), arrays::kDegrees, to);
  arrays::to_rotation_vector(good, unit.data(), arrays::kDegrees, to);
  arrays::rotate(good, unit.data(), 4, in + 4 * n, 3, input.coin(), to);
}

void try_elliptic(Input& input) {
  const double m = input.coin() ? input.fraction() : input.number(), u = input.number();
  const double m1 = input.coin() ? 1.0 - m : input.number();
  is_done([&] {
    const elliptic::Parameter parameter(m, m1);
    const elliptic::Jacobi j = parameter.jacobi(u);
    require(std::abs(j.sn * j.sn + j.cn * j.cn - 1.0) < 1e-15 * 4, "sn^2 + cn^2 = 1");
    require(parameter.nome() >= 0 && parameter.nome() <= 1 && parameter.K() > 1.5, "a nome and a quarter period");
  });
}

}  // namespace
}  // namespace polhode::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace polhode;
  fuzz::Input input(data, size);
  if (input.coin()) {
    fuzz::try_elliptic(input);
    return 0;
  }
  std::string letters;
  for (int i = 0; i < 3; ++i) {
    const std::uint8_t c = input.take<std::uint8_t>();
    letters += c < 250 ? "xyzXYZ"[c % 6] : static_cast<char>(c);
  }
  if (input.coin()) letters = "ZXZ";
  fuzz::is_done([&] {
    const EulerSequence sequence(letters);
    fuzz::try_forms(input, sequence);
    fuzz::try_rows(input, sequence);
  });
  return 0;
}
