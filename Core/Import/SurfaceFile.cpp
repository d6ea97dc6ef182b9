// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Import/SurfaceFile.h"

#include <algorithm>
#include <cstring>
#include <new>
#include <type_traits>

namespace quadrille
{

namespace
{

/// act(a null pointer to the type).
template <class Act>
auto withType(NumberType type, const Act& act)
{
  switch (type)
  {
    case NumberType::Int8:
      return act(static_cast<std::int8_t*>(nullptr));
    case NumberType::UInt8:
      return act(static_cast<std::uint8_t*>(nullptr));
    case NumberType::Int16:
      return act(static_cast<std::int16_t*>(nullptr));
    case NumberType::UInt16:
      return act(static_cast<std::uint16_t*>(nullptr));
    case NumberType::Int32:
      return act(static_cast<std::int32_t*>(nullptr));
    case NumberType::UInt32:
      return act(static_cast<std::uint32_t*>(nullptr));
    case NumberType::Int64:
      return act(static_cast<std::int64_t*>(nullptr));
    case NumberType::Float32:
      return act(static_cast<float*>(nullptr));
    default:
      return act(static_cast<double*>(nullptr));
  }
}

} // namespace

std::size_t sizeOf(NumberType type)
{
  return withType(type, [](auto* number) { return sizeof(*number); });
}

NumberArray::NumberArray(NumberType type, std::size_t components, std::size_t rows)
  : type_(type), components_(components), rows_(rows),
    bytes_(static_cast<unsigned char*>(
      std::malloc(std::max<std::size_t>(1, sizeOf(type) * components * rows))))
{
  if (!bytes_)
  {
    throw std::bad_alloc();
  }
}

NumberArray NumberArray::ofIds(const std::vector<std::int64_t>& ids)
{
  NumberArray array(NumberType::Int64, 1, ids.size());
  std::copy(ids.begin(), ids.end(), array.as<std::int64_t>());
  return array;
}

double numberAt(const unsigned char* bytes, NumberType type)
{
  return withType(type,
    [&](auto* of)
    {
      std::remove_pointer_t<decltype(of)> number{};
      std::memcpy(&number, bytes, sizeof(number));
      return static_cast<double>(number);
    });
}

double NumberArray::get(std::size_t row, std::size_t component) const
{
  return numberAt(bytes_.get() + (components_ * row + component) * sizeOf(type_), type_);
}

void NumberArray::set(std::size_t row, std::size_t component, double value)
{
  const std::size_t index = components_ * row + component;
  withType(type_,
    [&](auto* of)
    {
      const auto number = static_cast<std::remove_pointer_t<decltype(of)>>(value);
      std::memcpy(bytes_.get() + index * sizeof(number), &number, sizeof(number));
    });
}

FileCells FileCells::of(
  const std::vector<std::int64_t>& offsets, const std::vector<std::int64_t>& ids)
{
  return { NumberArray::ofIds(offsets), NumberArray::ofIds(ids) };
}

} // namespace quadrille
