#pragma once

#include <cmath>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "polhode/core/error.hpp"
#include "polhode/core/float_state.hpp"
#include "polhode/formula/expression.hpp"
#include "polhode/formula/program.hpp"
#include "polhode/torque/record.hpp"

namespace polhode::torques {

/// A choice among the words of a parameter, by its number.
struct Choice {
  int number = 0;
};

}  // namespace polhode::torques

// A struct of a law's numbers, its record, and the lists between them.
namespace polhode::torques::detail {

template <class T>
void visit_numbers(T& one, auto&& use) { use(one); }
template <class T, std::size_t n>
void visit_numbers(formula::Vec<T, n>& v, auto&& use) { for (T& one : v.components) use(one); }
template <class T, std::size_t n>
void visit_numbers(const formula::Vec<T, n>& v, auto&& use) { for (const T& one : v.components) use(one); }
template <class T>
void visit_numbers(formula::Mat<T>& m, auto&& use) { for (T& one : m.entries) use(one); }
template <class T>
void visit_numbers(const formula::Mat<T>& m, auto&& use) { for (const T& one : m.entries) use(one); }
inline void visit_numbers(Choice&, auto&&) {}
inline void visit_numbers(const Choice&, auto&&) {}
inline void visit_numbers(formula::Ephemeris&, auto&&) {}
inline void visit_numbers(const formula::Ephemeris&, auto&&) {}

/// Calls use(field) for each field of a struct.
template <class Struct>
void for_each_field(Struct& numbers, auto&& use) {
  std::apply([&](auto&... fields) { (use(fields), ...); }, std::remove_const_t<Struct>::list(numbers));
}

/// Calls use(number) for each number of a struct, or of a vector.
template <class Numbers>
void for_each_number(Numbers& numbers, auto&& use) {
  if constexpr (requires { std::remove_const_t<Numbers>::list(numbers); }) {
    for_each_field(numbers, [&](auto& field) { visit_numbers(field, use); });
  } else {
    visit_numbers(numbers, use);
  }
}

/// The number of a word among those of a parameter.
inline int find_choice(std::string_view choices, std::string_view word) {
  for (int number = 0;; ++number) {
    const std::size_t end = choices.find('|');
    if (choices.substr(0, end) == word) return number;
    if (end == std::string_view::npos) throw InvalidInput("choice", "one of its words", word);
    choices.remove_prefix(end + 1);
  }
}
inline std::string name_choice(std::string_view choices, int number) {
  for (; number > 0; --number) choices.remove_prefix(choices.find('|') + 1);
  return std::string(choices.substr(0, choices.find('|')));
}

inline void read(const TorqueParameter&, const TorqueValue& value, double& field) { field = std::get<double>(value); }
inline void read(const TorqueParameter&, const TorqueValue& value, formula::Vec<double, 3>& field) {
  for (int i = 0; i < 3; ++i) field[static_cast<std::size_t>(i)] = std::get<Vector3d>(value)[i];
}
inline void read(const TorqueParameter&, const TorqueValue& value, formula::Mat<double>& field) {
  for (int i = 0; i < 9; ++i) field.entries[static_cast<std::size_t>(i)] = std::get<Matrix3d>(value)(i / 3, i % 3);
}
inline void read(const TorqueParameter& parameter, const TorqueValue& value, Choice& field) {
  field.number = find_choice(parameter.choices, std::get<std::string>(value));
}

inline void read(const TorqueParameter&, const TorqueValue& value, formula::Ephemeris& field) {
  field = std::get<formula::Ephemeris>(value);
}

inline TorqueValue write(const TorqueParameter&, const formula::Ephemeris& field) { return field; }
inline TorqueValue write(const TorqueParameter&, double field) { return field; }
inline TorqueValue write(const TorqueParameter&, const formula::Vec<double, 3>& field) {
  return Vector3d(field[0], field[1], field[2]);
}
inline TorqueValue write(const TorqueParameter&, const formula::Mat<double>& field) {
  Matrix3d m;
  for (int i = 0; i < 9; ++i) m(i / 3, i % 3) = field.entries[static_cast<std::size_t>(i)];
  return m;
}
inline TorqueValue write(const TorqueParameter& parameter, const Choice& field) {
  return name_choice(parameter.choices, field.number);
}

template <class Numbers>
Numbers read_numbers(const TorqueRecord& record, std::span<const TorqueValue> values) {
  Numbers numbers;
  std::size_t next = 0;
  for_each_field(numbers, [&](auto& field) { read(record.parameters[next], values[next], field), ++next; });
  return numbers;
}

template <class Numbers>
TorqueValues list_values(const TorqueRecord& record, const Numbers& numbers) {
  TorqueValues values;
  for_each_field(numbers, [&](const auto& field) { values.push_back(write(record.parameters[values.size()], field)); });
  return values;
}

/// @throws InvalidInput
inline void require_finite(std::string_view where, const double* values, int count) {
  for (int i = 0; i < count; ++i) {
    if (!std::isfinite(values[i])) throw InvalidInput(where, "finite", to_text(values[i]));
    require_kept(values[i], where);
  }
}

template <class Numbers>
void require_finite_numbers(const TorqueRecord& record, const Numbers& numbers) {
  std::size_t next = 0;
  for_each_field(numbers, [&](const auto& field) {
    const std::string where = std::string(record.name) + "." + std::string(record.parameters[next++].name);
    visit_numbers(field, [&](double number) { require_finite(where, &number, 1); });
  });
}

/// The fields of a struct that are no numbers in another of the same fields: choices and orbits.
template <class Kept = Choice, class From, class To>
void copy_choices(const From& from, To& to) {
  std::vector<Kept> kept;
  for_each_field(from, [&]<class Field>(const Field& field) {
    if constexpr (std::is_same_v<Field, Kept>) kept.push_back(field);
  });
  std::size_t next = 0;
  for_each_field(to, [&]<class Field>(Field& field) {
    if constexpr (std::is_same_v<Field, Kept>) field = kept[next++];
  });
  if constexpr (std::is_same_v<Kept, Choice>) copy_choices<formula::Ephemeris>(from, to);
}

/// The fields as inputs of a formula, choices left out.
template <class Numbers>
std::vector<formula::Input> list_inputs(const auto& name_of, const Numbers& numbers) {
  std::vector<formula::Input> inputs;
  std::size_t next = 0;
  for_each_field(numbers, [&](const auto& field) {
    std::vector<double> own;
    visit_numbers(field, [&](double number) { own.push_back(number); });
    const std::string name(name_of(next++));
    if (!own.empty()) inputs.push_back({name, std::move(own)});
  });
  return inputs;
}
template <class Numbers>
std::vector<formula::Input> list_inputs(const TorqueRecord& record, const Numbers& numbers) {
  return list_inputs([&](std::size_t i) { return record.parameters[i].name; }, numbers);
}
template <class Numbers, std::size_t n>
std::vector<formula::Input> list_inputs(const std::string_view (&names)[n], const Numbers& numbers) {
  return list_inputs([&](std::size_t i) { return names[i]; }, numbers);
}

}  // namespace polhode::torques::detail
