// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Blocks/Together.h"

#include "Base/PlaceText.h"
#include "Blocks/Blocks.h"
#include "Convert/Surfaces.h"

#include <vtkPolyData.h>

#include <algorithm>
#include <array>
#include <limits>
#include <sstream>

namespace quadrille
{

//------------------------------------------------------------------------------
std::vector<std::string> namesOfOthers(const std::vector<Block*>& blocks, std::size_t than)
{
  std::vector<std::string> names;
  for (std::size_t i = 0; i < blocks.size(); ++i)
  {
    if (i != than)
    {
      names.push_back(blocks[i]->name);
    }
  }
  return names;
}

//------------------------------------------------------------------------------
bool isFarFrom(std::size_t target, Block& block)
{
  constexpr double factor = 1.5;
  const auto quads = static_cast<double>(block.output(0)->GetNumberOfPolys());
  const auto wanted = static_cast<double>(target);
  return quads > factor * wanted || factor * quads < wanted;
}

//------------------------------------------------------------------------------
std::string togetherText(const std::vector<Block*>& blocks, const PartContacts& contacts)
{
  constexpr std::size_t told = 8;
  const std::vector<std::string> names = namesOfOthers(blocks, 0);
  std::ostringstream text;
  text << "conforming, made in one run with ";
  for (std::size_t i = 0; i < std::min(names.size(), told); ++i)
  {
    text << (i == 0 ? "'" : ", '") << names[i] << "'";
  }
  if (names.size() > told)
  {
    text << " and " << names.size() - told << " others";
  }
  text << ": they have " << contacts.edges << " edges in common";
  return text.str();
}

//------------------------------------------------------------------------------
//------------------------------------------------------------------------------
std::string withoutQuadsText(
  const std::vector<Block*>& blocks, const std::vector<std::size_t>& withoutQuads)
{
  const auto largest = *std::max_element(withoutQuads.begin(), withoutQuads.end(),
    [&blocks](std::size_t a, std::size_t b)
    { return areaOf(blocks[a]->input()) < areaOf(blocks[b]->input()); });
  std::array<double, 6> box{};
  blocks[largest]->input()->GetBounds(box.data());
  const Vector3 middle(0.5 * (box[0] + box[1]), 0.5 * (box[2] + box[3]), 0.5 * (box[4] + box[5]));
  std::ostringstream text;
  text << withoutQuads.size() << " of " << blocks.size() << " blocks "
       << (withoutQuads.size() == 1 ? "is" : "are")
       << " too small or too narrow for a quad and have none, the largest of them '"
       << blocks[largest]->name << "' near " << placeText(middle)
       << ": their place went to quads of blocks beside; ask for more quads, or join these blocks "
          "with others";
  return text.str();
}

//------------------------------------------------------------------------------
std::string sheetsText(const MetSheets& met)
{
  std::ostringstream text;
  text << met.segments << " curves are common to more than two sheets";
  if (met.strips > 0)
  {
    text << "; " << met.strips
         << (met.strips == 1 ? " strip of quads was" : " strips of quads were")
         << " put in so that all sheets have the same points there";
  }
  if (met.inverted > 0)
  {
    text << "; " << met.inverted << " quads are inverted: more quads often help";
  }
  return text.str();
}

//------------------------------------------------------------------------------
std::string touchingText(const JointSheets& sheets)
{
  std::ostringstream text;
  text
    << "sheets that go on beyond touch at " << sheets.touching << " edges, one of them near "
    << placeText(sheets.touchingPlace)
    << ", as solids do that have a curve in common and no face: there is no result with the same "
       "points in all of them there, so they are not made to meet at these edges; ask for more "
       "quads, or cut the blocks in two there";
  return text.str();
}

//------------------------------------------------------------------------------
std::vector<float> sizesOf(
  const JoinedParts& joined, const std::vector<float>& asked, const std::vector<double>& factors)
{
  std::vector<float> sizes(joined.input.points.size(), std::numeric_limits<float>::max());
  for (std::size_t p = 0; p < joined.parts.size(); ++p)
  {
    for (const auto& [joint, own] : joined.parts[p].points)
    {
      const float size = asked.empty() ? 1.0F : asked[joint];
      sizes[joint] = std::min(sizes[joint], size * static_cast<float>(factors[p]));
    }
  }
  return sizes;
}

} // namespace quadrille
