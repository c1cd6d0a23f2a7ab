// What the page never asks for takes no place: torques that are left out, proofs, and fields on orbits.
#include "polhode/core/error.hpp"
#include "polhode/torque/magnetic_field.hpp"
#include "solve/certify/certify.hpp"
#include "solve/plan/leave_out.hpp"

namespace polhode {

std::optional<Negligible> find_negligible(const Scene&, const SolveOptions&) { return std::nullopt; }
void number_as_given(const Scene&, std::vector<LeftOut>&) {}
std::string describe(const LeftOut&) { return {}; }

Motion prove(const Decision&, const SolveOptions&) {
  throw InvalidInput("certify", "other than 'proof' in the browser", "'proof'");
}

formula::Vec<formula::Expr, 3> MagneticField::see(const formula::Expr&) const { return {}; }
Vector3d MagneticField::at(double) const { return Vector3d::Zero(); }

}  // namespace polhode
