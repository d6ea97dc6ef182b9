// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "OffReader.h"

#include "MeshFiles.h"

#include <vtkCellArray.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>

#include <charconv>
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
bool parse(std::string_view word, Number& value)
{
  if (!word.empty() && word.front() == '+')
  {
    word.remove_prefix(1);
  }
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return !word.empty() && error == std::errc() && end == word.data() + word.size();
}

class Reader
{
public:
  Reader(const std::string& path, std::string text) : path_(path), lines_(std::move(text)) {}

  vtkSmartPointer<vtkPolyData> read()
  {
    readHeader();
    auto data = vtkSmartPointer<vtkPolyData>::New();
    data->SetPoints(readPoints());
    data->SetPolys(readFaces());
    return data;
  }

private:
  [[noreturn]] void fail(const std::string& reason) const
  {
    throw FileError(path_ + ": " + reason);
  }

  /// "[ST][C][N]OFF" and then three counts, on the same line or the next one.
  void readHeader()
  {
    std::string_view line;
    if (!lines_.next(line))
    {
      fail("is empty");
    }
    const std::string_view magic = nextWord(line);
    if (magic.size() < 3 || magic.substr(magic.size() - 3) != "OFF" ||
      magic.find_first_of("4n") != std::string_view::npos)
    {
      fail("does not begin with OFF, or is of a kind other than three-dimensional");
    }
    std::string_view rest = line;
    if (nextWord(rest) == "BINARY")
    {
      fail("is a binary OFF file; only the text form is read");
    }
    rest = line;
    if (nextWord(rest).empty() && !lines_.next(line))
    {
      fail("has no counts");
    }
    if (!parse(nextWord(line), pointCount_) || !parse(nextWord(line), faceCount_) ||
      pointCount_ < 0 || faceCount_ < 0)
    {
      fail("has no valid counts of vertices and faces");
    }
  }

  vtkSmartPointer<vtkPoints> readPoints()
  {
    auto points = vtkSmartPointer<vtkPoints>::New();
    points->SetDataTypeToDouble();
    std::string_view line;
    for (long long i = 0; i < pointCount_; ++i)
    {
      double p[3];
      if (!lines_.next(line) || !parse(nextWord(line), p[0]) || !parse(nextWord(line), p[1]) ||
        !parse(nextWord(line), p[2]))
      {
        fail("vertex " + std::to_string(i) + " is missing or has no three numbers");
      }
      points->InsertNextPoint(p);
    }
    return points;
  }

  vtkSmartPointer<vtkCellArray> readFaces()
  {
    auto faces = vtkSmartPointer<vtkCellArray>::New();
    std::vector<vtkIdType> corners;
    std::string_view line;
    for (long long f = 0; f < faceCount_; ++f)
    {
      long long count = 0;
      if (!lines_.next(line) || !parse(nextWord(line), count) || count < 0)
      {
        fail("face " + std::to_string(f) + " is missing or has no number of corners");
      }
      corners.clear();
      for (long long i = 0; i < count; ++i)
      {
        long long id = 0;
        if (!parse(nextWord(line), id) || id < 0 || id >= pointCount_)
        {
          fail("face " + std::to_string(f) + " has a corner that is missing or no vertex");
        }
        corners.push_back(static_cast<vtkIdType>(id));
      }
      faces->InsertNextCell(static_cast<vtkIdType>(corners.size()), corners.data());
    }
    return faces;
  }

  std::string path_;
  Lines lines_;
  long long pointCount_ = 0;
  long long faceCount_ = 0;
};

} // namespace

vtkSmartPointer<vtkPolyData> readOff(const std::string& path)
{
  std::ifstream file(path, std::ios::binary);
  if (!file)
  {
    throw FileError(path + ": cannot be opened for reading");
  }
  std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  return Reader(path, std::move(text)).read();
}

} // namespace quadrille
