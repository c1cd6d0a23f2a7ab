#pragma once

#include "solve/decision.hpp"

namespace polhode {

/// Carries out a decision with the options that it was made for.
Motion execute(const Decision& decision, const SolveOptions& options);

}  // namespace polhode
