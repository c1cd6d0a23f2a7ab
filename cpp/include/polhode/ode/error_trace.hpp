#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "polhode/math/detail/coin.hpp"
#include "polhode/ode/taylor.hpp"

namespace polhode::ode {

/// The error of a run's samples, in the problem's measure. The first three members are input. The others are output of
/// a run, and input of the next one if it continues from the first one's end.
struct ErrorTrace {
  static constexpr double infinity = std::numeric_limits<double>::infinity();

  double asked = 1e-9;             ///< the requested error
  double most = infinity;          ///< the run is given up when its error exceeds `most` times `asked`
  double hold_margin = 1.0;        ///< an error held for a while is to be this much below `asked`
  bool all_terms = false;          ///< the error gets all terms of the series, for steps that stability keeps short
  double rate_error = 0.0;         ///< largest error of the first part (rates), absolute
  double attitude_error = 0.0;     ///< largest error of the second part (attitude), an angle
  double state_error = 0.0;        ///< largest error of the third part (further states), relative
  double holds_until = infinity;   ///< the span from the start in which the samples have the requested error
  double given_up = 0.0;           ///< the span from the start after which the run was given up; 0: it was not

  bool continued = false;          ///< the next run starts where the last one ended, with the errors below
  double before = 0.0;             ///< the span from the start to that of the next run
  double largest = 0.0;            ///< the largest size of the first part so far
  double good_until = 0.0;         ///< the span from the start to the last sample that has the requested error
  double scale = 1.0;              ///< enlarges the vectors
  alignas(64) double loss[most_series_width] = {};     ///< what the steps have lost
  alignas(64) double spread[most_series_width] = {};   ///< what rounding may have done
  alignas(64) double sample[most_series_width] = {};   ///< another sample of the same; 0 where it is a part of the loss

  /// Relative, of the start. The first step turns vectors by the attitude, which rounds them further.
  static constexpr double start_attitude = 0x1p-51;

  /// An error below 1e-6 is enlarged to 1e-6, so that differences of two solutions show it.
  double first_scale() const { return std::max(1.0, 1e-6 / asked); }
  /// The relative perturbation of constants: half a unit in the last place, enlarged.
  double perturbation() const { return (continued ? scale : first_scale()) * 0x1p-53; }

  /// Rounding has a vector of its own where it may be as large as the loss: in one vector they might cancel.
  bool separates_rounding() const { return asked < 1e-8; }

  /// The errors of a start: each component of two vectors is perturbed up or down, each in its own way.
  void start(const double* y0, int width) {
    math::Coin coin;
    before = good_until = 0.0;
    scale = first_scale();
    std::fill_n(loss, width, 0.0);
    double* other = separates_rounding() ? sample : loss;
    for (int i = 0; i < width; ++i) {
      const bool up = coin.toss();
      // Numbers of an attitude that all grow alike turn nothing. Two places apart, they differ in both vectors.
      const bool turns = 6 <= i && i < 8;
      const double sign = turns ? -std::copysign(1.0, spread[i - 2] * y0[i - 2]) : up ? 1.0 : -1.0;
      spread[i] = sign * (4 <= i && i < 8 ? start_attitude : 0x1p-53) * scale * y0[i];
      other[i] = unlike(i) * spread[i];
    }
  }

  /// The signs of a second sample beside the first. Two neighbours move alike in one of them, apart in the other: equal
  /// changes of separatrix variables leave a rate as it is.
  static double unlike(int i) { return i % 2 == 0 ? 1.0 : -1.0; }

  /// Takes the errors of samples up to a span from the start.
  void add(double rates, double attitude, double until, double states = 0.0) {
    rate_error = std::max(rate_error, rates), attitude_error = std::max(attitude_error, attitude);
    state_error = std::max(state_error, states);
    if (hold_margin * std::max(rate_error, std::max(attitude_error, state_error) * largest) > asked * largest) {
      holds_until = std::min(holds_until, good_until);
    } else {
      good_until = until;
    }
  }
};

}  // namespace polhode::ode
