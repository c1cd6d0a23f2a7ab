#include "polhode/core/build_info.hpp"

#include <Eigen/Core>

#include "polhode/core/simd.hpp"
#include "polhode/core/version.hpp"

namespace polhode {

std::map<std::string, std::string> build_info() {
  return {
      {"version", POLHODE_VERSION},
      {"compiler", __VERSION__},
      {"flags", POLHODE_BUILD_FLAGS},
      {"eigen", std::to_string(EIGEN_WORLD_VERSION) + "." + std::to_string(EIGEN_MAJOR_VERSION) + "." +
                    std::to_string(EIGEN_MINOR_VERSION)},
      {"simd", to_text(simd_level())},
  };
}

}  // namespace polhode
