// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Writes JSON, indented, members in the order of the calls.
#pragma once

#include <cmath>
#include <cstdio>
#include <string>

namespace quadrille
{

class Json
{
public:
  Json() { text_ = "{"; }

  void begin(const std::string& name) { open(name, '{'); }
  void beginList(const std::string& name) { open(name, '['); }
  /// An object in a list.
  void beginItem() { open("", '{'); }
  void end() { close('}'); }
  void endList() { close(']'); }

  void add(const std::string& name, const std::string& value) { member(name, quoted(value)); }
  void add(const std::string& name, const char* value) { member(name, quoted(value)); }
  void add(const std::string& name, bool value) { member(name, value ? "true" : "false"); }
  void add(const std::string& name, double value) { member(name, number(value)); }
  void add(const std::string& name, long long value) { member(name, std::to_string(value)); }
  void addItem(const std::string& value) { member("", quoted(value)); }

  /// The whole text; call once, after everything was closed.
  std::string text() const { return text_ + "\n}\n"; }

private:
  void open(const std::string& name, char bracket)
  {
    member(name, std::string(1, bracket));
    indent_ += 2;
    first_ = true;
  }
  void close(char bracket)
  {
    indent_ -= 2;
    text_ += "\n" + std::string(indent_, ' ') + bracket;
    first_ = false;
  }
  void member(const std::string& name, const std::string& value)
  {
    text_ += (first_ ? "\n" : ",\n") + std::string(indent_, ' ');
    text_ += name.empty() ? value : quoted(name) + ": " + value;
    first_ = false;
  }
  static std::string number(double value)
  {
    if (!std::isfinite(value))
    {
      return "null"; // JSON has no other word for it
    }
    char digits[40];
    std::snprintf(digits, sizeof(digits), "%.12g", value);
    return digits;
  }
  static std::string quoted(const std::string& value)
  {
    std::string result = "\"";
    for (const char c : value)
    {
      if (c == '"' || c == '\\')
      {
        result += '\\';
        result += c;
      }
      else if (static_cast<unsigned char>(c) < 0x20)
      {
        char escape[8];
        std::snprintf(escape, sizeof(escape), "\\u%04x", static_cast<unsigned>(c));
        result += escape;
      }
      else
      {
        result += c;
      }
    }
    return result + "\"";
  }

  std::string text_;
  std::size_t indent_ = 2;
  bool first_ = true;
};

} // namespace quadrille
