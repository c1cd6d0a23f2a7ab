#include <algorithm>
#include <cmath>
#include <limits>

#include "polhode/batch/summary.hpp"
#include "polhode/math/detail/functions.hpp"

namespace polhode {

/// Jacobi's rotations (GolubVanLoan, 8.5), which find small eigenvalues beside large ones (DemmelVeselic1992).
MeanAttitude mean_attitude(const double* moments) {
  double a[4][4], v[4][4] = {};
  for (int i = 0, k = 0; i < 4; ++i)
    for (int j = i; j < 4; ++j, ++k) a[i][j] = a[j][i] = moments[k];
  const double trace = a[0][0] + a[1][1] + a[2][2] + a[3][3], nan = std::numeric_limits<double>::quiet_NaN();
  if (!(trace > 0.0 && trace <= std::numeric_limits<double>::max())) return {{nan, nan, nan, nan}, nan};
  for (int i = 0; i < 4; ++i) v[i][i] = 1.0;
  for (int sweep = 0, left = 1; sweep < 30 && left > 0; ++sweep) {
    left = 0;
    for (int p = 0; p < 3; ++p) {
      for (int q = p + 1; q < 4; ++q) {
        const double off = a[p][q];
        if (off * off <= std::max(std::abs(a[p][p] * a[q][q]) * 0x1p-110, 0x1p-1000 * trace * trace)) continue;
        ++left;
        const double half = 0.5 * (a[q][q] - a[p][p]);
        const double t = std::copysign(1.0, half) * off / (std::abs(half) + std::sqrt(half * half + off * off));
        const double c = 1.0 / std::sqrt(1.0 + t * t), s = t * c;
        a[p][p] -= t * off, a[q][q] += t * off, a[p][q] = a[q][p] = 0.0;
        for (int r = 0; r < 4; ++r) {
          const double vp = v[r][p], vq = v[r][q];
          v[r][p] = c * vp - s * vq, v[r][q] = s * vp + c * vq;
          if (r == p || r == q) continue;
          const double rp = a[r][p], rq = a[r][q];
          a[r][p] = a[p][r] = c * rp - s * rq, a[r][q] = a[q][r] = s * rp + c * rq;
        }
      }
    }
  }
  int best = 0;
  for (int i = 1; i < 4; ++i)
    if (a[i][i] > a[best][best]) best = i;
  double rest = 0.0, length2 = 0.0, sign = 1.0;
  MeanAttitude mean{};
  for (int i = 0; i < 4; ++i) {
    if (i != best) rest += std::max(a[i][i], 0.0);
    length2 += v[i][best] * v[i][best];
    if (v[i][best] != 0.0) sign = std::copysign(1.0, v[i][best]);
  }
  for (std::size_t i = 0; i < 4; ++i) mean.attitude[i] = sign * v[i][best] / std::sqrt(length2);
  mean.spread = 2.0 * math::asin(std::min(1.0, std::sqrt(rest / trace)));
  return mean;
}

}  // namespace polhode
