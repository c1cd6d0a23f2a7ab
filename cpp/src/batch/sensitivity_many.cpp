#include "polhode/batch/sensitivity_many.hpp"

#include <atomic>
#include <optional>

#include "batch/parallel.hpp"
#include "polhode/core/error.hpp"
#include "polhode/core/interrupt.hpp"

namespace polhode {

std::vector<ManySensitivity> compute_sensitivities(std::size_t n, const MakeScene& make_scene,
                                                   const std::vector<std::string>& groups,
                                                   const SensitivityOptions& options, int threads, bool refuse) {
  std::vector<ManySensitivity> all(n);
  std::atomic<std::size_t> next{0};
  std::atomic<bool> stopped{false};
  const auto make_one = [&](std::size_t body) -> std::optional<Scene> {
    if (refuse) return make_scene(body);
    try {
      return make_scene(body);
    } catch (const InvalidInput& error) {
      all[body].failure = error.what();
      return std::nullopt;
    }
  };
  const auto differentiate = [&](std::size_t, std::size_t) {
    // Each free thread takes the next body, so a long run delays no other.
    for (std::size_t body = next++; body < n && !stopped; body = next++) {
      try {
        check_interrupt();
        const std::optional<Scene> scene = make_one(body);
        if (scene) all[body].found = compute_sensitivity(*scene, groups, options);
      } catch (const IntegrationFailure& error) {
        all[body].failure = error.what();
      } catch (const InvalidInput& error) {
        stopped = true;
        throw InvalidInput("body " + std::to_string(body), "a scene that solve() differentiates", error.what());
      } catch (...) {
        stopped = true;
        throw;
      }
    }
  };
  const std::size_t workers = thread_count(threads, n, 2);
  parallel_for(workers, workers, 1, differentiate);
  return all;
}

}  // namespace polhode
