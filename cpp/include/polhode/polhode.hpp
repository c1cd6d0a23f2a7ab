#pragma once

/// Everything that a program usually needs: bodies, attitudes, torques, closed forms, scenes and their solution.

#include "polhode/attitude/euler.hpp"
#include "polhode/attitude/kinematics.hpp"
#include "polhode/attitude/matrix.hpp"
#include "polhode/attitude/rotation_vector.hpp"
#include "polhode/batch/free_motion.hpp"
#include "polhode/batch/heavy_top.hpp"
#include "polhode/core/build_info.hpp"
#include "polhode/core/error.hpp"
#include "polhode/core/version.hpp"
#include "polhode/exact/free_motion.hpp"
#include "polhode/exact/heavy_top.hpp"
#include "polhode/inertia/checks.hpp"
#include "polhode/inertia/mass_properties.hpp"
#include "polhode/inertia/mesh.hpp"
#include "polhode/inertia/shapes.hpp"
#include "polhode/math/elliptic.hpp"
#include "polhode/ode/methods.hpp"
#include "polhode/solve/invariants.hpp"
#include "polhode/solve/methods.hpp"
#include "polhode/solve/solve.hpp"
