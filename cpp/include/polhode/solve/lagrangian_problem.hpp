#pragma once

// The old path; version 0.3 removes it.
#include "polhode/method/lagrangian_problem.hpp"
