#pragma once

#include <optional>
#include <string>
#include <vector>

#include "polhode/formula/recognise.hpp"
#include "polhode/scene/scene.hpp"

namespace polhode {

/// What formulas were recognised as, for scenes that share them. It serves one thread.
class Recognitions {
 public:
  /// The torques of the list whose sum a formula is; none if it is no such sum.
  const std::optional<std::vector<formula::KnownTorque>>& find(const torques::Formula& formula, const Scene& scene);

 private:
  static constexpr std::size_t most = 16;   // beyond it a search would cost more than it saves
  struct Entry {
    torques::Formula formula;
    Matrix3d given_inertia_B, inertia_B;
    bool any_inertia;   ///< the same for every body
    std::optional<std::vector<formula::KnownTorque>> parts;
  };
  std::vector<Entry> entries_;
};

/// Whether a formula that is no torque of the list becomes a compiled function, which is integrated as the user's own.
enum class AsCustom { no, yes };

/// A torque whose formula, if it is one, is not replaced.
AnyTorque as_given(const AnyTorque& torque);

/// The scene without the formulas that are torques of the list: each is replaced by them, if its user allows it. Other
/// torques keep their numbers in the list.
/// @param recognised  gets one sentence for each such formula, or null
Scene resolve_formulas(const Scene& scene, AsCustom as_custom, std::vector<std::string>* recognised = nullptr);
Scene resolve_formulas(const Scene& scene, AsCustom as_custom, Recognitions& known,
                       std::vector<std::string>* recognised = nullptr);

}  // namespace polhode
