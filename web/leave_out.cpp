// The page throws bodies under torques that are seen: none is left out, and the bounds that would decide it take no place.
#include "solve/plan/leave_out.hpp"

namespace polhode {

std::optional<Negligible> find_negligible(const Scene&, const SolveOptions&) { return std::nullopt; }
void number_as_given(const Scene&, std::vector<LeftOut>&) {}
std::string describe(const LeftOut&) { return {}; }

}  // namespace polhode
