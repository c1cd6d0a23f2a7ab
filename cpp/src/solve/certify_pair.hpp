#pragma once

#include <optional>

#include "solve/attempt.hpp"

namespace polhode {

/// A pair of runs: a coarser one with every input changed by two units in the last place, and a finer one with the
/// inputs as they are, which is returned. Their difference is the error of the coarser run and what rounding of the
/// inputs does to it.
class PairCertificate {
 public:
  PairCertificate(CountedRuns& runs, double safety);

  Attempt run(double coarse, double fine);

  /// Removes the rows of the times that were added for the comparison alone.
  void drop_added_times(Motion& motion) const;

 private:
  CountedRuns& runs_;
  double safety_;
  SolveOptions comparison_options_;
  std::optional<Scene> longer_, perturbed_;
};

/// `count` + 1 times over the whole span, evenly spread.
std::vector<double> spread_times(const Decision& decision, int count);

}  // namespace polhode
