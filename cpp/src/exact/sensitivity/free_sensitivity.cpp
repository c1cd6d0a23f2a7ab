#include "polhode/exact/free_sensitivity.hpp"

#include <algorithm>

#include "exact/sensitivity/body.hpp"
#include "exact/time_parts.hpp"

namespace polhode {
class FreeSensitivity::Body {
 public:
  Body(const FreeMotion& of, const exact::ColumnLayout& made, std::size_t wanted)
      : motion(of), columns(of), layout(made), width(wanted) {}

  FreeMotion motion;
  exact::MotionColumns columns;
  exact::ColumnLayout layout;
  std::size_t width;  ///< the columns that are wanted, the first ones
};

FreeSensitivity::FreeSensitivity(const FreeMotion& motion, std::vector<SensitivityTo> wrt, RotationSide side) {
  exact::check_wrt(wrt);
  // The columns of the axes are made of those of omega(0).
  body_ = std::make_shared<const Body>(motion, exact::ColumnLayout(exact::with_needed(wrt), side),
                                       exact::ColumnLayout(wrt, side).width);
}

std::size_t FreeSensitivity::columns() const { return body_->width; }

void FreeSensitivity::at(const double* t, std::size_t n, double* omega, double* attitude, double* d_omega,
                         double* d_attitude) const {
  constexpr std::size_t chunk = 1024;  // its states and columns stay in the cache
  const std::size_t width = body_->width, made = body_->layout.width;
  std::vector<double> own_omega, own_attitude, own_columns;
  const exact::TimeGrid grid(t, n);
  for (std::size_t begin = 0; begin < n; begin += chunk) {
    if (begin % (16 * chunk) == 0) check_interrupt();
    const std::size_t count = std::min(chunk, n - begin);
    if (!omega) own_omega.resize(3 * count);
    if (!attitude) own_attitude.resize(4 * count);
    double* w = omega ? omega + 3 * begin : own_omega.data();
    double* q = attitude ? attitude + 4 * begin : own_attitude.data();
    body_->motion.at(grid.piece(begin, count), w, q);
    double *d_w = d_omega + 3 * width * begin, *d_q = d_attitude + 3 * width * begin;
    if (made == width) {
      body_->columns.at(body_->layout, t + begin, count, w, q, d_w, d_q);
      continue;
    }
    own_columns.resize(6 * made * count);
    double *more_w = own_columns.data(), *more_q = more_w + 3 * made * count;
    body_->columns.at(body_->layout, t + begin, count, w, q, more_w, more_q);
    for (std::size_t row = 0; row < 3 * count; ++row) {
      std::copy_n(more_w + made * row, width, d_w + width * row);
      std::copy_n(more_q + made * row, width, d_q + width * row);
    }
  }
}

}  // namespace polhode
