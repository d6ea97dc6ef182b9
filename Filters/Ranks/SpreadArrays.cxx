// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Ranks/SpreadArrays.h"

#include "Common/NewArray.h"
#include "Convert/Pieces.h"
#include "Ranks/Packing.h"

#include <vtkCellArray.h>
#include <vtkCellArrayIterator.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDataSetAttributes.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>

#include <algorithm>
#include <array>
#include <set>
#include <tuple>

namespace quadrille
{

namespace
{

std::string arrayName(vtkAbstractArray* array)
{
  return array->GetName() ? array->GetName() : "";
}

/// An array that some pieces have.
struct AgreedArray
{
  vtkSmartPointer<vtkAbstractArray> model; ///< without tuples
  std::size_t pieces = 0;                  ///< that have it
  bool differs = false;
  bool cannotBeSent = false;
};

struct AgreedAttributes
{
  std::vector<AgreedArray> arrays; ///< in the order in which they were met
  std::array<std::string, vtkDataSetAttributes::NUM_ATTRIBUTES> active;
  std::array<std::size_t, vtkDataSetAttributes::NUM_ATTRIBUTES> activeOn{}; ///< pieces

  AgreedArray* find(const std::string& name)
  {
    const auto found = std::find_if(arrays.begin(), arrays.end(),
      [&name](const AgreedArray& array) { return arrayName(array.model) == name; });
    return found == arrays.end() ? nullptr : &*found;
  }
};

/// Copies without tuples; the ghost array stays behind.
void packModels(vtkDataSetAttributes* attributes, Packer& packer)
{
  vtkNew<vtkFieldData> models;
  std::vector<std::string> notSent;
  for (int i = 0; i < attributes->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* array = attributes->GetAbstractArray(i);
    const std::string name = arrayName(array);
    if (name == vtkDataSetAttributes::GhostArrayName() || name == kVolumeFace)
    {
      continue;
    }
    if (name.empty() || !canBePacked(array))
    {
      notSent.push_back(name);
      continue;
    }
    auto model = vtk::TakeSmartPointer(vtkAbstractArray::CreateArray(array->GetDataType()));
    model->SetName(name.c_str());
    model->SetNumberOfComponents(array->GetNumberOfComponents());
    model->CopyComponentNames(array);
    models->AddArray(model);
  }
  packArrays(models, packer);
  packer.count(notSent.size());
  for (const std::string& name : notSent)
  {
    packer.text(name);
  }
  for (int type = 0; type < vtkDataSetAttributes::NUM_ATTRIBUTES; ++type)
  {
    vtkAbstractArray* active = attributes->GetAbstractAttribute(type);
    packer.text(active ? arrayName(active) : "");
  }
}

void takeModels(Unpacker& unpacker, AgreedAttributes& agreed, std::set<std::string>& notSent)
{
  vtkNew<vtkFieldData> models;
  unpackArrays(unpacker, models);
  for (int i = 0; i < models->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* model = models->GetAbstractArray(i);
    AgreedArray* array = agreed.find(arrayName(model));
    if (!array)
    {
      array = &agreed.arrays.emplace_back();
      array->model = model;
    }
    ++array->pieces;
    array->differs = array->differs || model->GetDataType() != array->model->GetDataType() ||
      model->GetNumberOfComponents() != array->model->GetNumberOfComponents();
  }
  const std::uint64_t lost = unpacker.count();
  for (std::uint64_t i = 0; i < lost; ++i)
  {
    notSent.insert(unpacker.text());
  }
  for (std::size_t type = 0; type < agreed.active.size(); ++type)
  {
    const std::string name = unpacker.text();
    agreed.activeOn[type] += name.empty() ? 0 : 1;
    agreed.active[type] = agreed.active[type].empty() ? name : agreed.active[type];
  }
}

bool isFactor(const std::string& name)
{
  return name == arrays::kSizing || name == arrays::kGuidingWeight;
}

void tell(const AgreedAttributes& agreed, const std::set<std::string>& notSent, std::size_t pieces,
  std::vector<std::string>& notices)
{
  for (const std::string& name : notSent)
  {
    notices.push_back(name.empty()
        ? "arrays without a name are left behind, as those of several ranks cannot be told apart"
        : "array '" + name + "' cannot be sent between ranks and is left behind");
  }
  for (const AgreedArray& array : agreed.arrays)
  {
    const std::string name = arrayName(array.model);
    if (array.differs)
    {
      notices.push_back("array '" + name + "' differs between pieces and is left behind");
    }
    else if (array.pieces < pieces)
    {
      notices.push_back("array '" + name + "' is missing on some pieces; " +
        (isFactor(name) ? "1" : "0 or nothing") + " stands for it there");
    }
  }
}

/// The arrays of `from` in the order that was agreed on.
void takeArrays(const AgreedAttributes& agreed, vtkDataSetAttributes* from, vtkIdType tuples,
  std::size_t pieces, vtkDataSetAttributes* to)
{
  for (const AgreedArray& array : agreed.arrays)
  {
    if (array.differs)
    {
      continue;
    }
    const std::string name = arrayName(array.model);
    vtkSmartPointer<vtkAbstractArray> mine = from ? from->GetAbstractArray(name.c_str()) : nullptr;
    if (!mine || mine->GetNumberOfTuples() < tuples)
    {
      mine = vtk::TakeSmartPointer(array.model->NewInstance());
      mine->SetName(name.c_str());
      mine->SetNumberOfComponents(array.model->GetNumberOfComponents());
      mine->CopyComponentNames(array.model);
      mine->SetNumberOfTuples(tuples);
      if (auto* numbers = vtkDataArray::SafeDownCast(mine))
      {
        numbers->Fill(isFactor(name) ? 1 : 0);
      }
    }
    to->AddArray(mine);
  }
  for (int type = 0; type < vtkDataSetAttributes::NUM_ATTRIBUTES; ++type)
  {
    const std::string& name = agreed.active[static_cast<std::size_t>(type)];
    // Ids of some pieces only say nothing of the points that two of them have.
    const bool isOnAll = type != vtkDataSetAttributes::GLOBALIDS ||
      agreed.activeOn[static_cast<std::size_t>(type)] == pieces;
    if (!name.empty() && isOnAll && to->HasArray(name.c_str()))
    {
      to->SetActiveAttribute(name.c_str(), type);
    }
  }
}

} // namespace

vtkSmartPointer<vtkPolyData> agreeOnArrays(
  const Ranks& ranks, std::vector<SpreadPiece>& pieces, std::vector<std::string>& notices)
{
  Packer packer;
  packer.count(pieces.size());
  for (const SpreadPiece& piece : pieces)
  {
    packModels(piece.data->GetPointData(), packer);
    packModels(piece.data->GetCellData(), packer);
  }
  AgreedAttributes ofPoints, ofCells;
  std::set<std::string> notSent;
  std::size_t all = 0;
  for (const std::string& bytes : ranks.gather(packer.bytes()))
  {
    Unpacker unpacker(bytes);
    const std::uint64_t count = unpacker.count();
    for (std::uint64_t p = 0; p < count; ++p)
    {
      takeModels(unpacker, ofPoints, notSent);
      takeModels(unpacker, ofCells, notSent);
    }
    all += count;
  }
  tell(ofPoints, notSent, all, notices);
  tell(ofCells, {}, all, notices);
  for (SpreadPiece& piece : pieces)
  {
    auto data = vtkSmartPointer<vtkPolyData>::New();
    data->CopyStructure(piece.data);
    data->GetFieldData()->PassData(piece.data->GetFieldData());
    takeArrays(
      ofPoints, piece.data->GetPointData(), data->GetNumberOfPoints(), all, data->GetPointData());
    takeArrays(
      ofCells, piece.data->GetCellData(), data->GetNumberOfCells(), all, data->GetCellData());
    piece.data = data;
  }
  auto model = vtkSmartPointer<vtkPolyData>::New();
  takeArrays(ofPoints, nullptr, 0, all, model->GetPointData());
  takeArrays(ofCells, nullptr, 0, all, model->GetCellData());
  return model;
}

namespace
{

/// received: of each rank, lists of numbers, one for each of its pieces. Returns for each rank lists of the same sizes:
/// 1 where another list has the number, too.
std::vector<std::string> sharedOf(const std::vector<std::string>& received)
{
  struct Use
  {
    std::uint64_t number;
    std::uint32_t list;
    std::uint32_t place;
  };
  std::vector<Use> uses;
  std::vector<std::vector<std::uint8_t>> isShared; // of each list
  std::vector<std::size_t> listsOfRank;
  for (const std::string& bytes : received)
  {
    Unpacker unpacker(bytes);
    const std::size_t first = isShared.size();
    while (!unpacker.isAtEnd())
    {
      const auto numbers = unpacker.values<std::uint64_t>();
      const auto list = static_cast<std::uint32_t>(isShared.size());
      for (std::size_t i = 0; i < numbers.size(); ++i)
      {
        uses.push_back({ numbers[i], list, static_cast<std::uint32_t>(i) });
      }
      isShared.emplace_back(numbers.size(), 0);
    }
    listsOfRank.push_back(isShared.size() - first);
  }
  std::sort(uses.begin(), uses.end(),
    [](const Use& a, const Use& b)
    { return std::tie(a.number, a.list) < std::tie(b.number, b.list); });
  for (std::size_t begin = 0, end = 0; begin < uses.size(); begin = end)
  {
    while (end < uses.size() && uses[end].number == uses[begin].number)
    {
      ++end;
    }
    const bool several = uses[end - 1].list != uses[begin].list;
    for (std::size_t i = begin; several && i < end; ++i)
    {
      isShared[uses[i].list][uses[i].place] = 1;
    }
  }
  std::vector<std::string> answers;
  std::size_t list = 0;
  for (const std::size_t lists : listsOfRank)
  {
    Packer packer;
    for (std::size_t i = 0; i < lists; ++i)
    {
      packer.values(isShared[list++]);
    }
    answers.push_back(packer.take());
  }
  return answers;
}

std::uint64_t mixed(std::uint64_t x)
{
  x += 0x9e3779b97f4a7c15U;
  x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9U;
  x = (x ^ (x >> 27U)) * 0x94d049bb133111ebU;
  return x ^ (x >> 31U);
}

} // namespace

std::int64_t pointNumber(const SpreadPiece& piece, vtkIdType point, bool byIds, double unit)
{
  if (byIds)
  {
    return static_cast<std::int64_t>(
      piece.data->GetPointData()->GetGlobalIds()->GetComponent(point, 0));
  }
  std::uint64_t hash = 0;
  for (const std::uint64_t bits : placeKey(piece.data, point, unit))
  {
    hash = mixed(hash ^ bits);
  }
  return static_cast<std::int64_t>(hash);
}

std::vector<std::vector<std::uint8_t>> findShared(
  const Ranks& ranks, const std::vector<std::vector<std::uint64_t>>& numbers)
{
  const auto count = static_cast<std::size_t>(ranks.size());
  const auto rankOf = [count](std::uint64_t number) { return mixed(number) % count; };
  std::vector<std::string> messages(count);
  ranks.together("finding what pieces share",
    [&]
    {
      std::vector<Packer> packers(count);
      for (const std::vector<std::uint64_t>& ofPiece : numbers)
      {
        std::vector<std::vector<std::uint64_t>> ofRank(count);
        for (const std::uint64_t number : ofPiece)
        {
          ofRank[rankOf(number)].push_back(number);
        }
        for (std::size_t r = 0; r < count; ++r)
        {
          packers[r].values(ofRank[r]);
        }
      }
      std::transform(packers.begin(), packers.end(), messages.begin(),
        [](Packer& packer) { return packer.take(); });
    });
  messages = ranks.exchange(std::move(messages));
  ranks.together("finding what pieces share", [&] { messages = sharedOf(messages); });
  messages = ranks.exchange(std::move(messages));
  std::vector<std::vector<std::uint8_t>> isShared(numbers.size());
  ranks.together("finding what pieces share",
    [&]
    {
      std::vector<Unpacker> unpackers(messages.begin(), messages.end());
      for (std::size_t p = 0; p < numbers.size(); ++p)
      {
        std::vector<std::vector<std::uint8_t>> ofRank;
        for (Unpacker& unpacker : unpackers)
        {
          ofRank.push_back(unpacker.values<std::uint8_t>());
        }
        std::vector<std::size_t> next(count, 0);
        for (const std::uint64_t number : numbers[p])
        {
          const std::size_t r = rankOf(number);
          isShared[p].push_back(ofRank[r][next[r]++]);
        }
      }
    });
  return isShared;
}

namespace
{

/// A polygon at an edge.
struct PatchEdge
{
  std::array<Index, 2> ends; ///< ascending
  std::int64_t patch = 0;
};

PatchEdge patchEdge(Index a, Index b, std::int64_t patch)
{
  return { { std::min(a, b), std::max(a, b) }, patch };
}

bool hasLowerEnds(const PatchEdge& a, const PatchEdge& b)
{
  return a.ends < b.ends;
}

/// Of edges between points that are kept, ascending by their ends, those of one polygon only.
std::vector<PatchEdge> borderOf(const SpreadPiece& piece, vtkDataArray* patches)
{
  std::vector<PatchEdge> uses;
  const auto isKept = [&piece](vtkIdType point)
  { return std::binary_search(piece.kept.begin(), piece.kept.end(), static_cast<Index>(point)); };
  const vtkIdType first = piece.data->GetNumberOfVerts() + piece.data->GetNumberOfLines();
  auto cells = vtk::TakeSmartPointer(piece.data->GetPolys()->NewIterator());
  for (cells->GoToFirstCell(); !cells->IsDoneWithTraversal(); cells->GoToNextCell())
  {
    vtkIdType count = 0;
    const vtkIdType* ids = nullptr;
    cells->GetCurrentCell(count, ids);
    for (vtkIdType i = 0; i < count; ++i)
    {
      const vtkIdType next = ids[(i + 1) % count];
      if (isKept(ids[i]) && isKept(next))
      {
        uses.push_back(patchEdge(static_cast<Index>(ids[i]), static_cast<Index>(next),
          static_cast<std::int64_t>(patches->GetComponent(first + cells->GetCurrentCellId(), 0))));
      }
    }
  }
  std::sort(uses.begin(), uses.end(), hasLowerEnds);
  std::vector<PatchEdge> border;
  for (std::size_t i = 0; i < uses.size(); ++i)
  {
    const bool isAlone = (i == 0 || uses[i].ends != uses[i - 1].ends) &&
      (i + 1 == uses.size() || uses[i].ends != uses[i + 1].ends);
    if (isAlone)
    {
      border.push_back(uses[i]);
    }
  }
  return border;
}

} // namespace

std::vector<BorderPatch> borderPatches(const SpreadPiece& piece)
{
  vtkDataArray* patches = piece.converted.patchArray.empty()
    ? nullptr
    : piece.data->GetCellData()->GetArray(piece.converted.patchArray.c_str());
  std::vector<BorderPatch> found;
  if (!patches || piece.kept.empty())
  {
    return found;
  }
  const std::vector<PatchEdge> border = borderOf(piece, patches);
  const PieceLevel& level = piece.piece->level();
  for (std::size_t f = 0; f < level.triangles.size(); ++f)
  {
    for (std::size_t i = 0; i < 3; ++i)
    {
      const PatchEdge wanted = patchEdge(level.inputPoint[level.triangles[f][i]],
        level.inputPoint[level.triangles[f][(i + 1) % 3]], 0);
      const auto at = std::lower_bound(border.begin(), border.end(), wanted, hasLowerEnds);
      if (at != border.end() && at->ends == wanted.ends)
      {
        found.push_back({ static_cast<Index>(f), static_cast<Index>(i), at->patch });
      }
    }
  }
  return found;
}

void markPatchBorders(const std::vector<std::vector<BorderPatch>>& patches, JoinedPieces& joined)
{
  struct Use : PatchEdge
  {
    Index triangle = 0;
    Index corner = 0;
  };
  std::vector<Use> uses;
  SurfaceInput& surface = joined.surface;
  for (std::size_t p = 0; p < patches.size(); ++p)
  {
    for (const BorderPatch& edge : patches[p])
    {
      const Index triangle = joined.firstTriangle[p] + edge.triangle;
      const Index* corners = surface.polygonPoints.data() + 3 * std::size_t{ triangle };
      uses.push_back({ patchEdge(corners[edge.corner], corners[(edge.corner + 1) % 3], edge.patch),
        triangle, edge.corner });
    }
  }
  std::sort(uses.begin(), uses.end(),
    [](const Use& a, const Use& b)
    { return std::tie(a.ends, a.triangle, a.corner) < std::tie(b.ends, b.triangle, b.corner); });
  for (std::size_t i = 1; i < uses.size(); ++i)
  {
    if (uses[i].ends != uses[i - 1].ends || uses[i].patch == uses[i - 1].patch)
    {
      continue;
    }
    surface.featureEdges.resize(surface.polygonOffsets.size() - 1, 0);
    for (const Use* use : { &uses[i - 1], &uses[i] })
    {
      std::uint8_t& bits = surface.featureEdges[use->triangle];
      bits = static_cast<std::uint8_t>(bits | 1U << use->corner);
    }
  }
}

} // namespace quadrille
