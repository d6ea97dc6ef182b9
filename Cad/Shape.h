// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The exact shape of a part: a boundary representation of Open CASCADE, behind a pointer, so that nobody who uses it
/// includes Open CASCADE.
#pragma once

#include "Base/Types.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace quadrille
{

/// Faces, edges and vertices have ids from 0 on, in the order in which the shape has them. A copy is the same shape.
class CadShape
{
public:
  struct Data; ///< see ShapeData.h

  CadShape() = default;
  explicit CadShape(std::shared_ptr<const Data> data) : data_(std::move(data)) {}

  /// What bytes() gave: the same ids, and the same geometry to the last bit. Throws InvalidInput where the bytes are
  /// none of a shape, or only part of them.
  static CadShape ofBytes(const std::vector<std::uint8_t>& bytes);
  std::vector<std::uint8_t> bytes() const;

  bool empty() const { return data_ == nullptr; }
  std::size_t solidCount() const;
  std::size_t faceCount() const;
  std::size_t edgeCount() const;
  std::size_t vertexCount() const;
  /// Of its bounding box, without the tolerances of the shape; in the unit of the shape.
  double diagonal() const;

  const std::shared_ptr<const Data>& data() const { return data_; }

private:
  std::shared_ptr<const Data> data_;
};

} // namespace quadrille
