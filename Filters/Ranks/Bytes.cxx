// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Ranks/Bytes.h"

#include <cstring>
#include <stdexcept>

namespace quadrille
{

void Packer::number(double value)
{
  bytes_.append(reinterpret_cast<const char*>(&value), sizeof(value));
}

void Packer::count(std::uint64_t value)
{
  bytes_.append(reinterpret_cast<const char*>(&value), sizeof(value));
}

void Packer::text(const std::string& value)
{
  count(value.size());
  bytes_.append(value);
}

void Unpacker::take(void* target, std::size_t size)
{
  if (bytes_.size() - at_ < size)
  {
    throw std::logic_error("a message between ranks is too short");
  }
  std::memcpy(target, bytes_.data() + at_, size);
  at_ += size;
}

std::size_t Unpacker::checkedCount(std::size_t size)
{
  const std::uint64_t all = count();
  if (all > (bytes_.size() - at_) / size)
  {
    throw std::logic_error("a message between ranks is too short");
  }
  return static_cast<std::size_t>(all);
}

double Unpacker::number()
{
  double value = 0;
  take(&value, sizeof(value));
  return value;
}

std::uint64_t Unpacker::count()
{
  std::uint64_t value = 0;
  take(&value, sizeof(value));
  return value;
}

std::string Unpacker::text()
{
  std::string value(count(), '\0');
  take(value.data(), value.size());
  return value;
}

} // namespace quadrille
