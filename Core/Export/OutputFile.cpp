// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Export/OutputFile.h"

#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>

namespace quadrille
{

namespace
{

namespace fs = std::filesystem;

void removeQuietly(const fs::path& path)
{
  std::error_code ignored;
  fs::remove(path, ignored);
}

} // namespace

std::string extensionOf(const std::string& path)
{
  std::string extension = fs::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
    [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension.empty() ? extension : extension.substr(1);
}

void writeThenRename(
  const std::string& path, const std::function<void(const std::string& temporary)>& write)
{
  const fs::path target(path);
  const fs::path temporary = target.parent_path() /
    (target.stem().string() + ".part" + std::to_string(::getpid()) + target.extension().string());
  try
  {
    write(temporary.string());
    fs::rename(temporary, target);
  }
  catch (const fs::filesystem_error& error)
  {
    removeQuietly(temporary);
    throw WriteError(path + ": " + error.code().message());
  }
  catch (const WriteError& error)
  {
    removeQuietly(temporary);
    // The user knows the file by its own name.
    std::string text = error.what();
    const std::string name = temporary.string();
    for (std::size_t at = text.find(name); at != std::string::npos; at = text.find(name, at))
    {
      text.replace(at, name.size(), path);
      at += path.size();
    }
    throw WriteError(text);
  }
  catch (...)
  {
    removeQuietly(temporary);
    throw;
  }
}

OutputFile::OutputFile(const std::string& path) : path_(path), file_(std::fopen(path.c_str(), "wb"))
{
  if (!file_)
  {
    fail();
  }
}

void OutputFile::fail() const
{
  throw WriteError(path_ + ": cannot be written: " + std::strerror(errno));
}

OutputFile& OutputFile::operator<<(std::string_view text)
{
  if (std::fwrite(text.data(), 1, text.size(), file_.get()) != text.size())
  {
    fail();
  }
  return *this;
}

void OutputFile::close()
{
  if (std::fclose(file_.release()) != 0)
  {
    fail();
  }
}

std::string realText(double number, std::size_t most)
{
  constexpr std::size_t kRoom = 40;
  char text[kRoom];
  std::size_t size = static_cast<std::size_t>(std::to_chars(text, text + kRoom, number).ptr - text);
  const auto isReal = [&] { return std::string_view(text, size).find_first_of(".e") < size; };
  for (int digits = 17; size + (isReal() ? 0 : 1) > most && digits > 1; --digits)
  {
    const auto end =
      std::to_chars(text, text + kRoom, number, std::chars_format::general, digits).ptr;
    size = static_cast<std::size_t>(end - text);
  }
  return std::string(text, size) + (isReal() ? "" : ".");
}

} // namespace quadrille
