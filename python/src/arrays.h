#pragma once
/// @file NumPy arrays of what the library makes.

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <cstddef>
#include <initializer_list>
#include <memory>
#include <utility>
#include <vector>

namespace freepath::python {

namespace nb = nanobind;

/// What an array that lives in Python holds: uninitialised, so that threads touch it first.
template <class T>
class ArrayMemory {
 public:
  explicit ArrayMemory(std::size_t count) : values_(new T[count]) {}
  T* data() { return values_.get(); }

  /// Hands the memory to a NumPy array of this shape. Needs the GIL.
  nb::object to_numpy(std::initializer_list<std::size_t> shape) && {
    T* const values = values_.get();
    nb::capsule owner(values, [](void* memory) noexcept { delete[] static_cast<T*>(memory); });
    values_.release();  // NOLINT(bugprone-unused-return-value): the capsule has it
    return nb::cast(nb::ndarray<nb::numpy, T>(values, shape, owner));
  }

 private:
  std::unique_ptr<T[]> values_;  // NOLINT(modernize-avoid-c-arrays)
};

/// A NumPy array that takes over a vector. Needs the GIL.
template <class T>
nb::object to_numpy(std::vector<T> values, std::initializer_list<std::size_t> shape) {
  auto* const kept = new std::vector<T>(std::move(values));
  const nb::capsule owner(
      kept, [](void* memory) noexcept { delete static_cast<std::vector<T>*>(memory); });
  return nb::cast(nb::ndarray<nb::numpy, T>(kept->data(), shape, owner));
}

}  // namespace freepath::python
