// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Session/SessionJson.h"

#include "Base/Refuse.h"
#include "Session/JsonFields.h"

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

/// The fields of each kind.
template <typename Fields>
struct ContentFields
{
  Fields& json;

  template <typename Line>
  void points(Line& line) const
  {
    json.need("points", line.points);
  }

  void operator()(FeatureLine& line) const { points(line); }
  void operator()(ClearedAt& at) const { json.need("point", at.point); }
  void operator()(GuideStroke& stroke) const
  {
    points(stroke);
    json.may("weight", stroke.weight);
    json.may("radius", stroke.radius);
  }
  void operator()(GuideRegion& region) const
  {
    json.need("polygons", region.polygons);
    json.need("direction", region.direction);
    json.may("weight", region.weight);
  }
  void operator()(ValenceAt& at) const
  {
    json.need("point", at.point);
    json.need("valence", at.valence);
  }
  void operator()(SizeAt& at) const
  {
    json.need("point", at.point);
    json.may("radius", at.radius);
    json.need("factor", at.factor);
  }
  void operator()(SizeRegion& region) const
  {
    json.need("polygons", region.polygons);
    json.need("factor", region.factor);
  }
  void operator()(IrregularEdit& edit) const
  {
    json.needName("operation", edit.operation, kOperations);
    points(edit);
    json.may("valences", edit.valences);
  }
  void operator()(Connection& connection) const { points(connection); }
  void operator()(Cycle& cycle) const { points(cycle); }
  void operator()(MirrorSymmetry& symmetry) const
  {
    json.both("origin", &MirrorPlane::origin, "normal", &MirrorPlane::normal, symmetry.plane);
    // Files without it are read as before.
    json.unlessUsual("plane_curve", symmetry.planeCurve, PlaneCurve::Isoline, kPlaneCurves);
  }
  void operator()(RotationalSymmetry& rotation) const
  {
    json.need("order", rotation.order);
    json.both(
      "origin", &RotationAxis::origin, "direction", &RotationAxis::direction, rotation.axis);
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

ConstraintContent readContent(FieldReader& reader)
{
  std::string kind;
  reader.need("kind", kind);
  ConstraintContent content = emptyOfKind(kind, reader.where());
  std::visit(ContentFields<FieldReader>{ reader }, content);
  return content;
}

constexpr auto kVertexFields = [](auto& fields, auto& vertex)
{
  fields.need("place", vertex.place);
  fields.need("valence", vertex.valence);
};
constexpr auto kChangeFields = [](auto& fields, auto& change)
{
  fields.need("place", change.place);
  fields.need("before", change.before);
  fields.need("after", change.after);
};
constexpr auto kLinkFields = [](auto& fields, auto& link)
{
  fields.need("id", link.id);
  fields.need("revision", link.revision);
  fields.needEach("changes", link.changes, kChangeFields);
};
constexpr auto kSectorFields = [](auto& fields, auto& sector)
{
  fields.need("middle", sector.middle);
  fields.need("turns", sector.turns);
};
constexpr auto kHeldFields = [](auto& fields, auto& held)
{
  fields.need("point", held.point);
  fields.need("place", held.place);
  fields.needEach("sectors", held.sectors, kSectorFields);
};
constexpr auto kJoinedFields = [](auto& fields, auto& joined)
{
  fields.need("id", joined.id);
  fields.need("revision", joined.revision);
  fields.need("start", joined.start);
  fields.need("end", joined.end);
  fields.need("start_valence", joined.startValence);
  fields.need("end_valence", joined.endValence);
};
/// What the session has made of an irregular operation.
constexpr auto kResolvedFields = [](auto& fields, auto& edit)
{
  fields.needEach("before", edit.before, kVertexFields);
  fields.needEach("changes", edit.changes, kChangeFields);
  fields.needEach("upon", edit.upon, kLinkFields);
  fields.mayEach("on_features", edit.onFeatures, kHeldFields); // files of before have none
  fields.mayEach("shown", edit.shown, kVertexFields);
  fields.may("without_map", edit.withoutMap);
  fields.mayEach("joined", edit.joined, kJoinedFields);
};

} // namespace

SessionJson contentToJson(const ConstraintContent& content)
{
  SessionJson json;
  json["kind"] = kindOf(content);
  FieldWriter writer(json);
  ConstraintContent copy = content; // a list of fields is for both ways
  std::visit(ContentFields<FieldWriter>{ writer }, copy);
  return json;
}

ConstraintContent contentFromJson(const SessionJson& json, const std::string& where)
{
  FieldReader reader(json, where);
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
    FieldWriter writer(json["resolved"]);
    kResolvedFields(writer, *edit);
  }
  return json;
}

SessionConstraint constraintFromJson(const SessionJson& json, const std::string& where)
{
  SessionConstraint constraint;
  {
    FieldReader ids(json, where);
    ids.need("id", constraint.id);
  }
  FieldReader reader(json, "constraint " + std::to_string(constraint.id) + " of " + where);
  reader.need("id", constraint.id);
  reader.need("revision", constraint.revision);
  constraint.content = readContent(reader);
  if (auto* edit = std::get_if<IrregularEdit>(&constraint.content))
  {
    FieldReader resolved(reader.at("resolved"), reader.where());
    kResolvedFields(resolved, *edit);
    resolved.finish();
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
