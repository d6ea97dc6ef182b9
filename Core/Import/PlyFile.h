// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The bytes of a PLY file: its header, and its values one by one.
#pragma once

#include "Base/Refuse.h"
#include "Import/SurfaceFile.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

namespace quadrille
{

struct PlyProperty
{
  std::string name;
  std::optional<NumberType> type;
  std::optional<NumberType> countType; ///< of a list; none: a scalar
  bool isList() const { return countType.has_value(); }
};

struct PlyElement
{
  std::string name;
  std::int64_t count = 0;
  std::vector<PlyProperty> properties;
};

enum class PlyFormat
{
  Text,
  LittleEndian,
  BigEndian
};

class PlyFile
{
public:
  /// Throws InvalidInput where it cannot be read.
  explicit PlyFile(const std::string& path);

  const std::string& path() const { return path_; }
  PlyFormat format() const { return *format_; }
  const std::vector<PlyElement>& elements() const { return elements_; }
  std::size_t position() const { return position_; }
  void skipBytes(std::size_t count) { position_ += count; }

  [[noreturn]] void fail(const std::string& reason) const
  {
    throw InvalidInput(path_ + ": " + reason);
  }

  [[noreturn]] void failAt(
    const PlyElement& element, std::int64_t i, const std::string& reason) const
  {
    fail(element.name + " " + std::to_string(i) + " " + reason);
  }

  void requireInHeader(bool condition, const std::string& line) const
  {
    refuseIf(!condition, path_, ": the header has the line '", line, "'");
  }

  /// The first bytes of the file, at least so many where it has them.
  void load(std::uint64_t count);
  /// All bytes.
  void loadAll() { load(size_); }
  void readHeader();
  double scalar(const PlyElement& element, std::int64_t i, const PlyProperty& property);
  void list(const PlyElement& element, std::int64_t i, const PlyProperty& property,
    std::vector<std::int64_t>& values);

private:
  std::string nextLine();
  void readFormat(std::istringstream& words, const std::string& line);
  void readElement(std::istringstream& words, const std::string& line);
  void readProperty(std::istringstream& words, const std::string& line);
  /// Before any memory is spent: every element takes so many bytes at least.
  void checkSize(const PlyElement& element) const;
  /// False at the end of the file or, in text, where there is no number of this type.
  bool nextValue(NumberType type, double& value);
  bool nextText(double& value);
  bool nextBinary(NumberType type, double& value);

  std::string path_;
  std::uint64_t size_ = 0;   ///< of the file
  std::string bytes_;        ///< its first ones; all where its rows are not of one length
  std::size_t position_ = 0; ///< in the file
  std::optional<PlyFormat> format_;
  std::vector<PlyElement> elements_;
};

} // namespace quadrille
