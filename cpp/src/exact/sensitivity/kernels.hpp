#pragma once

#include <cstddef>

#include "exact/sensitivity/columns.hpp"
#include "exact/sensitivity/series.hpp"
#include "polhode/exact/detail/free_kernels.hpp"

namespace polhode::exact {

/// The columns of one body in the caller's frames. The rate columns are along the caller's axes. Of the moment columns
/// the first two are computed; the third follows, as the moments have no scale.
struct BodyColumns {
  FreeColumns<double> c;
  double time_scale;
  double omega[9], theta[9];                ///< working body axes to body axes; working space axes to space, rates
  double omega_moment[9], theta_moment[9];  ///< the same for the moment columns, with the units of both
  double is_own[2][3], own_rate[2], dL_x[2], dL_y[2];  ///< of the two moments: 1 for its axis, omega0 about it
  double share[2];                         ///< column 3 = share[0] column 1 + share[1] column 2
  std::size_t place[3];                    ///< which moment of the caller each column belongs to
};

/// Where columns go: (n, 3, width) numbers row by row, both arrays alike. A negative place: not wanted.
struct ColumnTarget {
  double *d_omega, *d_attitude;
  std::size_t width;
  std::ptrdiff_t rates, moments;  ///< the first column of each group
};

struct FreeColumnsKernels {
  /// The columns' constants of n bodies, beside those of FreeKernels::set_up, which have the same meaning.
  /// `omega` is in working axes.
  std::size_t (*set_up)(FreeStarts starts, std::size_t n, FreeTrig<double>* trig, FreeFrame* frames,
                        FreeColumns<double>* columns, double* omega, std::size_t* left);

  /// The same for one body, in either form.
  void (*prepare)(const FreeConstants<double>& constants, const FreeTrig<double>* trig, const FreeHyper<double>* hyper,
                  FreeColumns<double>& columns);

  void (*trig)(const FreeTrig<double>&, const BodyColumns&, const double* t, std::size_t n, const ColumnTarget&);
  void (*hyper)(const FreeHyper<double>&, const BodyColumns&, const double* t, std::size_t n, const ColumnTarget&);

  void (*make_series)(const SeriesStart& start, bool axes, int order, ColumnSeries& series);
  /// All rows of the series at one time: see ColumnSeries.
  void (*sum_series)(const ColumnSeries& series, double t, int order, bool attitudes, SeriesSums& sums);
};

const FreeColumnsKernels& free_columns_kernels(SimdLevel level);
const FreeColumnsKernels& free_columns_kernels();

const FreeColumnsKernels* baseline_free_columns_kernels();
const FreeColumnsKernels* avx2_free_columns_kernels();
const FreeColumnsKernels* avx512_free_columns_kernels();

}  // namespace polhode::exact
