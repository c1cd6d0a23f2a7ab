#pragma once

// Every closed form, simplest first: its name, and the class that evaluates it. The planner takes the first that holds.
// A closed form is a class in exact/, its record `<name>_form` in src/solve/form/, and a line here.

#include "polhode/exact/damped_free.hpp"
#include "polhode/exact/free_motion.hpp"
#include "polhode/exact/gyrostat.hpp"
#include "polhode/exact/heavy_top.hpp"
#include "polhode/exact/pendulum.hpp"

#define POLHODE_CLOSED_FORM_TYPES(TYPE) TYPE(FreeMotion) TYPE(Gyrostat) TYPE(DampedFree) TYPE(Pendulum) TYPE(HeavyTop)

#define POLHODE_CLOSED_FORMS(FORM) \
  FORM(rest, FreeMotion)           \
  FORM(spherical, FreeMotion)      \
  FORM(steady, FreeMotion)         \
  FORM(symmetric, FreeMotion)      \
  FORM(separatrix, FreeMotion)     \
  FORM(triaxial, FreeMotion)       \
  FORM(gyrostat, Gyrostat)         \
  FORM(damped_free, DampedFree)    \
  FORM(pendulum, Pendulum)         \
  FORM(heavy_top, HeavyTop)        \
  FORM(heavy_gyrostat, HeavyTop)
