// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Blocks/BlockQuads.h"

#include "Base/Lists.h"
#include "Base/Refuse.h"

#include <vtkDataArray.h>
#include <vtkFieldData.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace quadrille
{

namespace
{

/// Above it a double does not hold every whole number.
constexpr double kMostQuadsOfBlock = 1e15;

std::string trimmed(const std::string& text)
{
  constexpr const char* blanks = " \t\r";
  const std::size_t begin = text.find_first_not_of(blanks);
  return begin == std::string::npos ? ""
                                    : text.substr(begin, text.find_last_not_of(blanks) - begin + 1);
}

bool isNumberOfQuads(double value)
{
  return value >= 1 && value <= kMostQuadsOfBlock && std::floor(value) == value;
}

BlockQuads readPair(const std::string& text)
{
  const std::size_t equals = text.rfind('='); // a name may have one, too
  BlockQuads pair;
  std::string rest;
  if (equals != std::string::npos)
  {
    pair.block = trimmed(text.substr(0, equals));
    std::istringstream number(text.substr(equals + 1));
    number >> pair.quads >> rest;
  }
  if (pair.block.empty() || !rest.empty() || !isNumberOfQuads(pair.quads))
  {
    refuse("'", text,
      "' in the quads of blocks is no pair of a name and a whole number of at least 1, as in "
      "'Wheel = 300'");
  }
  return pair;
}

} // namespace

std::vector<BlockQuads> readBlockQuads(const std::string& text)
{
  std::vector<BlockQuads> pairs;
  std::string lines = text;
  std::replace(lines.begin(), lines.end(), ';', '\n');
  std::istringstream stream(lines);
  for (std::string line; std::getline(stream, line);)
  {
    line = trimmed(line);
    if (line.empty())
    {
      continue;
    }
    pairs.push_back(readPair(line));
    const auto isSame = [&](const BlockQuads& pair) { return pair.block == pairs.back().block; };
    if (std::any_of(pairs.begin(), pairs.end() - 1, isSame))
    {
      refuse("the quads of blocks name '", pairs.back().block, "' twice");
    }
  }
  return pairs;
}

bool isNamed(const std::string& path, const std::string& name)
{
  return path == name || path.substr(path.rfind('/') + 1) == name;
}

void checkBlockQuads(const std::vector<BlockQuads>& pairs, const std::vector<std::string>& blocks)
{
  for (const BlockQuads& pair : pairs)
  {
    if (std::any_of(blocks.begin(), blocks.end(),
          [&](const std::string& block) { return isNamed(block, pair.block); }))
    {
      continue;
    }
    refuse("the quads of blocks name '", pair.block, "', but there is no such block; there are ",
      joined(blocks, kMostTold, [](const std::string& block) { return "'" + block + "'"; }));
  }
}

double quadsInFieldData(vtkFieldData* fieldData)
{
  vtkAbstractArray* array =
    fieldData ? fieldData->GetAbstractArray(arrays::kNumberOfQuads) : nullptr;
  if (!array)
  {
    return 0;
  }
  auto* numbers = vtkDataArray::SafeDownCast(array);
  if (!numbers || numbers->GetNumberOfValues() != 1 ||
    !isNumberOfQuads(numbers->GetComponent(0, 0)))
  {
    refuse("the field data array '", arrays::kNumberOfQuads,
      "' must hold one whole number of at least 1, the quads of its block");
  }
  return numbers->GetComponent(0, 0);
}

} // namespace quadrille
