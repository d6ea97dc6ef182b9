// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Import/SurfaceFile.h"

#include "Base/Refuse.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <string_view>
#include <vector>

namespace quadrille
{

namespace
{

/// Lines without comments; blank ones are skipped.
class Lines
{
public:
  explicit Lines(std::string text) : text_(std::move(text)) {}

  /// False at the end of the file.
  bool next(std::string_view& line)
  {
    while (position_ < text_.size())
    {
      std::size_t end = text_.find('\n', position_);
      end = end == std::string::npos ? text_.size() : end;
      line = std::string_view(text_).substr(position_, end - position_);
      line = line.substr(0, line.find('#'));
      position_ = end + 1;
      if (line.find_first_not_of(" \t\r") != std::string_view::npos)
      {
        return true;
      }
    }
    return false;
  }

private:
  std::string text_;
  std::size_t position_ = 0;
};

/// The next word of a line, which is shortened by it; empty at the end.
std::string_view nextWord(std::string_view& line)
{
  const std::size_t begin = line.find_first_not_of(" \t\r");
  if (begin == std::string_view::npos)
  {
    line = {};
    return {};
  }
  const std::size_t end = std::min(line.find_first_of(" \t\r", begin), line.size());
  const std::string_view word = line.substr(begin, end - begin);
  line = line.substr(end);
  return word;
}

template <class Number>
bool parseWord(std::string_view word, Number& value)
{
  if (!word.empty() && word.front() == '+')
  {
    word.remove_prefix(1);
  }
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return !word.empty() && error == std::errc() && end == word.data() + word.size();
}

using Words = std::vector<std::string_view>;

/// What is left of a line.
Words wordsOf(std::string_view line)
{
  Words words;
  for (std::string_view word = nextWord(line); !word.empty(); word = nextWord(line))
  {
    words.push_back(word);
  }
  return words;
}

/// The numbers of the words from `first` on; false where one of them is none or missing.
template <class Number, std::size_t Count>
bool parseWords(const Words& words, std::size_t first, Number (&numbers)[Count])
{
  for (std::size_t k = 0; k < Count; ++k)
  {
    if (first + k >= words.size() || !parseWord(words[first + k], numbers[k]))
    {
      return false;
    }
  }
  return true;
}

/// Colours of vertices or of faces, with as many parts as the first of them has. Their parts go from 0 to 1 where one
/// of them has a decimal point, else from 0 to 255.
class Colors
{
public:
  /// False where the words from `first` to `last` are no colour, or one of another kind than those before.
  bool add(const Words& words, std::size_t first, std::size_t last)
  {
    const std::size_t parts = last - first;
    if (parts < 3 || parts > 4 || (parts_ != 0 && parts != parts_))
    {
      return false;
    }
    parts_ = parts;
    for (std::size_t k = first; k < last; ++k)
    {
      double value = 0;
      if (!parseWord(words[k], value) || !(value >= 0))
      {
        return false;
      }
      most_ = std::max(most_, value);
      areFractions_ = areFractions_ || words[k].find('.') != std::string_view::npos;
      values_.push_back(value);
    }
    return most_ <= whole();
  }

  /// Adds the array where there is a colour for each of so many elements.
  void addTo(std::vector<FileArray>& arrays, long long count) const
  {
    if (values_.empty() || values_.size() != parts_ * static_cast<std::size_t>(count) ||
      most_ > whole())
    {
      return;
    }
    FileArray array{ parts_ == 4 ? "RGBA" : "RGB", ArrayRole::Colours,
      NumberArray(NumberType::UInt8, parts_, static_cast<std::size_t>(count)) };
    std::transform(values_.begin(), values_.end(), array.numbers.bytes(),
      [this](double value)
      { return static_cast<unsigned char>(std::lround(255 / whole() * value)); });
    arrays.push_back(std::move(array));
  }

private:
  double whole() const { return areFractions_ ? 1 : 255; }

  std::size_t parts_ = 0;
  bool areFractions_ = false;
  double most_ = 0;
  std::vector<double> values_;
};

class OffReader
{
public:
  OffReader(const std::string& path, std::string text) : path_(path), lines_(std::move(text)) {}

  SurfaceFile read()
  {
    readHeader();
    readVertices();
    readFaces();
    return std::move(data_);
  }

private:
  [[noreturn]] void fail(const std::string& reason) const
  {
    throw InvalidInput(path_ + ": " + reason);
  }
  void requireAtVertex(bool condition, long long i, const char* reason) const
  {
    refuseIf(!condition, path_, ": vertex ", i, " ", reason);
  }

  /// "[ST][C][N]OFF" and then three counts, on the same line or the next one.
  void readHeader()
  {
    std::string_view line;
    refuseIf(!lines_.next(line), path_, ": is empty");
    readKind(nextWord(line));
    std::string_view rest = line;
    if (nextWord(rest) == "BINARY")
    {
      fail("is a binary OFF file; only the text form is read");
    }
    rest = line;
    refuseIf(nextWord(rest).empty() && !lines_.next(line), path_, ": has no counts");
    if (!parseWord(nextWord(line), pointCount_) || !parseWord(nextWord(line), faceCount_) ||
      pointCount_ < 0 || faceCount_ < 0)
    {
      fail("has no valid counts of vertices and faces");
    }
  }

  void readKind(std::string_view magic)
  {
    refuseIf(magic.size() < 3 || magic.substr(magic.size() - 3) != "OFF" ||
        magic.find_first_of("4n") != std::string_view::npos,
      path_, ": does not begin with OFF, or is of a kind other than three-dimensional");
    magic.remove_suffix(3);
    hasTexture_ = magic.substr(0, 2) == "ST";
    magic.remove_prefix(hasTexture_ ? 2 : 0);
    hasColors_ = magic.find('C') != std::string_view::npos;
    hasNormals_ = magic.find('N') != std::string_view::npos;
  }

  static NumberArray tableOf(const std::vector<double>& values, std::size_t components)
  {
    NumberArray table(NumberType::Float64, components, values.size() / components);
    std::copy(values.begin(), values.end(), table.as<double>());
    return table;
  }

  void readVertices()
  {
    std::vector<double> points, normals, texture;
    Colors colors;
    std::string_view line;
    for (long long i = 0; i < pointCount_; ++i)
    {
      const Words words = lines_.next(line) ? wordsOf(line) : Words{};
      double p[3];
      requireAtVertex(parseWords(words, 0, p), i, "is missing or has no three numbers");
      points.insert(points.end(), std::begin(p), std::end(p));
      readExtras(i, words, normals, texture, colors);
    }
    data_.points = tableOf(points, 3);
    if (hasNormals_)
    {
      data_.pointData.push_back({ "Normals", ArrayRole::Normals, tableOf(normals, 3) });
    }
    if (hasTexture_)
    {
      data_.pointData.push_back({ "TCoords", ArrayRole::TextureCoordinates, tableOf(texture, 2) });
    }
    colors.addTo(data_.pointData, pointCount_);
  }

  /// What the kind of file promises beside the coordinates, in its order: normal, colour, texture coordinates.
  void readExtras(long long i, const Words& words, std::vector<double>& normals,
    std::vector<double>& texture, Colors& colors) const
  {
    std::size_t first = 3;
    if (hasNormals_)
    {
      double n[3];
      requireAtVertex(parseWords(words, first, n), i,
        "has no normal of three numbers, as the file's first word promises");
      normals.insert(normals.end(), std::begin(n), std::end(n));
      first += 3;
    }
    if (hasTexture_)
    {
      double st[2];
      // The last two words; where there is no colour, those that come next.
      const std::size_t column = hasColors_ && words.size() >= first + 5 ? words.size() - 2 : first;
      requireAtVertex(parseWords(words, column, st), i,
        "has no two texture coordinates, as the file's first word promises");
      texture.insert(texture.end(), std::begin(st), std::end(st));
    }
    const std::size_t last = words.size() - (hasTexture_ ? 2 : 0);
    requireAtVertex(!(hasColors_ && (last < first || !colors.add(words, first, last))), i,
      "has no colour of three or four parts like the others, as the file's first word promises");
  }

  void readFaces()
  {
    std::vector<std::int64_t> offsets{ 0 }, ids;
    std::vector<int> indices;
    Colors colors;
    std::string_view line;
    for (long long f = 0; f < faceCount_; ++f)
    {
      readCorners(f, line, ids);
      offsets.push_back(static_cast<std::int64_t>(ids.size()));
      const Words words = wordsOf(line);
      int index = 0;
      if (words.size() == 1 && parseWord(words[0], index))
      {
        indices.push_back(index);
      }
      else
      {
        colors.add(words, 0, words.size());
      }
    }
    data_.polygons = FileCells::of(offsets, ids);
    colors.addTo(data_.cellData, faceCount_);
    if (faceCount_ > 0 && static_cast<long long>(indices.size()) == faceCount_)
    {
      NumberArray numbers(NumberType::Int32, 1, indices.size());
      std::copy(indices.begin(), indices.end(), numbers.as<int>());
      data_.cellData.push_back({ "ColorIndex", ArrayRole::None, std::move(numbers) });
    }
  }

  /// Appends the corners of face f; the line keeps what stands behind them.
  void readCorners(long long f, std::string_view& line, std::vector<std::int64_t>& corners)
  {
    long long count = 0;
    refuseIf(!lines_.next(line) || !parseWord(nextWord(line), count) || count < 0, path_, ": face ",
      f, " is missing or has no number of corners");
    for (long long i = 0; i < count; ++i)
    {
      long long id = 0;
      refuseIf(!parseWord(nextWord(line), id) || id < 0 || id >= pointCount_, path_, ": face ", f,
        " has a corner that is missing or no vertex");
      corners.push_back(id);
    }
  }

  std::string path_;
  Lines lines_;
  bool hasTexture_ = false;
  bool hasColors_ = false;
  bool hasNormals_ = false;
  long long pointCount_ = 0;
  long long faceCount_ = 0;
  SurfaceFile data_;
};

} // namespace

SurfaceFile readOff(const std::string& path)
{
  std::ifstream file(path, std::ios::binary);
  refuseIf(!file, path, ": cannot be opened for reading");
  std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  return OffReader(path, std::move(text)).read();
}

} // namespace quadrille
