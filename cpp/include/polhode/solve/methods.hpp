#pragma once

// The old place; it goes with version 0.3.
#include "polhode/method/methods.hpp"
#include "polhode/solve/plan.hpp"
