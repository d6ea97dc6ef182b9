// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Import/SurfaceFile.h"

#include "Base/Refuse.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>

namespace quadrille
{

namespace
{

class ObjReader
{
public:
  explicit ObjReader(const std::string& path) : path_(path), file_(path)
  {
    refuseIf(!file_, path, ": cannot be opened for reading");
  }

  SurfaceFile read()
  {
    for (std::string line; nextLine(line);)
    {
      std::istringstream words(line.substr(0, line.find('#')));
      std::string kind;
      words >> kind;
      if (kind == "v")
      {
        readVertex(words);
      }
      else if (kind == "f")
      {
        readFace(words);
      }
    }
    requireCorners();
    SurfaceFile file;
    file.points = NumberArray(NumberType::Float64, 3, points_.size() / 3);
    std::copy(points_.begin(), points_.end(), file.points.as<double>());
    file.polygons = FileCells::of(offsets_, ids_);
    return file;
  }

private:
  [[noreturn]] void fail(std::size_t line, const std::string& reason) const
  {
    throw InvalidInput(path_ + ": line " + std::to_string(line) + " " + reason);
  }

  /// A backslash at the end of a line joins it with the next one.
  bool nextLine(std::string& line)
  {
    line.clear();
    for (std::string part; std::getline(file_, part);)
    {
      ++line_;
      if (!part.empty() && part.back() == '\r')
      {
        part.pop_back();
      }
      if (part.empty() || part.back() != '\\')
      {
        line += part;
        return true;
      }
      part.back() = ' ';
      line += part;
    }
    return !line.empty();
  }

  void readVertex(std::istringstream& words)
  {
    for (int k = 0; k < 3; ++k)
    {
      // As a word, as streams do not read "nan" and refuse what is too small for a number.
      std::string word;
      words >> word;
      char* end = nullptr;
      points_.push_back(std::strtod(word.c_str(), &end));
      if (word.empty() || *end != '\0')
      {
        fail(line_, "has no three coordinates of a vertex");
      }
    }
  }

  /// "1", "1/2", "1//3" or "1/2/3": the vertex, and what it has beside it.
  void readFace(std::istringstream& words)
  {
    const auto vertices = static_cast<std::int64_t>(points_.size() / 3);
    std::size_t corners = 0;
    for (std::string word; words >> word; ++corners)
    {
      char* end = nullptr;
      const std::int64_t id = std::strtoll(word.c_str(), &end, 10);
      if (end == word.c_str() || (*end != '\0' && *end != '/') || id == 0)
      {
        fail(line_, "has a face with the corner '" + word + "', which is no number of a vertex");
      }
      ids_.push_back(id > 0 ? id - 1 : vertices + id);
    }
    if (corners < 3)
    {
      fail(line_, "has a face with fewer than three corners");
    }
    offsets_.push_back(static_cast<std::int64_t>(ids_.size()));
    lineOfFace_.push_back(line_);
  }

  /// Faces may stand before their vertices.
  void requireCorners() const
  {
    const auto vertices = static_cast<std::int64_t>(points_.size() / 3);
    const auto bad = std::find_if(
      ids_.begin(), ids_.end(), [vertices](std::int64_t id) { return id < 0 || id >= vertices; });
    if (bad != ids_.end())
    {
      const auto face = std::upper_bound(offsets_.begin(), offsets_.end(), bad - ids_.begin());
      fail(lineOfFace_[static_cast<std::size_t>(face - offsets_.begin() - 1)],
        "refers to vertex " + std::to_string(*bad + 1) + ", but there are " +
          std::to_string(vertices));
    }
  }

  std::string path_;
  std::ifstream file_;
  std::size_t line_ = 0;
  std::vector<double> points_;
  std::vector<std::int64_t> offsets_{ 0 }, ids_;
  std::vector<std::size_t> lineOfFace_;
};

} // namespace

SurfaceFile readObj(const std::string& path)
{
  return ObjReader(path).read();
}

} // namespace quadrille
