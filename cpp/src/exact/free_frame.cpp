#include "exact/free_frame.hpp"

#include <cmath>

namespace polhode::exact {

int exponent_of(const Vector3d& v) { return std::ilogb(v.cwiseAbs().maxCoeff()); }

Vector3d ldexp(const Vector3d& v, int e) { return {std::ldexp(v[0], e), std::ldexp(v[1], e), std::ldexp(v[2], e)}; }

FreeFrame make_free_frame(const Matrix3d& R_BP, const Matrix3d& M, double time_scale, const Quat& first,
                          const Quat& attitude) {
  FreeFrame frame;
  frame.time_scale = time_scale;
  const Matrix3d S = R_BP * M;
  for (int c = 0; c < 3; ++c)
    for (int a = 0; a < 3; ++a) frame.omega[3 * c + a] = S(c, a) * time_scale;
  const auto in_body_axes = [&S](double x, double y, double z, double w) {
    const Vector3d v = S * Vector3d(x, y, z);
    return Quat{v[0], v[1], v[2], w};
  };
  const Quat left = normalized(attitude * conjugate(in_body_axes(first.x, first.y, first.z, first.w)));
  for (std::size_t i = 0; i < 4; ++i) {
    const Quat q = left * in_body_axes(i == 0, i == 1, i == 2, i == 3);
    frame.attitude[i] = q.x;
    frame.attitude[4 + i] = q.y;
    frame.attitude[8 + i] = q.z;
    frame.attitude[12 + i] = q.w;
  }
  return frame;
}

}  // namespace polhode::exact
