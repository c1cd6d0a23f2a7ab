#pragma once

#include <vector>

#include "polhode/polhode.h"
#include "polhode/scene/scene.hpp"

struct polhode_scene {
  struct Torque {
    polhode::LastingTorque torque;
    std::vector<polhode::torques::Window> windows = {};   ///< none: it acts all the time
  };
  polhode::SceneParts parts;
  std::vector<Torque> torques = {};

  /// @throws InvalidInput for what no scene can have
  polhode::Scene make() const;
};
