#include <string>

#include "c/call.hpp"
#include "polhode/core/version.hpp"

namespace polhode::c {
namespace {

thread_local std::string last_error;

}  // namespace

polhode_status fail(polhode_status status, const char* where, const char* sentence) noexcept {
  try {
    last_error = std::string(where) + ": " + sentence;
  } catch (...) {
    last_error.clear();   // no memory for a sentence
  }
  return status;
}

}  // namespace polhode::c

extern "C" {

int polhode_abi_version(void) { return POLHODE_ABI_VERSION; }

const char* polhode_version(void) { return POLHODE_VERSION; }

const char* polhode_last_error(void) { return polhode::c::last_error.c_str(); }
}
