#pragma once

#include "polhode/exact/closed_forms.hpp"
#include "polhode/solve/closed_form.hpp"

// The record of each closed form, in the file of its class.
namespace polhode::form {

#define POLHODE_DECLARE(name, type) extern const ClosedFormRecord name##_form;
POLHODE_CLOSED_FORMS(POLHODE_DECLARE)
#undef POLHODE_DECLARE

}  // namespace polhode::form
