// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Cad/PartBytes.h"

#include "Base/Refuse.h"

#include <cstring>
#include <type_traits>

namespace quadrille
{

namespace
{

/// Appends, or takes off, one thing after the other: the same list of things serves both.
class Writer
{
public:
  template <class Thing>
  void pass(const Thing& thing)
  {
    static_assert(std::is_trivially_copyable_v<Thing>);
    const auto* begin = reinterpret_cast<const std::uint8_t*>(&thing);
    bytes.insert(bytes.end(), begin, begin + sizeof(Thing));
  }
  void pass(const std::string& text) { pass(std::vector<char>(text.begin(), text.end())); }
  void pass(const Vector2& v) { pass(std::array<double, 2>{ v.x(), v.y() }); }
  void pass(const Vector3& v) { pass(std::array<double, 3>{ v.x(), v.y(), v.z() }); }
  void pass(const std::optional<std::array<double, 3>>& colour)
  {
    pass(colour.has_value());
    pass(colour.value_or(std::array<double, 3>{}));
  }
  void pass(const std::array<Vector2, 3>& corners)
  {
    for (const Vector2& corner : corners)
    {
      pass(corner);
    }
  }
  void pass(const CadShape& shape) { pass(shape.bytes()); }
  void pass(const CadEdge& edge);
  void pass(const CadSurface& surface);
  void pass(const CadPart& part);
  template <class Thing>
  void pass(const std::vector<Thing>& list)
  {
    pass(static_cast<std::uint64_t>(list.size()));
    for (const Thing& thing : list)
    {
      pass(thing);
    }
  }

  std::vector<std::uint8_t> bytes;
};

class Reader
{
public:
  explicit Reader(const std::vector<std::uint8_t>& bytes) : bytes_(bytes) {}

  template <class Thing>
  void pass(Thing& thing)
  {
    static_assert(std::is_trivially_copyable_v<Thing>);
    refuseIf(bytes_.size() - at_ < sizeof(Thing), "what was read of the CAD file is cut off");
    std::memcpy(&thing, bytes_.data() + at_, sizeof(Thing));
    at_ += sizeof(Thing);
  }
  void pass(std::string& text)
  {
    std::vector<char> characters;
    pass(characters);
    text.assign(characters.begin(), characters.end());
  }
  void pass(Vector2& v)
  {
    std::array<double, 2> numbers{};
    pass(numbers);
    v = { numbers[0], numbers[1] };
  }
  void pass(Vector3& v)
  {
    std::array<double, 3> numbers{};
    pass(numbers);
    v = { numbers[0], numbers[1], numbers[2] };
  }
  void pass(std::optional<std::array<double, 3>>& colour)
  {
    bool isThere = false;
    std::array<double, 3> numbers{};
    pass(isThere);
    pass(numbers);
    colour = isThere ? std::optional(numbers) : std::nullopt;
  }
  void pass(std::array<Vector2, 3>& corners)
  {
    for (Vector2& corner : corners)
    {
      pass(corner);
    }
  }
  void pass(CadShape& shape)
  {
    std::vector<std::uint8_t> bytes;
    pass(bytes);
    shape = CadShape::ofBytes(bytes);
  }
  void pass(CadEdge& edge);
  void pass(CadSurface& surface);
  void pass(CadPart& part);
  template <class Thing>
  void pass(std::vector<Thing>& list)
  {
    std::uint64_t count = 0;
    pass(count);
    refuseIf(count > bytes_.size(), "what was read of the CAD file is damaged");
    list.resize(count);
    for (Thing& thing : list)
    {
      pass(thing);
    }
  }

private:
  const std::vector<std::uint8_t>& bytes_;
  std::size_t at_ = 0;
};

template <class Pass, class Edge>
void passEdge(Pass& bytes, Edge& edge)
{
  bytes.pass(edge.kind);
  bytes.pass(edge.angle);
  bytes.pass(edge.points);
  bytes.pass(edge.parameters);
  bytes.pass(edge.curvatures);
}

template <class Pass, class Surface>
void passSurface(Pass& bytes, Surface& surface)
{
  bytes.pass(surface.points);
  bytes.pass(surface.triangles);
  bytes.pass(surface.faceOf);
  bytes.pass(surface.parameters);
  bytes.pass(surface.curvatures);
  bytes.pass(surface.edges);
  bytes.pass(surface.vertexPoints);
  bytes.pass(surface.surfaceKinds);
  bytes.pass(surface.chordError);
  bytes.pass(surface.notices);
}

template <class Pass, class Part>
void passPart(Pass& bytes, Part& part)
{
  bytes.pass(part.name);
  bytes.pass(part.shape);
  bytes.pass(part.surface);
  bytes.pass(part.faceNames);
  bytes.pass(part.edgeNames);
  bytes.pass(part.vertexNames);
  bytes.pass(part.faceColours);
}

void Writer::pass(const CadEdge& edge)
{
  passEdge(*this, edge);
}

void Writer::pass(const CadSurface& surface)
{
  passSurface(*this, surface);
}

void Writer::pass(const CadPart& part)
{
  passPart(*this, part);
}

void Reader::pass(CadEdge& edge)
{
  passEdge(*this, edge);
}

void Reader::pass(CadSurface& surface)
{
  passSurface(*this, surface);
}

void Reader::pass(CadPart& part)
{
  passPart(*this, part);
}

} // namespace

std::vector<std::uint8_t> bytesOf(const CadFile& file)
{
  Writer bytes;
  bytes.pass(file.parts);
  bytes.pass(file.unit);
  bytes.pass(file.notices);
  return std::move(bytes.bytes);
}

CadFile fileOf(const std::vector<std::uint8_t>& bytes)
{
  CadFile file;
  Reader reader(bytes);
  reader.pass(file.parts);
  reader.pass(file.unit);
  reader.pass(file.notices);
  return file;
}

} // namespace quadrille
