#pragma once

#include <string>

#include "polhode/inertia/principal_axes.hpp"

// What no body can have is refused here, once; the messages say which axis, by how many per cent, and the likely cause.
namespace polhode::inertia {

/// The mean of a finite matrix and its transpose, when they differ by rounding only; throws InvalidInput otherwise.
Matrix3d symmetric_at_the_door(const Matrix3d& I_B, const char* where);

/// Throws InvalidInput when a moment is negative or, for a physical tensor, above the sum of the two others, beyond
/// InertiaTensor::tolerance of the largest and beyond `slack` [kg m^2], the rounding the matrix may carry.
/// The likely cause is guessed from the matrix unless given.
void check_moments(const Matrix3d& I_B, const PrincipalAxes& principal, bool physical, const char* where,
                   double slack = 0, const char* cause = nullptr);

/// The value, when positive and finite; throws InvalidInput otherwise.
double positive(double value, const char* where);

std::string vector_text(const Vector3d& v);  ///< "(0.6, 0, 0.8)", 4 digits, for messages

}  // namespace polhode::inertia
