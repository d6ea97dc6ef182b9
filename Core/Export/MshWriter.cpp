// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Export/MshWriter.h"

#include "Base/LargeArray.h"
#include "Base/Lists.h"
#include "Export/OutputFile.h"
#include "Export/SetNames.h"

#include <algorithm>

namespace quadrille
{

namespace
{

using Tag = std::uint64_t;

struct PhysicalGroup
{
  int dimension = 0;
  Tag tag = 0;
  std::string name;
};

/// Points of entities: the corners, and where closed curves begin, which are in no group.
struct MshPoint
{
  Index node = 0;
  bool isCorner = false;
};

class MshFile
{
public:
  MshFile(const ElementMesh& mesh, const MeshSets& sets, const std::string& path)
    : mesh_(mesh), sets_(sets), file_(path), names_(kGmshNames)
  {
    for (const CornerSet& corner : sets.corners)
    {
      points_.push_back({ corner.node, true });
    }
    for (const EdgeChain& chain : sets.chains)
    {
      startOf_.push_back(chain.closed ? points_.size() : chain.startCorner);
      endOf_.push_back(chain.closed ? points_.size() : chain.endCorner);
      if (chain.closed)
      {
        points_.push_back({ chain.nodes.front(), false });
      }
    }
    nameGroups();
    groupCurves();
  }

  void write(MshVersion version, const ProgressCallback& progress)
  {
    const bool is41 = version == MshVersion::V41;
    const std::string text = writingText(mesh_);
    report(progress, 0, text);
    file_ << "$MeshFormat\n" << (is41 ? "4.1" : "2.2") << " 0 8\n$EndMeshFormat\n";
    writeNames();
    if (is41)
    {
      writeEntities();
      report(progress, 0.1, text);
    }
    is41 ? writeNodesByEntity() : writeNodeList();
    report(progress, 0.5, text);
    is41 ? writeElementsByEntity() : writeElementList();
    file_.close();
    report(progress, 1, text);
  }

  std::vector<std::string> notices() const { return names_.notices(); }

private:
  static constexpr int kPoint = 15;

  int lineType() const { return mesh_.nodesPerElement == 4 ? 1 : 8; }
  int quadType() const
  {
    return mesh_.nodesPerElement == 4 ? 3 : mesh_.nodesPerElement == 8 ? 16 : 10;
  }

  template <class Set>
  void addGroups(int dimension, const std::vector<Set>& sets, Tag firstTag)
  {
    const std::vector<std::string> names = names_.uniqueOf(sets);
    for (std::size_t i = 0; i < names.size(); ++i)
    {
      groups_.push_back({ dimension, firstTag + i, names[i] });
    }
  }

  void nameGroups()
  {
    addGroups(0, sets_.corners, 1);
    addGroups(1, sets_.boundaries, 1);
    addGroups(1, sets_.curves, 1 + sets_.boundaries.size());
    addGroups(2, sets_.patches, 1);
  }

  void groupCurves()
  {
    groupsOf_.resize(sets_.chains.size());
    Tag group = 0;
    for (const auto* curves : { &sets_.boundaries, &sets_.curves })
    {
      for (const CurveSet& curve : *curves)
      {
        ++group;
        for (const Index chain : curve.chains)
        {
          groupsOf_[chain].push_back(group);
        }
      }
    }
  }

  void writeNames()
  {
    file_ << "$PhysicalNames\n" << groups_.size() << '\n';
    for (const PhysicalGroup& group : groups_)
    {
      file_ << group.dimension << ' ' << group.tag << " \"" << group.name << "\"\n";
    }
    file_ << "$EndPhysicalNames\n";
  }

  void writePlace(const Vector3& p) { file_ << p[0] << ' ' << p[1] << ' ' << p[2]; }

  void writeBox(const Eigen::AlignedBox3d& box)
  {
    writePlace(box.min());
    file_ << ' ';
    writePlace(box.max());
  }

  //----------------------------------------------------------------------------
  // 4.1

  void writeEntities()
  {
    file_ << "$Entities\n"
          << points_.size() << ' ' << sets_.chains.size() << ' ' << sets_.patches.size() << " 0\n";
    for (std::size_t i = 0; i < points_.size(); ++i)
    {
      file_ << i + 1 << ' ';
      writePlace(mesh_.nodes[points_[i].node]);
      file_ << (points_[i].isCorner ? " 1 " + std::to_string(i + 1) : " 0") << '\n';
    }
    for (std::size_t i = 0; i < sets_.chains.size(); ++i)
    {
      Eigen::AlignedBox3d box;
      for (const auto* nodes : { &sets_.chains[i].nodes, &sets_.chains[i].middles })
      {
        std::for_each(
          nodes->begin(), nodes->end(), [&](Index node) { box.extend(mesh_.nodes[node]); });
      }
      file_ << i + 1 << ' ';
      writeBox(box);
      file_ << ' ' << groupsOf_[i].size();
      for (const Tag group : groupsOf_[i])
      {
        file_ << ' ' << group;
      }
      file_ << " 2 " << startOf_[i] + 1 << " -" << endOf_[i] + 1 << '\n';
    }
    writeSurfaces();
    file_ << "$EndEntities\n";
  }

  void writeSurfaces()
  {
    std::vector<std::vector<Index>> curvesOf(sets_.patches.size());
    for (std::size_t i = 0; i < sets_.chains.size(); ++i)
    {
      for (const Index patch : sets_.chains[i].patches)
      {
        curvesOf[patch].push_back(static_cast<Index>(i));
      }
    }
    for (std::size_t i = 0; i < sets_.patches.size(); ++i)
    {
      Eigen::AlignedBox3d box;
      for (const Index e : sets_.patches[i].elements)
      {
        pollNowAndThen(e);
        for (int k = 0; k < mesh_.nodesPerElement; ++k)
        {
          box.extend(mesh_.nodes[mesh_.element(e)[k]]);
        }
      }
      file_ << i + 1 << ' ';
      writeBox(box);
      file_ << " 1 " << i + 1 << ' ' << curvesOf[i].size();
      for (const Index curve : curvesOf[i])
      {
        file_ << ' ' << curve + 1;
      }
      file_ << '\n';
    }
  }

  /// Entities in the order of dimensions and tags; nodes of a block ascend.
  struct NodeBlock
  {
    int dimension = 0;
    Tag tag = 0;
    std::vector<Index> nodes;
  };

  /// Each node is in the block of the entity of the lowest dimension that it lies on, of several surfaces the first.
  std::vector<NodeBlock> nodeBlocks() const
  {
    std::vector<std::uint8_t> isTaken;
    growLarge(isTaken, mesh_.nodes.size(), std::uint8_t{ 0 });
    std::vector<NodeBlock> blocks;
    const auto take = [&isTaken](NodeBlock& block, Index node)
    {
      if (!isTaken[node])
      {
        isTaken[node] = 1;
        block.nodes.push_back(node);
      }
    };
    for (std::size_t i = 0; i < points_.size(); ++i)
    {
      blocks.push_back({ 0, i + 1, {} });
      take(blocks.back(), points_[i].node);
    }
    for (std::size_t i = 0; i < sets_.chains.size(); ++i)
    {
      blocks.push_back({ 1, i + 1, {} });
      for (const auto* nodes : { &sets_.chains[i].nodes, &sets_.chains[i].middles })
      {
        std::for_each(nodes->begin(), nodes->end(), [&](Index node) { take(blocks.back(), node); });
      }
    }
    for (std::size_t i = 0; i < sets_.patches.size(); ++i)
    {
      blocks.push_back({ 2, i + 1, {} });
      for (const Index e : sets_.patches[i].elements)
      {
        pollNowAndThen(e);
        for (int k = 0; k < mesh_.nodesPerElement; ++k)
        {
          take(blocks.back(), mesh_.element(e)[k]);
        }
      }
    }
    for (std::size_t i = 0; i < isTaken.size() && !blocks.empty(); ++i)
    {
      take(blocks.back(), static_cast<Index>(i)); // nodes without an element
    }
    eraseIf(blocks, [](const NodeBlock& block) { return block.nodes.empty(); });
    return blocks;
  }

  void writeNodesByEntity()
  {
    std::vector<NodeBlock> blocks = nodeBlocks();
    const Tag count = mesh_.nodes.size();
    file_ << "$Nodes\n"
          << blocks.size() << ' ' << count << ' ' << (count > 0 ? 1 : 0) << ' ' << count << '\n';
    for (NodeBlock& block : blocks)
    {
      std::sort(block.nodes.begin(), block.nodes.end());
      file_ << block.dimension << ' ' << block.tag << " 0 " << block.nodes.size() << '\n';
      for (const Index node : block.nodes)
      {
        pollNowAndThen(node);
        file_ << node + 1 << '\n';
      }
      for (const Index node : block.nodes)
      {
        pollNowAndThen(node);
        writePlace(mesh_.nodes[node]);
        file_ << '\n';
      }
    }
    file_ << "$EndNodes\n";
  }

  void writeLineNodes(const EdgeChain& chain, std::size_t edge)
  {
    file_ << ' ' << chain.nodes[edge] + 1 << ' '
          << chain.nodes[(edge + 1) % chain.nodes.size()] + 1;
    if (!chain.middles.empty())
    {
      file_ << ' ' << chain.middles[edge] + 1;
    }
    file_ << '\n';
  }

  void writeQuadNodes(Index e)
  {
    for (int k = 0; k < mesh_.nodesPerElement; ++k)
    {
      file_ << ' ' << mesh_.element(e)[k] + 1;
    }
    file_ << '\n';
  }

  void writeElementsByEntity()
  {
    const Tag quads = mesh_.elementCount();
    const Tag count = quads + sets_.edgeCount() + sets_.corners.size();
    file_ << "$Elements\n"
          << sets_.corners.size() + sets_.chains.size() + sets_.patches.size() << ' ' << count
          << ' ' << (count > 0 ? 1 : 0) << ' ' << count << '\n';
    Tag next = quads; // quads have the first tags, though they come last
    for (std::size_t i = 0; i < sets_.corners.size(); ++i)
    {
      file_ << "0 " << i + 1 << ' ' << kPoint << " 1\n"
            << ++next << ' ' << sets_.corners[i].node + 1 << '\n';
    }
    for (std::size_t i = 0; i < sets_.chains.size(); ++i)
    {
      const EdgeChain& chain = sets_.chains[i];
      file_ << "1 " << i + 1 << ' ' << lineType() << ' ' << chain.sides.size() << '\n';
      for (std::size_t k = 0; k < chain.sides.size(); ++k)
      {
        file_ << ++next;
        writeLineNodes(chain, k);
      }
    }
    for (std::size_t i = 0; i < sets_.patches.size(); ++i)
    {
      file_ << "2 " << i + 1 << ' ' << quadType() << ' ' << sets_.patches[i].elements.size()
            << '\n';
      for (const Index e : sets_.patches[i].elements)
      {
        pollNowAndThen(e);
        file_ << e + 1;
        writeQuadNodes(e);
      }
    }
    file_ << "$EndElements\n";
  }

  //----------------------------------------------------------------------------
  // 2.2

  void writeNodeList()
  {
    file_ << "$Nodes\n" << mesh_.nodes.size() << '\n';
    for (std::size_t i = 0; i < mesh_.nodes.size(); ++i)
    {
      pollNowAndThen(i);
      file_ << i + 1 << ' ';
      writePlace(mesh_.nodes[i]);
      file_ << '\n';
    }
    file_ << "$EndNodes\n";
  }

  /// The number, the type, and two tags: the physical group and the entity.
  void beginElement(Tag number, int type, Tag group, Tag entity)
  {
    file_ << number << ' ' << type << " 2 " << group << ' ' << entity;
  }

  void writeElementList()
  {
    const Tag quads = mesh_.elementCount();
    Tag lines = 0;
    for (std::size_t i = 0; i < sets_.chains.size(); ++i)
    {
      lines += groupsOf_[i].size() * sets_.chains[i].sides.size();
    }
    file_ << "$Elements\n" << quads + lines + sets_.corners.size() << '\n';
    const std::vector<Index> setOf = patchSetOfElements(mesh_, sets_);
    for (std::size_t e = 0; e < mesh_.elementCount(); ++e)
    {
      pollNowAndThen(e);
      beginElement(e + 1, quadType(), setOf[e] + 1, setOf[e] + 1);
      writeQuadNodes(static_cast<Index>(e));
    }
    Tag next = quads;
    for (std::size_t i = 0; i < sets_.chains.size(); ++i)
    {
      for (const Tag group : groupsOf_[i]) // an element has one group here
      {
        for (std::size_t k = 0; k < sets_.chains[i].sides.size(); ++k)
        {
          beginElement(++next, lineType(), group, i + 1);
          writeLineNodes(sets_.chains[i], k);
        }
      }
    }
    for (std::size_t i = 0; i < sets_.corners.size(); ++i)
    {
      beginElement(++next, kPoint, i + 1, i + 1);
      file_ << ' ' << sets_.corners[i].node + 1 << '\n';
    }
    file_ << "$EndElements\n";
  }

  const ElementMesh& mesh_;
  const MeshSets& sets_;
  OutputFile file_;
  SetNames names_;
  std::vector<MshPoint> points_;
  std::vector<std::size_t> startOf_, endOf_; ///< per chain, in points_
  std::vector<PhysicalGroup> groups_;
  std::vector<std::vector<Tag>> groupsOf_; ///< per chain: the loop, the curve of a name, or both
};

} // namespace

std::vector<std::string> writeMsh(const ElementMesh& mesh, const MeshSets& sets,
  const std::string& path, MshVersion version, const ProgressCallback& progress)
{
  MshFile file(mesh, sets, path);
  file.write(version, progress);
  return file.notices();
}

} // namespace quadrille
