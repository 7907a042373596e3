#pragma once
/// @file Numbers as files store them in rows: their types, and their values.

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace freepath::io {

/// A type of stored numbers. Names of GridInfo::type follow from it.
enum class NumberType {
  kInt8,
  kUint8,
  kInt16,
  kUint16,
  kInt32,
  kUint32,
  kInt64,
  kUint64,
  kFloat,
  kDouble
};

/// Bytes that a number takes.
std::size_t size_of(NumberType type);

/// Name as GridInfo has it: "int8", "uint16", "float", "double", ...
std::string_view name_of(NumberType type);

/// Turns stored numbers into doubles; whole numbers above 2^53 are rounded.
/// @param stored as many numbers as there are values
void decode_numbers(NumberType type, std::endian order, std::span<const std::byte> stored,
                    std::span<double> values);

}  // namespace freepath::io
