// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Files that are whole or not there: written beside their place and renamed, every error of the disk told.
#pragma once

#include "Base/Error.h"

#include <charconv>
#include <cstdio>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>

namespace quadrille
{

/// The extension of a path in lower case, without the dot; empty when there is none.
std::string extensionOf(const std::string& path);

/// A file that cannot be written; the message names the file and the reason.
class WriteError : public std::runtime_error
{
public:
  using std::runtime_error::runtime_error;
};

/// Calls write with the name of a temporary file beside the path and renames it then. The temporary file has the
/// extension of the path, as some writers look at it. After an exception, which goes on, neither is there that was not
/// before. Throws WriteError where it cannot be renamed.
void writeThenRename(
  const std::string& path, const std::function<void(const std::string& temporary)>& write);

/// A file with a buffer and numbers in the shortest text that reads back to the same bits.
class OutputFile
{
public:
  /// Throws WriteError.
  explicit OutputFile(const std::string& path);

  OutputFile& operator<<(std::string_view text);
  OutputFile& operator<<(const char* text) { return *this << std::string_view(text); }
  OutputFile& operator<<(const std::string& text) { return *this << std::string_view(text); }
  OutputFile& operator<<(char c) { return *this << std::string_view(&c, 1); }
  template <class Number, std::enable_if_t<std::is_arithmetic_v<Number>, int> = 0>
  OutputFile& operator<<(Number number)
  {
    char text[40];
    const auto end = std::to_chars(text, text + sizeof(text), number).ptr;
    return *this << std::string_view(text, static_cast<std::size_t>(end - text));
  }
  /// The bytes of a value, in the order of this machine.
  template <class Value>
  OutputFile& writeBinary(const Value& value)
  {
    return *this << std::string_view(reinterpret_cast<const char*>(&value), sizeof(value));
  }

  /// Throws WriteError where anything could not be written. A file that is left without is not whole.
  void close();

private:
  struct Close
  {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  [[noreturn]] void fail() const;

  std::string path_;
  std::unique_ptr<std::FILE, Close> file_;
};

/// The shortest text that reads back to the same bits; where it is longer than `most` characters (at least 12), the
/// most digits that fit. With a decimal point or an exponent.
std::string realText(double number, std::size_t most = 32);

} // namespace quadrille
