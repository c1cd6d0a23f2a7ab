#include "polhode/solve/methods.hpp"

#include <algorithm>
#include <vector>

#include "polhode/core/error.hpp"
#include "solve/methods/body_method.hpp"
#include "solve/pieces.hpp"

namespace polhode {
namespace {

const std::vector<BodyMethod>& all() {
  static const std::vector<BodyMethod> list = [] {
    std::vector<BodyMethod> made;
#define POLHODE_METHOD(name) made.push_back(name##_method);
#include "polhode/solve/methods.def"
#undef POLHODE_METHOD
    return made;
  }();
  return list;
}

}  // namespace

const BodyMethod& find_body_method(std::string_view name) {
  for (const BodyMethod& method : all()) {
    if (method.record.name == name) return method;
  }
  std::string names;
  for (const BodyMethod& method : all()) {
    names.append(names.empty() ? "" : ", ").append(method.record.name);
  }
  throw InvalidInput("method", "one of " + names, "'" + std::string(name) + "'");
}

std::span<const ode::MethodRecord> methods() {
  static const std::vector<ode::MethodRecord> records = [] {
    std::vector<ode::MethodRecord> made;
    for (const BodyMethod& method : all()) made.push_back(method.record);
    return made;
  }();
  return records;
}

const ode::MethodRecord& find_method(std::string_view name) { return find_body_method(name).record; }

std::string compute_refusal(std::string_view method, const Scene& scene) {
  const BodyMethod& one = find_body_method(method);
  if (!one.refuse) return "";
  if (!has_windows(scene)) return one.refuse(scene);
  const Pieces pieces = cut(scene);
  for (const auto* one_way : {&pieces.backward, &pieces.forward}) {
    for (const Piece& piece : *one_way) {
      const std::string why = one.refuse(make_piece_scene(scene, piece, scene.start(), {piece.end}, scene.want()));
      if (!why.empty()) return pieces.whole ? why : why + ", " + describe_span(piece);
    }
  }
  return "";
}

}  // namespace polhode
