#pragma once

#include <optional>

#include "solve/certify/runs.hpp"
#include "solve/ground/custom_probes.hpp"

namespace polhode {

/// A pair of runs. The finer run has the inputs as given and is returned. The coarser run has every input changed by
/// eight units in the last place. Their difference contains the error of the coarser run and the effect of rounded
/// inputs.
class PairCertificate {
 public:
  PairCertificate(CountedRuns& runs, double safety);

  Attempt run(double coarse, double fine);

  /// What the first runs found of the user's own torques.
  const Probes& probes() const { return probes_; }

  /// Removes the rows of times that were added for the comparison.
  void drop_added_times(Motion& motion) const;

 private:
  /// The scene of the comparison run, with the times of the probes behind its own.
  Scene add_probes(const Scene& scene) const;
  void probe_after_failure();
  double find_factor(const Motion& fine, const Motion& coarse) const;

  CountedRuns& runs_;
  double safety_;
  SolveOptions comparison_options_;
  std::optional<Scene> longer_, perturbed_;
  bool must_probe_;
  Probes probes_;
};

}  // namespace polhode
