// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Session/SessionJson.h"

#include "Base/Refuse.h"
#include "Session/JsonReader.h"

#include <array>
#include <cstddef>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace quadrille
{
namespace
{

constexpr std::array<const char*, 5> kOperations{ "move", "split", "merge", "cancel", "add" };
constexpr std::array<const char*, 2> kPlaneCurves{ "isoline", "mid-line" };

SessionJson pointToJson(const Vector3& p)
{
  return { p.x(), p.y(), p.z() };
}

SessionJson pointsToJson(const std::vector<Vector3>& points)
{
  SessionJson json = SessionJson::array();
  for (const Vector3& p : points)
  {
    json.push_back(pointToJson(p));
  }
  return json;
}

/// Writes the members of each kind.
struct ContentWriter
{
  SessionJson& json;

  void operator()(const FeatureLine& line) const { json["points"] = pointsToJson(line.points); }
  void operator()(const GuideStroke& stroke) const
  {
    json["points"] = pointsToJson(stroke.points);
    json["weight"] = stroke.weight;
    json["radius"] = stroke.radius;
  }
  void operator()(const GuideRegion& region) const
  {
    json["polygons"] = region.polygons;
    json["direction"] = pointToJson(region.direction);
    json["weight"] = region.weight;
  }
  void operator()(const ValenceAt& at) const
  {
    json["point"] = pointToJson(at.point);
    json["valence"] = at.valence;
  }
  void operator()(const SizeAt& at) const
  {
    json["point"] = pointToJson(at.point);
    json["radius"] = at.radius;
    json["factor"] = at.factor;
  }
  void operator()(const SizeRegion& region) const
  {
    json["polygons"] = region.polygons;
    json["factor"] = region.factor;
  }
  void operator()(const IrregularEdit& edit) const
  {
    json["operation"] = kOperations[static_cast<std::size_t>(edit.operation)];
    json["points"] = pointsToJson(edit.points);
    json["valences"] = edit.valences;
  }
  void operator()(const Connection& connection) const
  {
    json["points"] = pointsToJson(connection.points);
  }
  void operator()(const Cycle& cycle) const { json["points"] = pointsToJson(cycle.points); }
  void operator()(const MirrorSymmetry& symmetry) const
  {
    if (symmetry.plane)
    {
      json["origin"] = pointToJson(symmetry.plane->origin);
      json["normal"] = pointToJson(symmetry.plane->normal);
    }
    // Files without it are read as before.
    if (symmetry.planeCurve != PlaneCurve::Isoline)
    {
      json["plane_curve"] = kPlaneCurves[static_cast<std::size_t>(symmetry.planeCurve)];
    }
  }
  void operator()(const RotationalSymmetry& rotation) const
  {
    json["order"] = rotation.order;
    if (rotation.axis)
    {
      json["origin"] = pointToJson(rotation.axis->origin);
      json["direction"] = pointToJson(rotation.axis->direction);
    }
  }
};

struct ContentReader
{
  ObjectReader& json;

  void operator()(FeatureLine& line) const { json.read("points", line.points); }
  void operator()(GuideStroke& stroke) const
  {
    json.read("points", stroke.points);
    json.readIf("weight", stroke.weight);
    json.readIf("radius", stroke.radius);
  }
  void operator()(GuideRegion& region) const
  {
    json.read("polygons", region.polygons);
    json.read("direction", region.direction);
    json.readIf("weight", region.weight);
  }
  void operator()(ValenceAt& at) const
  {
    json.read("point", at.point);
    json.read("valence", at.valence);
  }
  void operator()(SizeAt& at) const
  {
    json.read("point", at.point);
    json.readIf("radius", at.radius);
    json.read("factor", at.factor);
  }
  void operator()(SizeRegion& region) const
  {
    json.read("polygons", region.polygons);
    json.read("factor", region.factor);
  }
  void operator()(IrregularEdit& edit) const
  {
    edit.operation = static_cast<IrregularOperation>(json.readName("operation", kOperations));
    json.read("points", edit.points);
    json.readIf("valences", edit.valences);
  }
  void operator()(Connection& connection) const { json.read("points", connection.points); }
  void operator()(Cycle& cycle) const { json.read("points", cycle.points); }
  void operator()(MirrorSymmetry& symmetry) const
  {
    if (json.has("origin") || json.has("normal"))
    {
      symmetry.plane.emplace();
      json.read("origin", symmetry.plane->origin);
      json.read("normal", symmetry.plane->normal);
    }
    if (json.has("plane_curve"))
    {
      symmetry.planeCurve = static_cast<PlaneCurve>(json.readName("plane_curve", kPlaneCurves));
    }
  }
  void operator()(RotationalSymmetry& rotation) const
  {
    json.read("order", rotation.order);
    if (json.has("origin") || json.has("direction"))
    {
      rotation.axis.emplace();
      json.read("origin", rotation.axis->origin);
      json.read("direction", rotation.axis->direction);
    }
  }
};

/// An empty content of each kind, in the order of the variant.
template <std::size_t... kKinds>
std::vector<ConstraintContent> emptyContents(std::index_sequence<kKinds...>)
{
  return { ConstraintContent(std::in_place_index<kKinds>)... };
}

ConstraintContent emptyOfKind(const std::string& kind, const std::string& where)
{
  for (ConstraintContent& content :
    emptyContents(std::make_index_sequence<std::variant_size_v<ConstraintContent>>()))
  {
    if (kind == kindOf(content))
    {
      return content;
    }
  }
  refuse(where, " is of the kind \"", kind, "\", which this version does not know");
}

ConstraintContent readContent(ObjectReader& reader)
{
  std::string kind;
  reader.read("kind", kind);
  ConstraintContent content = emptyOfKind(kind, reader.where());
  std::visit(ContentReader{ reader }, content);
  return content;
}

SessionJson changesToJson(const std::vector<IrregularEdit::Change>& changes)
{
  SessionJson json = SessionJson::array();
  for (const IrregularEdit::Change& change : changes)
  {
    json.push_back({ { "place", pointToJson(change.place) }, { "before", change.before },
      { "after", change.after } });
  }
  return json;
}

/// What the session has made of an irregular operation.
SessionJson resolvedToJson(const IrregularEdit& edit)
{
  SessionJson before = SessionJson::array();
  for (const IrregularVertex& vertex : edit.before)
  {
    before.push_back({ { "place", pointToJson(vertex.place) }, { "valence", vertex.valence } });
  }
  SessionJson upon = SessionJson::array();
  for (const IrregularEdit::Link& link : edit.upon)
  {
    upon.push_back({ { "id", link.id }, { "revision", link.revision },
      { "changes", changesToJson(link.changes) } });
  }
  SessionJson onFeatures = SessionJson::array();
  for (const HeldVertex& vertex : edit.onFeatures)
  {
    SessionJson sectors = SessionJson::array();
    for (const HeldSector& sector : vertex.sectors)
    {
      sectors.push_back({ { "middle", pointToJson(sector.middle) }, { "turns", sector.turns } });
    }
    onFeatures.push_back({ { "point", vertex.point }, { "place", pointToJson(vertex.place) },
      { "sectors", sectors } });
  }
  return { { "before", before }, { "changes", changesToJson(edit.changes) }, { "upon", upon },
    { "on_features", onFeatures } };
}

template <class Read>
void readEach(const SessionJson& list, const std::string& where, const Read& read)
{
  if (!list.is_array())
  {
    refuse(where, " must be a list");
  }
  for (const SessionJson& json : list)
  {
    ObjectReader reader(json, where);
    read(reader);
    reader.finish();
  }
}

void readChanges(
  const SessionJson& json, const std::string& where, std::vector<IrregularEdit::Change>& changes)
{
  readEach(json, "\"changes\" of " + where,
    [&](ObjectReader& each)
    {
      IrregularEdit::Change change;
      each.read("place", change.place);
      each.read("before", change.before);
      each.read("after", change.after);
      changes.push_back(change);
    });
}

void readOnFeatures(
  const SessionJson& json, const std::string& where, std::vector<HeldVertex>& vertices)
{
  readEach(json, "\"on_features\" of " + where,
    [&](ObjectReader& each)
    {
      HeldVertex vertex;
      each.read("point", vertex.point);
      each.read("place", vertex.place);
      readEach(each.at("sectors"), "\"sectors\" of " + where,
        [&](ObjectReader& eachSector)
        {
          HeldSector sector;
          eachSector.read("middle", sector.middle);
          eachSector.read("turns", sector.turns);
          vertex.sectors.push_back(sector);
        });
      vertices.push_back(std::move(vertex));
    });
}

void readResolved(const SessionJson& json, const std::string& where, IrregularEdit& edit)
{
  ObjectReader reader(json, where);
  readEach(reader.at("before"), "\"before\" of " + where,
    [&](ObjectReader& each)
    {
      IrregularVertex vertex;
      each.read("place", vertex.place);
      each.read("valence", vertex.valence);
      edit.before.push_back(vertex);
    });
  readChanges(reader.at("changes"), where, edit.changes);
  readEach(reader.at("upon"), "\"upon\" of " + where,
    [&](ObjectReader& each)
    {
      IrregularEdit::Link link;
      each.read("id", link.id);
      each.read("revision", link.revision);
      readChanges(each.at("changes"), where, link.changes);
      edit.upon.push_back(link);
    });
  if (reader.has("on_features")) // files of version 1 may have none
  {
    readOnFeatures(reader.at("on_features"), where, edit.onFeatures);
  }
  reader.finish();
}

} // namespace

SessionJson contentToJson(const ConstraintContent& content)
{
  SessionJson json;
  json["kind"] = kindOf(content);
  std::visit(ContentWriter{ json }, content);
  return json;
}

ConstraintContent contentFromJson(const SessionJson& json, const std::string& where)
{
  ObjectReader reader(json, where);
  ConstraintContent content = readContent(reader);
  reader.finish();
  return content;
}

SessionJson constraintToJson(const SessionConstraint& constraint)
{
  SessionJson json;
  json["id"] = constraint.id;
  json["revision"] = constraint.revision;
  json.update(contentToJson(constraint.content));
  if (const auto* edit = std::get_if<IrregularEdit>(&constraint.content))
  {
    json["resolved"] = resolvedToJson(*edit);
  }
  return json;
}

SessionConstraint constraintFromJson(const SessionJson& json, const std::string& where)
{
  SessionConstraint constraint;
  {
    ObjectReader ids(json, where);
    ids.read("id", constraint.id);
  }
  ObjectReader reader(json, "constraint " + std::to_string(constraint.id) + " of " + where);
  reader.read("id", constraint.id);
  reader.read("revision", constraint.revision);
  constraint.content = readContent(reader);
  if (auto* edit = std::get_if<IrregularEdit>(&constraint.content))
  {
    readResolved(reader.at("resolved"), reader.where(), *edit);
  }
  reader.finish();
  return constraint;
}

SessionJson parseJson(const std::string& text, const std::string& where)
{
  try
  {
    return SessionJson::parse(text);
  }
  catch (const nlohmann::json::exception& error)
  {
    refuse(where, " is no JSON: ", error.what());
  }
}

} // namespace quadrille
