#pragma once

#include <map>
#include <string>

namespace polhode {

/// How the installed binary was built: version, compiler, flags, eigen, simd (the level in use).
std::map<std::string, std::string> build_info();

}  // namespace polhode
