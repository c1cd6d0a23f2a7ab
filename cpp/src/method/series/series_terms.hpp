#pragma once

namespace polhode {

/// The variables of the rates: the rates about principal axes 1, 2, 3 themselves, or u, v and w2 (separatrix.hpp).
enum class RateVariables { plain, separatrix };

/// Whether one kernel serves all torques that need the attitude, with zeros for what a torque does not have. It has the
/// same bits, is slower and smaller: the browser's core is compiled so.
#ifdef POLHODE_FEW_KERNELS
inline constexpr bool few_kernels = true;
#else
inline constexpr bool few_kernels = false;
#endif

/// The constants of the Taylor recurrences of Euler's equations with all polynomial torques. Lanes of `r` are the rate
/// variables (r0, r1, r2, 0). Vectors are fixed in space, or rotate with the orbit, and have components in body axes.
struct SeriesTerms {
  RateVariables variables = RateVariables::plain;
  double to_rates[4] = {1, 1, 1, 0};   ///< separatrix: w = (v - u, w2, u + v) times (1/2k, 1, 1/2)
  double product[4] = {};              ///< r' = product * (u w2, v w2, (v - u)(v + u)), or (w2 w3, w3 w1, w1 w2) ...
  double product_low[4] = {};          ///< ... and its rounding error
  double torque[4] = {};               ///< + constant
  double damping[3][4] = {};           ///< + sum_j damping[j] w_j, with h x w of rotors
  bool damped = false;
  int fixed_vectors = 0;               ///< number of vectors fixed in space: 0, 1 or 2
  double pull[2][3][4] = {};           ///< + sum_j pull[i][j] * (vector i)_j
  bool gradient = false;               ///< + tidal[0] * (u1 u2, u1 u2, u3 u1) + tidal[1] * (u2 u3, u2 u3, 0), or
  double tidal[2][4] = {};             ///<   tidal[0] * (u2 u3, u3 u1, u1 u2); u is the radial direction of the orbit,
  double orbit_rate = 0.0;             ///< which rotates at this rate
};

}  // namespace polhode
