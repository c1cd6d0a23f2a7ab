#pragma once

// The old place; it goes with version 0.3.
#include "polhode/method/lagrangian_problem.hpp"
