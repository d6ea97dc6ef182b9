// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Import/PlyFile.h"

#include "Base/Refuse.h"
#include <algorithm>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <system_error>

namespace quadrille
{
namespace
{

/// What is read at first, for the header.
constexpr std::uint64_t kLongestHeader = 65536;

std::optional<NumberType> typeOf(const std::string& name)
{
  static const std::map<std::string, NumberType> kTypes = { { "char", NumberType::Int8 },
    { "int8", NumberType::Int8 }, { "uchar", NumberType::UInt8 }, { "uint8", NumberType::UInt8 },
    { "short", NumberType::Int16 }, { "int16", NumberType::Int16 },
    { "ushort", NumberType::UInt16 }, { "uint16", NumberType::UInt16 },
    { "int", NumberType::Int32 }, { "int32", NumberType::Int32 }, { "uint", NumberType::UInt32 },
    { "uint32", NumberType::UInt32 }, { "float", NumberType::Float32 },
    { "float32", NumberType::Float32 }, { "double", NumberType::Float64 },
    { "float64", NumberType::Float64 } };
  const auto found = kTypes.find(name);
  return found == kTypes.end() ? std::nullopt : std::optional(found->second);
}

bool isSpace(char c)
{
  return c == ' ' || c == '\n' || c == '\t' || c == '\r';
}

} // namespace

PlyFile::PlyFile(const std::string& path) : path_(path)
{
  std::error_code code;
  size_ = std::filesystem::file_size(path, code);
  refuseIf(code || !std::ifstream(path), path, ": cannot be opened for reading");
  load(kLongestHeader);
}

void PlyFile::load(std::uint64_t count)
{
  count = std::min<std::uint64_t>(count, size_);
  if (bytes_.size() >= count)
  {
    return;
  }
  bytes_.resize(count);
  std::ifstream file(path_, std::ios::binary);
  file.read(bytes_.data(), static_cast<std::streamsize>(count));
  refuseIf(
    file.gcount() != static_cast<std::streamsize>(count), path_, ": cannot be read to its end");
}

//----------------------------------------------------------------------------
// Header

std::string PlyFile::nextLine()
{
  if (bytes_.find('\n', position_) == std::string::npos)
  {
    load(size_);
  }
  refuseIf(position_ >= bytes_.size(), path_, ": the header has no end");
  const std::size_t end = std::min(bytes_.find('\n', position_), bytes_.size());
  std::string line = bytes_.substr(position_, end - position_);
  position_ = std::min(end + 1, bytes_.size());
  if (!line.empty() && line.back() == '\r')
  {
    line.pop_back();
  }
  return line;
}

void PlyFile::readHeader()
{
  refuseIf(bytes_.compare(0, 3, "ply") != 0 || nextLine() != "ply", path_, ": is no PLY file");
  for (std::string line = nextLine(); line != "end_header"; line = nextLine())
  {
    std::istringstream words(line);
    std::string keyword;
    words >> keyword;
    if (keyword == "format")
    {
      readFormat(words, line);
    }
    else if (keyword == "element")
    {
      readElement(words, line);
    }
    else if (keyword == "property")
    {
      readProperty(words, line);
    }
    else
    {
      requireInHeader(keyword == "comment" || keyword == "obj_info" || keyword.empty(), line);
    }
  }
  refuseIf(!format_, path_, ": the header names no format");
  for (const PlyElement& element : elements_)
  {
    checkSize(element);
  }
}

void PlyFile::readFormat(std::istringstream& words, const std::string& line)
{
  std::string name;
  words >> name;
  static const std::map<std::string, PlyFormat> kFormats = { { "ascii", PlyFormat::Text },
    { "binary_little_endian", PlyFormat::LittleEndian },
    { "binary_big_endian", PlyFormat::BigEndian } };
  const auto found = kFormats.find(name);
  requireInHeader(found != kFormats.end(), line);
  format_ = found->second;
}

void PlyFile::readElement(std::istringstream& words, const std::string& line)
{
  PlyElement element;
  requireInHeader((words >> element.name >> element.count) && element.count >= 0, line);
  elements_.push_back(element);
}

void PlyFile::readProperty(std::istringstream& words, const std::string& line)
{
  PlyProperty property;
  std::string type;
  words >> type;
  if (type == "list")
  {
    std::string count;
    words >> count >> type;
    property.countType = typeOf(count);
    requireInHeader(property.countType && property.countType != NumberType::Float32 &&
        property.countType != NumberType::Float64,
      line);
  }
  property.type = typeOf(type);
  requireInHeader(!elements_.empty() && property.type && (words >> property.name), line);
  elements_.back().properties.push_back(property);
}

void PlyFile::checkSize(const PlyElement& element) const
{
  std::size_t least = 0;
  for (const PlyProperty& property : element.properties)
  {
    const bool text = *format_ == PlyFormat::Text;
    least += text ? 1 : sizeOf(property.isList() ? *property.countType : *property.type);
  }
  refuseIf(
    least == 0 && element.count > 0, path_, ": the element ", element.name, " has no property");
  refuseIf(least > 0 && static_cast<std::size_t>(element.count) > size_ / least, path_,
    ": announces ", element.count, " of the element ", element.name, ", more than fit into its ",
    size_, " bytes");
}

//----------------------------------------------------------------------------
// Values

bool PlyFile::nextValue(NumberType type, double& value)
{
  return *format_ == PlyFormat::Text ? nextText(value) : nextBinary(type, value);
}

bool PlyFile::nextText(double& value)
{
  while (position_ < bytes_.size() && isSpace(bytes_[position_]))
  {
    ++position_;
  }
  const std::size_t begin = position_;
  while (position_ < bytes_.size() && !isSpace(bytes_[position_]))
  {
    ++position_;
  }
  const char* first = bytes_.data() + begin;
  const char* last = bytes_.data() + position_;
  first += first != last && *first == '+' ? 1 : 0;
  const auto [end, error] = std::from_chars(first, last, value);
  return first != last && error == std::errc() && end == last;
}

bool PlyFile::nextBinary(NumberType type, double& value)
{
  const std::size_t size = sizeOf(type);
  if (bytes_.size() - position_ < size)
  {
    return false;
  }
  unsigned char bytes[8];
  std::memcpy(bytes, bytes_.data() + position_, size);
  position_ += size;
  if (*format_ == PlyFormat::BigEndian)
  {
    std::reverse(bytes, bytes + size); // x86 and ARM are little-endian
  }
  value = numberAt(bytes, type);
  return true;
}

double PlyFile::scalar(const PlyElement& element, std::int64_t i, const PlyProperty& property)
{
  double value = 0;
  if (!nextValue(*property.type, value))
  {
    failAt(element, i, "has no valid " + property.name);
  }
  return value;
}

void PlyFile::list(const PlyElement& element, std::int64_t i, const PlyProperty& property,
  std::vector<std::int64_t>& values)
{
  double count = 0;
  if (!nextValue(*property.countType, count) || !(count >= 0) ||
    count > static_cast<double>(bytes_.size() - position_))
  {
    failAt(element, i, "has no valid length of " + property.name);
  }
  values.clear();
  for (double k = 0; k < count; ++k)
  {
    values.push_back(
      static_cast<std::int64_t>(std::clamp(scalar(element, i, property), -1e15, 1e15)));
  }
}

} // namespace quadrille
