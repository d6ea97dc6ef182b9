// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Numbers of quads that blocks of composite data have of their own.
#pragma once

#include <string>
#include <vector>

class vtkFieldData;

namespace quadrille
{

namespace arrays
{
constexpr const char* kNumberOfQuads = "NumberOfQuads"; ///< field data, one whole number >= 1
}

struct BlockQuads
{
  std::string block; ///< its name, or its path
  double quads = 0;  ///< whole, >= 1
};

/// "Wheel = 300; Car/Door = 500", with ';' or new lines between the pairs, and spaces anywhere. Throws InvalidInput for
/// a pair that cannot be read, naming it, and for a name that comes twice.
std::vector<BlockQuads> readBlockQuads(const std::string& text);

/// Whether a block with this path, as blockName() gives it, is meant by a name: all of it, or what is behind its last
/// '/'.
bool isNamed(const std::string& path, const std::string& name);

/// Throws InvalidInput where a pair names no block of these, with the names that there are.
void checkBlockQuads(const std::vector<BlockQuads>& pairs, const std::vector<std::string>& blocks);

/// The number in the array NumberOfQuads; 0 where it is missing or there is no field data. Throws InvalidInput where it
/// is not one whole number of at least 1.
double quadsInFieldData(vtkFieldData* fieldData);

} // namespace quadrille
