#pragma once

// The old path; version 0.3 removes it.
#include "polhode/method/methods.hpp"
#include "polhode/solve/plan.hpp"
