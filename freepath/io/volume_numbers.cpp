#include "freepath/io/volume_numbers.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace freepath::io {
namespace {

/// Calls a function with a value of the type that numbers are stored in.
template <class Use>
auto with_number(NumberType type, Use use) {
  switch (type) {
    case NumberType::kInt8:
      return use(int8_t{});
    case NumberType::kUint8:
      return use(uint8_t{});
    case NumberType::kInt16:
      return use(int16_t{});
    case NumberType::kUint16:
      return use(uint16_t{});
    case NumberType::kInt32:
      return use(int32_t{});
    case NumberType::kUint32:
      return use(uint32_t{});
    case NumberType::kInt64:
      return use(int64_t{});
    case NumberType::kUint64:
      return use(uint64_t{});
    case NumberType::kFloat:
      return use(float{});
    case NumberType::kDouble:
      break;
  }
  return use(double{});
}

template <class T>
void decode_as(bool swap, std::span<const std::byte> stored, std::span<double> values) {
  std::array<std::byte, sizeof(T)> bytes;
  for (std::size_t i = 0; i < values.size(); ++i) {
    std::memcpy(bytes.data(), stored.data() + i * sizeof(T), sizeof(T));
    if (swap) std::reverse(bytes.begin(), bytes.end());
    values[i] = static_cast<double>(std::bit_cast<T>(bytes));
  }
}

}  // namespace

std::size_t size_of(NumberType type) {
  return with_number(type, [](auto number) { return sizeof(number); });
}

std::string_view name_of(NumberType type) {
  constexpr std::array<std::string_view, 10> kNames{
      "int8", "uint8", "int16", "uint16", "int32", "uint32", "int64", "uint64", "float", "double"};
  return kNames[static_cast<std::size_t>(type)];
}

void decode_numbers(NumberType type, std::endian order, std::span<const std::byte> stored,
                    std::span<double> values) {
  with_number(type, [&]<class T>(T /*number*/) {
    decode_as<T>(order != std::endian::native, stored, values);
  });
}

}  // namespace freepath::io
