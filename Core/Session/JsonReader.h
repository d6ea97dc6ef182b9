// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Reads the values of a JSON object; refuses, with the name of the key, what is missing, of another kind or unknown.
#pragma once

#include "Base/Refuse.h"
#include "Session/SessionJson.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <set>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace quadrille
{

/// Takes the values of an object one by one; what is left at the end has no place in it.
class ObjectReader
{
public:
  ObjectReader(const SessionJson& json, std::string where) : json_(json), where_(std::move(where))
  {
    if (!json.is_object())
    {
      refuse(where_, " is no JSON object");
    }
  }

  bool has(const char* key) const { return json_.contains(key); }

  const SessionJson& at(const char* key)
  {
    if (!has(key))
    {
      refuse(where_, " has no \"", key, "\"");
    }
    taken_.insert(key);
    return json_[key];
  }
  void read(const char* key, double& value) { value = numberIn(at(key), key); }
  void read(const char* key, bool& value)
  {
    require(at(key).is_boolean(), key, "true or false");
    value = json_[key].get<bool>();
  }
  void read(const char* key, std::string& value)
  {
    require(at(key).is_string(), key, "a text");
    value = json_[key].get<std::string>();
  }
  template <class Integer, std::enable_if_t<std::is_integral_v<Integer>, int> = 0>
  void read(const char* key, Integer& value)
  {
    value = integerIn<Integer>(at(key), key);
  }
  void read(const char* key, Vector3& value) { value = pointIn(at(key), key); }
  template <class T>
  void read(const char* key, std::vector<T>& values)
  {
    require(at(key).is_array(), key, "a list");
    values.clear();
    for (const SessionJson& value : json_[key])
    {
      if constexpr (std::is_same_v<T, Vector3>)
      {
        values.push_back(pointIn(value, key));
      }
      else
      {
        values.push_back(integerIn<T>(value, key));
      }
    }
  }
  template <class T>
  void readIf(const char* key, T& value)
  {
    if (has(key))
    {
      read(key, value);
    }
  }
  template <std::size_t kCount>
  std::size_t readName(const char* key, const std::array<const char*, kCount>& names)
  {
    std::string name;
    read(key, name);
    for (std::size_t i = 0; i < kCount; ++i)
    {
      if (name == names[i])
      {
        return i;
      }
    }
    std::string all;
    for (const char* known : names)
    {
      all += std::string(all.empty() ? "" : ", ") + known;
    }
    refuse("\"", key, "\" of ", where_, " is \"", name, "\", but must be one of: ", all);
  }
  void finish() const
  {
    for (const auto& [key, value] : json_.items())
    {
      if (taken_.count(key) == 0)
      {
        refuse(where_, " has \"", key, "\", which is not known here");
      }
    }
  }
  const std::string& where() const { return where_; }

private:
  void require(bool is, const char* key, const char* what) const
  {
    if (!is)
    {
      refuse("\"", key, "\" of ", where_, " must be ", what);
    }
  }
  double numberIn(const SessionJson& value, const char* key) const
  {
    require(value.is_number(), key, "a number");
    return value.get<double>();
  }
  Vector3 pointIn(const SessionJson& value, const char* key) const
  {
    require(value.is_array() && value.size() == 3, key, "three numbers a point");
    return { numberIn(value[0], key), numberIn(value[1], key), numberIn(value[2], key) };
  }
  template <class Integer>
  Integer integerIn(const SessionJson& value, const char* key) const
  {
    using Limits = std::numeric_limits<Integer>;
    bool fits = false;
    if (value.is_number_unsigned())
    {
      fits = value.get<std::uint64_t>() <= static_cast<std::uint64_t>(Limits::max());
    }
    else if (value.is_number_integer())
    {
      fits =
        Limits::is_signed && value.get<std::int64_t>() >= static_cast<std::int64_t>(Limits::min());
    }
    require(fits, key, "a whole number in its range");
    return value.get<Integer>();
  }

  const SessionJson& json_;
  std::string where_;
  std::set<std::string> taken_;
};

} // namespace quadrille
