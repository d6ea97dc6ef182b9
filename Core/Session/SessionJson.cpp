// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Session/SessionJson.h"

#include "Base/Refuse.h"

#include <array>
#include <cmath>
#include <limits>
#include <set>

namespace quadrille
{
namespace
{

constexpr std::array<const char*, 5> kOperations{ "move", "split", "merge", "cancel", "add" };
constexpr std::array<const char*, 4> kMethods{ "scale-aware", "mixed-integer", "quadcover",
  "seamless" };
constexpr std::array<const char*, 2> kFeatureCriteria{ "creases", "angle" };
constexpr std::array<const char*, 3> kFinalQualities{ "coarse", "intermediate", "input" };
constexpr std::array<const char*, 2> kPlaneCurves{ "isoline", "mid-line" };
constexpr std::array<const char*, 4> kSmallDetails{ "automatic", "resolve", "simplify", "keep" };

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

/// Takes the values of an object one by one; what is left at the end has no place in it.
class ObjectReader
{
public:
  ObjectReader(const SessionJson& json, std::string where) : json_(json), where_(std::move(where))
  {
    if (!json.is_object())
    {
      refuse(where_, " is no JSON object");
    }
  }

  bool has(const char* key) const { return json_.contains(key); }

  const SessionJson& at(const char* key)
  {
    if (!has(key))
    {
      refuse(where_, " has no \"", key, "\"");
    }
    taken_.insert(key);
    return json_[key];
  }
  void read(const char* key, double& value) { value = numberIn(at(key), key); }
  void read(const char* key, bool& value)
  {
    require(at(key).is_boolean(), key, "true or false");
    value = json_[key].get<bool>();
  }
  void read(const char* key, std::string& value)
  {
    require(at(key).is_string(), key, "a text");
    value = json_[key].get<std::string>();
  }
  template <class Integer, std::enable_if_t<std::is_integral_v<Integer>, int> = 0>
  void read(const char* key, Integer& value)
  {
    value = integerIn<Integer>(at(key), key);
  }
  void read(const char* key, Vector3& value) { value = pointIn(at(key), key); }
  template <class T>
  void read(const char* key, std::vector<T>& values)
  {
    require(at(key).is_array(), key, "a list");
    values.clear();
    for (const SessionJson& value : json_[key])
    {
      if constexpr (std::is_same_v<T, Vector3>)
      {
        values.push_back(pointIn(value, key));
      }
      else
      {
        values.push_back(integerIn<T>(value, key));
      }
    }
  }
  template <class T>
  void readIf(const char* key, T& value)
  {
    if (has(key))
    {
      read(key, value);
    }
  }
  template <std::size_t kCount>
  std::size_t readName(const char* key, const std::array<const char*, kCount>& names)
  {
    std::string name;
    read(key, name);
    for (std::size_t i = 0; i < kCount; ++i)
    {
      if (name == names[i])
      {
        return i;
      }
    }
    std::string all;
    for (const char* known : names)
    {
      all += std::string(all.empty() ? "" : ", ") + known;
    }
    refuse("\"", key, "\" of ", where_, " is \"", name, "\", but must be one of: ", all);
  }
  void finish() const
  {
    for (const auto& [key, value] : json_.items())
    {
      if (taken_.count(key) == 0)
      {
        refuse(where_, " has \"", key, "\", which is not known here");
      }
    }
  }
  const std::string& where() const { return where_; }

private:
  void require(bool is, const char* key, const char* what) const
  {
    if (!is)
    {
      refuse("\"", key, "\" of ", where_, " must be ", what);
    }
  }
  double numberIn(const SessionJson& value, const char* key) const
  {
    require(value.is_number(), key, "a number");
    return value.get<double>();
  }
  Vector3 pointIn(const SessionJson& value, const char* key) const
  {
    require(value.is_array() && value.size() == 3, key, "three numbers a point");
    return { numberIn(value[0], key), numberIn(value[1], key), numberIn(value[2], key) };
  }
  template <class Integer>
  Integer integerIn(const SessionJson& value, const char* key) const
  {
    using Limits = std::numeric_limits<Integer>;
    bool fits = false;
    if (value.is_number_unsigned())
    {
      fits = value.get<std::uint64_t>() <= static_cast<std::uint64_t>(Limits::max());
    }
    else if (value.is_number_integer())
    {
      fits =
        Limits::is_signed && value.get<std::int64_t>() >= static_cast<std::int64_t>(Limits::min());
    }
    require(fits, key, "a whole number in its range");
    return value.get<Integer>();
  }

  const SessionJson& json_;
  std::string where_;
  std::set<std::string> taken_;
};

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
    json.push_back(
      { { "point", change.point }, { "before", change.before }, { "after", change.after } });
  }
  return json;
}

/// What the session has made of an irregular operation.
SessionJson resolvedToJson(const IrregularEdit& edit)
{
  SessionJson before = SessionJson::array();
  for (const IrregularVertex& vertex : edit.before)
  {
    before.push_back({ { "point", vertex.point }, { "place", pointToJson(vertex.place) },
      { "valence", vertex.valence } });
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
      each.read("point", change.point);
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
      each.read("point", vertex.point);
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
  if (reader.has("on_features")) // files of before have none
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

SessionJson settingsToJson(const RemeshOptions& options)
{
  // By name, so that an option that is new has to be put on one side or the other here.
  const auto& [quads, edgeLength, relativeEdgeLength, featureAngle, featureCriterion, shapeSizes,
    curvatureGuides, method, coarsestIntegers, coarseVertices, decimationCost, closeHandles,
    smallDetails, removeSmallComponents, anisotropyLimit, finalQuality, distortionMetric,
    maximumNumberOfQuads, preview, smoothingSteps, memoryLimit, keepsPositions, mergeCharts,
    knownMap, threads, warmStart, progress] = options;
  static_cast<void>(decimationCost); // sessions have the default one
  static_cast<void>(preview);
  static_cast<void>(memoryLimit);
  static_cast<void>(keepsPositions);
  static_cast<void>(mergeCharts);
  static_cast<void>(knownMap);
  static_cast<void>(threads);
  static_cast<void>(progress);
  SessionJson json;
  if (quads)
  {
    json["quads"] = *quads;
  }
  else if (edgeLength)
  {
    json["edge_length"] = *edgeLength;
  }
  else
  {
    json["relative_edge_length"] = relativeEdgeLength;
  }
  json["feature_angle"] = featureAngle ? SessionJson(*featureAngle) : SessionJson(nullptr);
  json["feature_criterion"] = kFeatureCriteria[static_cast<std::size_t>(featureCriterion)];
  json["chord_error"] =
    shapeSizes.chordError ? SessionJson(*shapeSizes.chordError) : SessionJson(nullptr);
  json["gap_quads"] = shapeSizes.gapQuads;
  json["smallest_size"] = shapeSizes.smallest;
  json["largest_size"] = shapeSizes.largest;
  json["curvature_guides"] = curvatureGuides ? SessionJson(*curvatureGuides) : SessionJson(nullptr);
  json["method"] = kMethods[static_cast<std::size_t>(method)];
  json["integers"] = coarsestIntegers ? "coarsest" : "keep-sizes";
  json["coarse_vertices"] = coarseVertices;
  json["close_handles"] = closeHandles;
  json["small_details"] = kSmallDetails[static_cast<std::size_t>(smallDetails)];
  json["small_components"] = removeSmallComponents ? "remove" : "keep";
  json["anisotropy_limit"] = anisotropyLimit;
  json["final_quality"] = kFinalQualities[static_cast<std::size_t>(finalQuality)];
  json["distortion_metric"] = distortionMetric;
  json["maximum_number_of_quads"] = maximumNumberOfQuads;
  json["smoothing_steps"] = smoothingSteps;
  json["warm_start"] = warmStart;
  return json;
}

void settingsFromJson(const SessionJson& json, RemeshOptions& options, const std::string& where)
{
  ObjectReader reader(json, where);
  const int sizes = static_cast<int>(reader.has("quads")) +
    static_cast<int>(reader.has("edge_length")) +
    static_cast<int>(reader.has("relative_edge_length"));
  if (sizes > 1)
  {
    refuse(where, " has more than one of \"quads\", \"edge_length\", \"relative_edge_length\"");
  }
  if (sizes == 1)
  {
    options.quads.reset();
    options.edgeLength.reset();
  }
  if (reader.has("quads"))
  {
    reader.read("quads", options.quads.emplace());
  }
  if (reader.has("edge_length"))
  {
    reader.read("edge_length", options.edgeLength.emplace());
  }
  reader.readIf("relative_edge_length", options.relativeEdgeLength);
  const auto readOptional = [&](const char* name, std::optional<double>& value)
  {
    if (reader.has(name))
    {
      value.reset();
      if (!reader.at(name).is_null())
      {
        reader.read(name, value.emplace());
      }
    }
  };
  readOptional("feature_angle", options.featureAngle);
  if (reader.has("feature_criterion"))
  {
    options.featureCriterion =
      static_cast<FeatureCriterion>(reader.readName("feature_criterion", kFeatureCriteria));
  }
  readOptional("chord_error", options.sizes.chordError);
  readOptional("curvature_guides", options.curvatureGuides);
  reader.readIf("gap_quads", options.sizes.gapQuads);
  reader.readIf("smallest_size", options.sizes.smallest);
  reader.readIf("largest_size", options.sizes.largest);
  constexpr std::array<const char*, 2> kIntegers{ "keep-sizes", "coarsest" };
  constexpr std::array<const char*, 2> kSmall{ "keep", "remove" };
  if (reader.has("method"))
  {
    options.method = static_cast<MapMethod>(reader.readName("method", kMethods));
  }
  if (reader.has("integers"))
  {
    options.coarsestIntegers = reader.readName("integers", kIntegers) == 1;
  }
  if (reader.has("small_details"))
  {
    options.smallDetails =
      static_cast<SmallDetails>(reader.readName("small_details", kSmallDetails));
  }
  if (reader.has("small_components"))
  {
    options.removeSmallComponents = reader.readName("small_components", kSmall) == 1;
  }
  if (reader.has("final_quality"))
  {
    options.finalQuality =
      static_cast<FinalQuality>(reader.readName("final_quality", kFinalQualities));
  }
  reader.readIf("coarse_vertices", options.coarseVertices);
  reader.readIf("close_handles", options.closeHandles);
  reader.readIf("anisotropy_limit", options.anisotropyLimit);
  reader.readIf("distortion_metric", options.distortionMetric);
  reader.readIf("maximum_number_of_quads", options.maximumNumberOfQuads);
  reader.readIf("smoothing_steps", options.smoothingSteps);
  reader.readIf("warm_start", options.warmStart);
  reader.finish();
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
