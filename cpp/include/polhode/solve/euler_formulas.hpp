#pragma once

// The old path; version 0.3 removes it.
#include "polhode/method/euler_formulas.hpp"
