#include "polhode/solve/closed_form.hpp"

#include "solve/form/forms.hpp"
#include "solve/form/parts.hpp"

namespace polhode {

std::span<const ClosedFormRecord* const> closed_forms() {
  static constexpr const ClosedFormRecord* records[] = {
#define POLHODE_POINT(name, type) &form::name##_form,
      POLHODE_CLOSED_FORMS(POLHODE_POINT)
#undef POLHODE_POINT
  };
  return records;
}

const ClosedFormRecord* find_closed_form_record(const Scene& scene, const Facts& facts) {
  for (const ClosedFormRecord* record : closed_forms())
    if (!record->refuse(scene, facts, Words::no)) return record;
  return nullptr;
}

std::shared_ptr<const ClosedForm> find_closed_form(const Scene& scene, const Facts& facts) {
  const ClosedFormRecord* record = find_closed_form_record(scene, facts);
  return record != nullptr ? record->make(scene, facts) : nullptr;
}

std::string explain_no_closed_form(const Scene& scene, const Facts& facts) {
  std::string reasons;
  const std::span<const ClosedFormRecord* const> forms = closed_forms();
  for (auto form = forms.rbegin(); form != forms.rend(); ++form) {
    const ClosedFormRecord* record = *form;
    if (record->is_near == nullptr || !record->is_near(scene, facts)) continue;
    if (!reasons.empty()) reasons.append(". No ").append(record->name).append(": ");
    reasons += record->refuse(scene, facts, Words::yes).why;
  }
  return reasons;
}

}  // namespace polhode
