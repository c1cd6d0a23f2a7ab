#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <exception>
#include <new>
#include <string>

#include "polhode/core/error.hpp"
#include "polhode/core/quat.hpp"
#include "polhode/inertia/inertia_tensor.hpp"
#include "polhode/polhode.h"

/// What every function of the C interface does: arguments are checked, exceptions become a status and a sentence.
namespace polhode::c {

/// A function of the caller ended the work.
struct Stopped : std::exception {
  explicit Stopped(std::string why) : sentence(std::move(why)) {}
  const char* what() const noexcept override { return sentence.c_str(); }
  std::string sentence;
};

/// Keeps the sentence for this thread. @return status
polhode_status fail(polhode_status status, const char* where, const char* sentence) noexcept;

/// The status of a piece of work.
template <class Work>
polhode_status call(const char* where, const Work& work) noexcept {
  try {
    work();
    return POLHODE_OK;
  } catch (const InvalidInput& error) {
    return fail(POLHODE_INVALID_INPUT, where, error.what());
  } catch (const IntegrationFailure& error) {
    return fail(POLHODE_FAILED, where, error.what());
  } catch (const Stopped& error) {
    return fail(POLHODE_STOPPED, where, error.what());
  } catch (const std::bad_alloc&) {
    return fail(POLHODE_NO_MEMORY, where, "there is not enough memory");
  } catch (const std::exception& error) {
    return fail(POLHODE_INTERNAL, where, error.what());
  } catch (...) {
    return fail(POLHODE_INTERNAL, where, "an unknown exception");
  }
}

template <class T>
T& need(T* pointer, const char* name) {
  if (pointer == nullptr) throw InvalidInput(std::string(name) + ": must not be NULL");
  return *pointer;
}

inline Vector3d vector(const double* numbers, const char* name) {
  return Vector3d(&need(numbers, name));
}

/// A null pointer is the attitude of a body whose axes are those of space.
inline Quat attitude(const double* q) { return q == nullptr ? Quat{} : Quat{q[0], q[1], q[2], q[3]}; }

inline Matrix3d matrix(const double* rows, const char* name) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(&need(rows, name));
}

inline InertiaTensor inertia(const double* rows) { return InertiaTensor(matrix(rows, "inertia")); }

/// Fills the fields that the caller knows.
template <class Facts>
void fill(Facts* out, Facts facts) {
  const std::size_t size = need(out, "facts").size;
  if (size < sizeof(size)) throw InvalidInput("facts: size must be sizeof the structure");
  facts.size = size;
  std::memcpy(static_cast<void*>(out), &facts, std::min(size, sizeof(Facts)));
}

/// An input by a caller who may know fewer fields, or more: those are 0, or this library is too old.
template <class Options>
Options read(const Options* in) {
  Options options{};
  if (in == nullptr) return options;
  const std::size_t size = in->size;
  if (size < sizeof(size)) throw InvalidInput("options: size must be sizeof the structure");
  const auto* bytes = reinterpret_cast<const unsigned char*>(in);
  if (size > sizeof(Options) && std::any_of(bytes + sizeof(Options), bytes + size, [](auto b) { return b != 0; })) {
    throw InvalidInput("options: a field is set that this version of polhode does not have");
  }
  std::memcpy(static_cast<void*>(&options), in, std::min(size, sizeof(Options)));
  return options;
}

/// States at given times, for each closed form.
template <class Motion>
void evaluate(const Motion& motion, const double* times, std::size_t count, double* omega, double* attitude) {
  if (count == 0) return;
  motion.at(&need(times, "times"), count, omega, attitude);
}

}  // namespace polhode::c
