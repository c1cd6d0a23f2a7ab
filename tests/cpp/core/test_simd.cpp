#include <doctest/doctest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <set>
#include <sstream>
#include <string>

#include "polhode/core/build_info.hpp"

// Linux lists what the processor has and the kernel saves for each thread. Wine shows the same file.
TEST_CASE("the lanes are those that the flags of the processor allow") {
  std::ifstream file("/proc/cpuinfo");
  std::string line;
  while (std::getline(file, line) && !line.starts_with("flags")) {
  }
  if (!file) return;   // another system, or AArch64, whose line has another name
  std::istringstream words(line);
  std::set<std::string> flags;
  for (std::string word; words >> word;) flags.insert(word);

  std::string level = "baseline";
  if (flags.contains("avx2") && flags.contains("fma")) level = "avx2";
  if (level == "avx2" && flags.contains("avx512f") && flags.contains("avx512dq") && flags.contains("avx512vl")) {
    level = "avx512";
  }
  const char* cap = std::getenv("POLHODE_SIMD");
  if (cap != nullptr && *cap != '\0') level = std::min(level, std::string(cap), [](const auto& a, const auto& b) {
    const auto rank = [](const std::string& name) { return name == "baseline" ? 0 : name == "avx2" ? 1 : 2; };
    return rank(a) < rank(b);
  });
  CHECK(polhode::build_info().at("simd") == level);
}
