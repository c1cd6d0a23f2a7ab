#pragma once

#include <string>

#include "polhode/inertia/principal_axes.hpp"

// Checks of what the caller gives. The messages say which axis, by how many per cent, and the likely cause.
namespace polhode::inertia {

/// The mean of a matrix and its transpose. Throws InvalidInput unless the matrix is finite and symmetric to rounding.
Matrix3d symmetrized(const Matrix3d& I_B, const char* where);

/// Throws InvalidInput when a moment is negative or, for a physical tensor, above the sum of the two others.
/// Allowed are InertiaTensor::tolerance of the largest moment plus `slack` [kg m^2], the rounding of the matrix.
/// The likely cause is guessed from the matrix unless `cause` is given.
void check_moments(const Matrix3d& I_B, const PrincipalAxes& principal, bool physical, const char* where,
                   double slack = 0, const char* cause = nullptr);

/// Returns the value. Throws InvalidInput unless it is positive and finite.
double positive(double value, const char* where);

std::string vector_text(const Vector3d& v);  ///< "(0.6, 0, 0.8)", 4 digits, for messages

}  // namespace polhode::inertia
