// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Cad/Shape.h"

#include "Base/Refuse.h"
#include "Cad/Guarded.h"
#include "Cad/ShapeData.h"

#include <BRepBndLib.hxx>
#include <BinTools.hxx>
#include <Bnd_Box.hxx>
#include <TopAbs_ShapeEnum.hxx>
#include <TopExp.hxx>
#include <TopLoc_Location.hxx>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <sstream>

namespace quadrille
{

CadShape::Data::Data(const TopoDS_Shape& all) : shape(all)
{
  TopExp::MapShapes(shape, TopAbs_FACE, faces);
  TopExp::MapShapes(shape, TopAbs_EDGE, edges);
  TopExp::MapShapes(shape, TopAbs_VERTEX, vertices);
  TopTools_IndexedMapOfShape ofSolids;
  TopExp::MapShapes(shape, TopAbs_SOLID, ofSolids);
  solids = static_cast<std::size_t>(ofSolids.Extent());
  Bnd_Box box;
  // Without the place of an instance, so that all instances have the same triangles.
  BRepBndLib::Add(shape.Located(TopLoc_Location()), box, Standard_False);
  diagonal = box.IsVoid() ? 0 : std::sqrt(box.SquareExtent());
}

namespace
{

constexpr std::size_t kHeader = 16; // a word, and a sum over what follows
constexpr std::array<char, 8> kWord{ 'C', 'A', 'D', 'S', 'H', 'A', 'P', '1' };

/// FNV-1a. Open CASCADE does not check what it reads, and may end the process on bytes that are damaged.
std::uint64_t checkSum(const std::uint8_t* begin, const std::uint8_t* end)
{
  std::uint64_t sum = 14695981039346656037ULL;
  for (const std::uint8_t* byte = begin; byte != end; ++byte)
  {
    sum = (sum ^ *byte) * 1099511628211ULL;
  }
  return sum;
}

bool isWhole(const std::vector<std::uint8_t>& bytes)
{
  if (bytes.size() <= kHeader || std::memcmp(bytes.data(), kWord.data(), kWord.size()) != 0)
  {
    return false;
  }
  const std::uint8_t* begin = bytes.data() + kHeader;
  const std::uint64_t sum = checkSum(begin, bytes.data() + bytes.size());
  return std::memcmp(bytes.data() + kWord.size(), &sum, sizeof(sum)) == 0;
}

} // namespace

CadShape CadShape::ofBytes(const std::vector<std::uint8_t>& bytes)
{
  const std::string what = "the exact shape in the data";
  refuseIf(!isWhole(bytes), what, " is damaged or of another version: read the CAD file anew");
  std::shared_ptr<const Data> data;
  guarded(what,
    [&]
    {
      std::istringstream stream(
        std::string(reinterpret_cast<const char*>(bytes.data()) + kHeader, bytes.size() - kHeader));
      TopoDS_Shape shape;
      BinTools::Read(shape, stream);
      refuseIf(shape.IsNull(), what, " is of another version: read the CAD file anew");
      data = std::make_shared<const Data>(shape);
    });
  return CadShape(data);
}

std::vector<std::uint8_t> CadShape::bytes() const
{
  refuseIf(empty(), "there is no shape to be written");
  std::ostringstream stream;
  guarded("the exact shape",
    [&]
    {
      BinTools::Write(
        data_->shape, stream, Standard_False, Standard_False, BinTools_FormatVersion_CURRENT);
    });
  const std::string text = stream.str();
  std::vector<std::uint8_t> bytes(kHeader + text.size());
  std::copy(text.begin(), text.end(), bytes.begin() + kHeader);
  const std::uint64_t sum = checkSum(bytes.data() + kHeader, bytes.data() + bytes.size());
  std::memcpy(bytes.data(), kWord.data(), kWord.size());
  std::memcpy(bytes.data() + kWord.size(), &sum, sizeof(sum));
  return bytes;
}

std::size_t CadShape::solidCount() const
{
  return data_ ? data_->solids : 0;
}

std::size_t CadShape::faceCount() const
{
  return data_ ? static_cast<std::size_t>(data_->faces.Extent()) : 0;
}

std::size_t CadShape::edgeCount() const
{
  return data_ ? static_cast<std::size_t>(data_->edges.Extent()) : 0;
}

std::size_t CadShape::vertexCount() const
{
  return data_ ? static_cast<std::size_t>(data_->vertices.Extent()) : 0;
}

double CadShape::diagonal() const
{
  return data_ ? data_->diagonal : 0;
}

} // namespace quadrille
