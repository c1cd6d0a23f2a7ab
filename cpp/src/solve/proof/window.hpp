#pragma once

#include <string>
#include <vector>

#include "solve/proof/formula_modes.hpp"

namespace polhode::proof {

/// A short step over surfaces of switches, [0, length] from the state that a mode's step was expanded about.
///
/// The mode's own motion phi is continued across the surface. With Delta >= |f(y) - f_mode(phi)| over a box that holds
/// both, |y - phi| <= length Delta. Where one surface alone is met, at a speed g' that is known not to be 0, and phi is at
/// first on the mode's side, then y - phi is (length - tau) Delta0 but for terms of second order, and
/// length - tau = g(phi(length)) / g'. So the set of errors is mapped by S = 1 + Delta0 grad g / g', the saltation matrix
/// (Leine & Nijmeijer 2004, Dynamics and Bifurcations of Non-Smooth Mechanical Systems).
struct Window {
  enum class Result { passed, too_short, refused };
  Result result = Result::refused;
  std::string why = {};                  ///< it was refused
  std::vector<double> change = {};       ///< at least |y - phi| anywhere within it
  FormulaModes::Sides sides = {};        ///< behind it

  /// y(length) = P + e + factors (value + gradient.e) + r, |r| <= rest; without factors y = P + e + r.
  std::vector<double> factors = {}, gradient = {}, rest = {};
  Interval value = {};
};

/// What is known of the mode's own motion in a window.
struct WindowMotion {
  Interval begin = {}, end = {}, during = {};   ///< its first, its last, and all times since the start in the units of f
  double length = 0.0;
  std::vector<Interval> box = {};        ///< holds phi during the window
  std::vector<Interval> first = {}, last = {};   ///< P(0) and P(length)
  std::vector<double> first_error = {}, last_error = {};   ///< at least |phi - P| then
  bool is_final = false;                 ///< the sides behind it are not asked
  double change_factor = 1.0;            ///< multiplies |y - phi|: anything below 1 is wrong, for tests
};

/// @param sides  those of the mode
Window find_window(FormulaModes& modes, const FormulaModes::Sides& sides, const WindowMotion& motion);

}  // namespace polhode::proof
