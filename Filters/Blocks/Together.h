// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Blocks that are made together: what is told of them, and the sizes of their quads.
#pragma once

#include "Assembly/JoinParts.h"
#include "Assembly/JointSheets.h"
#include "Assembly/SheetJoints.h"
#include "Mesh/Surface.h"

#include <cstddef>
#include <string>
#include <vector>

namespace quadrille
{

struct Block;

std::vector<std::string> namesOfOthers(const std::vector<Block*>& blocks, std::size_t than);

/// Whether a block has far more or fewer quads than were asked for.
bool isFarFrom(std::size_t target, Block& block);

/// Of conforming blocks, at the first one.
std::string togetherText(const std::vector<Block*>& blocks, const PartContacts& contacts);

/// Blocks that are narrower than a quad, where no quads follow their borders.
std::string withoutQuadsText(
  const std::vector<Block*>& blocks, const std::vector<std::size_t>& withoutQuads);

/// Of sheets that met at common curves.
std::string sheetsText(const MetSheets& met);

/// Of sheets that touch and were left so.
std::string touchingText(const JointSheets& sheets);

/// Of the joint surface, with a factor a part; the smaller one counts where parts meet. asked: those of the points
/// without it, or empty.
std::vector<float> sizesOf(
  const JoinedParts& joined, const std::vector<float>& asked, const std::vector<double>& factors);

} // namespace quadrille
