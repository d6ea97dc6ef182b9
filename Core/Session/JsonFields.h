// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Fields of JSON objects, written and read by one list of them. Reading refuses, with the name of the key, what is
/// missing, of another kind or unknown.
///
/// A list is a function of a FieldWriter or a FieldReader and of the values: need() for what an object has to have,
/// may() for what keeps its value where it is not there, and so on; both have the same functions.
#pragma once

#include "Base/Refuse.h"
#include "Session/SessionJson.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace quadrille
{

template <std::size_t kCount>
using FieldNames = std::array<const char*, kCount>;

class FieldWriter
{
public:
  explicit FieldWriter(SessionJson& json) : json_(json) {}

  template <typename Value>
  void need(const char* key, const Value& value)
  {
    json_[key] = jsonOf(value);
  }
  template <typename Value>
  void may(const char* key, const Value& value)
  {
    need(key, value);
  }
  /// Enumerators and truth values, by their names.
  template <typename Value, std::size_t kCount>
  void needName(const char* key, const Value& value, const FieldNames<kCount>& names)
  {
    json_[key] = names[static_cast<std::size_t>(value)];
  }
  template <typename Value, std::size_t kCount>
  void mayName(const char* key, const Value& value, const FieldNames<kCount>& names)
  {
    needName(key, value, names);
  }
  /// Left out where it is the usual one.
  template <typename Value, std::size_t kCount>
  void unlessUsual(
    const char* key, const Value& value, Value usual, const FieldNames<kCount>& names)
  {
    if (value != usual)
    {
      needName(key, value, names);
    }
  }
  /// null: none.
  void orNull(const char* key, const std::optional<double>& value)
  {
    json_[key] = value ? SessionJson(*value) : SessionJson(nullptr);
  }
  /// Both members, or neither.
  template <typename Value>
  void both(const char* key, Vector3 Value::*member, const char* other, Vector3 Value::*otherMember,
    const std::optional<Value>& value)
  {
    if (value)
    {
      need(key, (*value).*member);
      need(other, (*value).*otherMember);
    }
  }
  /// One object each. fields: its list.
  template <typename Value, typename Fields>
  void needEach(const char* key, const std::vector<Value>& values, const Fields& fields)
  {
    SessionJson& list = json_[key] = SessionJson::array();
    for (const Value& value : values)
    {
      SessionJson object;
      FieldWriter writer(object);
      fields(writer, value);
      list.push_back(std::move(object));
    }
  }
  template <typename Value, typename Fields>
  void mayEach(const char* key, const std::vector<Value>& values, const Fields& fields)
  {
    needEach(key, values, fields);
  }

private:
  template <typename Value>
  static SessionJson jsonOf(const Value& value)
  {
    if constexpr (std::is_same_v<Value, Vector3>)
    {
      return { value.x(), value.y(), value.z() };
    }
    else if constexpr (std::is_same_v<Value, std::vector<Vector3>>)
    {
      SessionJson list = SessionJson::array();
      for (const Vector3& p : value)
      {
        list.push_back(jsonOf(p));
      }
      return list;
    }
    else
    {
      return value;
    }
  }

  SessionJson& json_;
};

/// Takes the values of an object one by one; what is left at the end has no place in it.
class FieldReader
{
public:
  FieldReader(const SessionJson& json, std::string where) : json_(json), where_(std::move(where))
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
  template <typename Value>
  void need(const char* key, Value& value)
  {
    read(at(key), key, value);
  }
  template <typename Value>
  void may(const char* key, Value& value)
  {
    if (has(key))
    {
      need(key, value);
    }
  }
  template <typename Value, std::size_t kCount>
  void needName(const char* key, Value& value, const FieldNames<kCount>& names)
  {
    std::string name;
    need(key, name);
    std::string all;
    for (std::size_t i = 0; i < kCount; ++i)
    {
      if (name == names[i])
      {
        value = static_cast<Value>(i);
        return;
      }
      all += std::string(all.empty() ? "" : ", ") + names[i];
    }
    refuse("\"", key, "\" of ", where_, " is \"", name, "\", but must be one of: ", all);
  }
  template <typename Value, std::size_t kCount>
  void mayName(const char* key, Value& value, const FieldNames<kCount>& names)
  {
    if (has(key))
    {
      needName(key, value, names);
    }
  }
  template <typename Value, std::size_t kCount>
  void unlessUsual(const char* key, Value& value, Value /*usual*/, const FieldNames<kCount>& names)
  {
    mayName(key, value, names);
  }
  void orNull(const char* key, std::optional<double>& value)
  {
    if (has(key))
    {
      value.reset();
      if (!at(key).is_null())
      {
        need(key, value.emplace());
      }
    }
  }
  template <typename Value>
  void both(const char* key, Vector3 Value::*member, const char* other, Vector3 Value::*otherMember,
    std::optional<Value>& value)
  {
    if (has(key) || has(other))
    {
      value.emplace();
      need(key, (*value).*member);
      need(other, (*value).*otherMember);
    }
  }
  template <typename Value, typename Fields>
  void needEach(const char* key, std::vector<Value>& values, const Fields& fields)
  {
    const std::string where = "\"" + std::string(key) + "\" of " + where_;
    const SessionJson& list = at(key);
    if (!list.is_array())
    {
      refuse(where, " must be a list");
    }
    for (const SessionJson& object : list)
    {
      FieldReader reader(object, where);
      fields(reader, values.emplace_back());
      reader.finish();
    }
  }
  template <typename Value, typename Fields>
  void mayEach(const char* key, std::vector<Value>& values, const Fields& fields)
  {
    if (has(key))
    {
      needEach(key, values, fields);
    }
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
  void read(const SessionJson& json, const char* key, double& value) const
  {
    require(json.is_number(), key, "a number");
    value = json.get<double>();
  }
  void read(const SessionJson& json, const char* key, bool& value) const
  {
    require(json.is_boolean(), key, "true or false");
    value = json.get<bool>();
  }
  void read(const SessionJson& json, const char* key, std::string& value) const
  {
    require(json.is_string(), key, "a text");
    value = json.get<std::string>();
  }
  void read(const SessionJson& json, const char* key, Vector3& value) const
  {
    require(json.is_array() && json.size() == 3, key, "three numbers a point");
    for (Eigen::Index i = 0; i < 3; ++i)
    {
      read(json[static_cast<std::size_t>(i)], key, value[i]);
    }
  }
  template <typename Value>
  void read(const SessionJson& json, const char* key, std::vector<Value>& values) const
  {
    require(json.is_array(), key, "a list");
    values.clear();
    for (const SessionJson& each : json)
    {
      read(each, key, values.emplace_back());
    }
  }
  template <class Integer, std::enable_if_t<std::is_integral_v<Integer>, int> = 0>
  void read(const SessionJson& json, const char* key, Integer& value) const
  {
    using Limits = std::numeric_limits<Integer>;
    bool fits = false;
    if (json.is_number_unsigned())
    {
      fits = json.get<std::uint64_t>() <= static_cast<std::uint64_t>(Limits::max());
    }
    else if (json.is_number_integer())
    {
      fits =
        Limits::is_signed && json.get<std::int64_t>() >= static_cast<std::int64_t>(Limits::min());
    }
    require(fits, key, "a whole number in its range");
    value = json.get<Integer>();
  }

  const SessionJson& json_;
  std::string where_;
  std::set<std::string> taken_;
};

} // namespace quadrille
