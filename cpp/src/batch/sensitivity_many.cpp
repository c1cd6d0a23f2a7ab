#include "polhode/batch/sensitivity_many.hpp"

#include <atomic>
#include <optional>

#include "batch/one_body.hpp"
#include "batch/parallel.hpp"
#include "polhode/core/error.hpp"
#include "polhode/core/interrupt.hpp"

namespace polhode {

std::vector<ManySensitivity> compute_sensitivities(std::size_t n, const MakeScene& make_scene,
                                                   const std::vector<std::string>& groups,
                                                   const SensitivityOptions& options, int threads, bool refuse,
                                                   std::span<const std::uint64_t> numbers) {
  std::vector<ManySensitivity> all(n);
  std::atomic<std::size_t> next{0};
  std::atomic<bool> stopped{false};
  const auto differentiate = [&](std::size_t, std::size_t) {
    // Each free thread takes the next body, so a long run delays no other.
    for (std::size_t body = next++; body < n && !stopped; body = next++) {
      work_on(body, "a scene that solve() differentiates", stopped, [&] {
        check_interrupt();
        const auto fail = [&](const char* why) { all[body].failure = why; };
        const std::optional<Scene> scene = make_one(make_scene, body, refuse, fail);
        if (!scene) return;
        try {
          SensitivityOptions own = options;
          own.body = numbers.empty() ? options.body + body : numbers[body];
          all[body].found = compute_sensitivity(*scene, groups, own);
        } catch (const IntegrationFailure& error) {
          fail(error.what());
        }
      });
    }
  };
  const std::size_t workers = thread_count(threads, n, 2);
  parallel_for(workers, workers, 1, differentiate);
  return all;
}

}  // namespace polhode
