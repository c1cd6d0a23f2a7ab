#pragma once

#include <optional>
#include <vector>

#include "exact/sensitivity/kernels.hpp"
#include "exact/sensitivity/start.hpp"
#include "polhode/exact/free_motion.hpp"
#include "polhode/exact/free_sensitivity.hpp"

// One body's columns at many times, for FreeSensitivity and its batch.
namespace polhode::exact {

/// The order of the columns.
struct ColumnLayout {
  std::size_t width = 0;
  std::ptrdiff_t omega = -1, attitude = -1, inertia = -1, axes = -1, time = -1;  ///< first columns
  RotationSide side = RotationSide::space;

  ColumnLayout() = default;
  ColumnLayout(const std::vector<SensitivityTo>& wrt, RotationSide side);
};

/// Throws InvalidInput for an empty list or a name twice.
void check_wrt(const std::vector<SensitivityTo>& wrt);

/// The list with the columns that the wanted ones are made of, behind them.
std::vector<SensitivityTo> with_needed(std::vector<SensitivityTo> wrt);

ColumnsStart make_columns_start(const FreeMotion& motion);

/// The form in which most samples are computed; the others use the power series.
enum class ColumnsForm { rest, intermediate, trig, hyper };

/// The columns of one body.
class ColumnsBody {
 public:
  /// From the constants of either form; `trig` or `hyper` may be null.
  ColumnsBody(const ColumnsStart& start, ColumnsForm form, const FreeColumns<double>& columns, const double* omega,
              const FreeTrig<double>* trig, const FreeHyper<double>* hyper, const FreeFrame& frame);

  /// d omega and d theta at n times, from the states there.
  void at(const ColumnLayout& layout, const double* t, std::size_t n, const double* omega, const double* attitude,
          double* d_omega, double* d_attitude) const;

 private:
  void finish(const FreeColumns<double>& columns, const double* omega, const FreeFrame& frame);
  void groups(const ColumnTarget& to, std::ptrdiff_t axes, const double* t, std::size_t n, const double* omega,
              const double* attitude) const;

  ColumnsStart start_;
  ColumnsForm form_;
  const FreeTrig<double>* trig_;
  const FreeHyper<double>* hyper_;
  BodyColumns columns_{};
  double rate_ = 0.0;  ///< |p|, scaled
};

/// The same with the constants of its series, from a motion.
class MotionColumns {
 public:
  explicit MotionColumns(const FreeMotion& motion);
  MotionColumns(const MotionColumns&) = delete;
  MotionColumns& operator=(const MotionColumns&) = delete;

  void at(const ColumnLayout& layout, const double* t, std::size_t n, const double* omega, const double* attitude,
          double* d_omega, double* d_attitude) const {
    body_->at(layout, t, n, omega, attitude, d_omega, d_attitude);
  }

 private:
  FreeTrig<double> trig_;
  FreeHyper<double> hyper_;
  std::optional<ColumnsBody> body_;
};

}  // namespace polhode::exact
